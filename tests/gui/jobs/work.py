"""Work for the worker to do in tests: what is sent there must have a name in a module."""

import os
import time

from skinfab.errors import RefusedError
from skinfab.staging import staged_folder


def double(number, progress):
    progress(0.5, "doubling")
    return 2 * number


def size_of(blob, progress):
    return len(blob)


def refuse(progress):
    raise RefusedError("piece P1 overlaps itself; cut it further")


def stumble(progress):
    return 1 / 0


def die(progress):
    os._exit(9)


def busy(seconds, progress):
    """Hold the interpreter, as numerical work does."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        progress(1 - (end - time.monotonic()) / seconds, "busy")
        sum(range(20_000))
    return "finished"


def write_slowly(folder, progress):
    with staged_folder(folder) as stage:
        (stage / "half.txt").write_text("half")
        progress(0.5, "writing")
        time.sleep(30)
