"""Lets every test import the shared shapes (`import shapes`), and what tests start be interrupted; pictures are made small."""

import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from skinfab.report import preview

sys.path.insert(0, str(Path(__file__).parent))

# A shell that starts the tests in the background (and nohup) has signals ignored, and what the tests start would inherit that.
# A handler that does nothing is as deaf here, but is not inherited.
for number in (signal.SIGINT, signal.SIGHUP):
    if signal.getsignal(number) == signal.SIG_IGN:
        signal.signal(number, lambda *_: None)


@pytest.fixture(scope="session", autouse=True)
def small_previews() -> Iterator[None]:
    """Two thirds of what making a cube costs is drawing its preview in full; tests/report, which looks at it, has it so."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(preview, "_DPI", 40)
        yield


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The longest tests first, so that no worker is left alone with them at the end."""
    items.sort(key=lambda item: item.path.name != "test_real_meshes.py")
