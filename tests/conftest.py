"""Lets every test import the shared shapes (`import shapes`), and what tests start be interrupted; pictures are made small."""

import contextlib
import fcntl
import gc
import io
import os
import shutil
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import hypothesis
import pytest

from skinfab.cli.main import main
from skinfab.report import preview

sys.path.insert(0, str(Path(__file__).parent))

# A shell that starts the tests in the background (and nohup) has signals ignored, and what the tests start would inherit that.
# A handler that does nothing is as deaf here, but is not inherited.
for number in (signal.SIGINT, signal.SIGHUP):
    if signal.getsignal(number) == signal.SIG_IGN:
        signal.signal(number, lambda *_: None)


# How long an example takes is the machine's: with other work beside it one took longer than Hypothesis allows.
hypothesis.settings.register_profile("untimed", deadline=None)
hypothesis.settings.load_profile("untimed")


@pytest.fixture(scope="session")
def cut_once(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, Path], Path]:
    """What `skinfab segment` makes of an object of ours by its defaults, to be changed: a copy. Cut once for all tests and workers."""
    folder = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent  # all workers'

    def copied(name: str, to: Path) -> Path:
        document = folder / f"{name}.skin"
        with (folder / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not document.exists():
                assert main(["segment", str(Path(__file__).parents[1] / f"meshes/{name}.obj"), "-o", str(document)]) == 0
        return Path(shutil.copy(document, to))

    return copied


@pytest.fixture(scope="session")
def first_skin(tmp_path_factory: pytest.TempPathFactory, small_previews: None) -> tuple[Path, str]:
    """What `skinfab make meshes/robot_finger.obj -o first` writes, only to be read, and says. Made once for all tests and workers."""
    folder = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent  # all workers'
    made, text = folder / "first", folder / "first.txt"
    with (folder / "first.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not text.exists():
            said = io.StringIO()
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                assert main(["make", str(Path(__file__).parents[1] / "meshes/robot_finger.obj"), "-o", str(made)]) == 0
            text.write_text(said.getvalue().replace(f"{folder}/", ""))
    return made, text.read_text()


@pytest.fixture(scope="session", autouse=True)
def small_previews() -> Iterator[None]:
    """Two thirds of what making a cube costs is drawing its preview in full; tests/report, which looks at it, has it so."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(preview, "_DPI", 40)
        yield


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """The longest tests first, so that no worker is left alone with them at the end."""
    items.sort(key=lambda item: item.path.name != "test_real_meshes.py")


@pytest.fixture(scope="module", autouse=True)
def short_tidying() -> None:
    """Python's collector, which every window that closes calls, passes over what is there when a file begins: that took it 0.3 s each."""
    tidy()


@pytest.fixture
def tidied() -> None:
    """So short before every test of a live loop, which tidies before it begins and then lets the collector see all again."""
    tidy()


def tidy() -> None:
    """Collect, and let the collector walk only what comes from now on."""
    gc.collect()
    gc.freeze()
