"""What the tests of batches share: meshes that say what their job does, and the runner that heeds them."""

import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from skinfab.batch.job import Job, name_of

RUNNER = [sys.executable, "-P", str(Path(__file__).with_name("quick_runner.py"))]


def quick_job(folder: Path, text: str, **limits: float) -> Job:
    """A job whose mesh has that text."""
    mesh = folder / f"{text.replace(' ', '_')}.obj"
    mesh.write_text(text)
    return Job(name_of(mesh, {}), str(mesh), {}, **limits)


def quick_jobs(folder: Path, texts: Sequence[str]) -> list[Job]:
    return [quick_job(folder, text) for text in texts]


def wait_for(condition: Callable[[], object], seconds: float = 30) -> None:
    """Until it holds; a machine that is busy takes its time."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)
