"""A folder of results appears whole or not at all: made in a hidden folder inside the target, then renamed file by file."""

from __future__ import annotations

import errno
import json
import os
import secrets
import shutil
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath

from skinfab.errors import InputError
from skinfab.files import explain_os_error

#: A report larger than this is none of ours.
REPORT_MAX_BYTES = 64_000_000

#: Folders in which a run may remove what an earlier run made.
OWN_FOLDERS = ("gcode", "mould", "toolpath")

_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS)


@contextmanager
def staged_folder(target: str | Path, *, tidy: bool = True) -> Iterator[Path]:
    """Give a temporary folder inside `target`; on success move its files into place, otherwise remove it.

    Files in ``gcode/``, ``mould/`` and ``toolpath/`` that the ``report.json`` of an earlier run lists and this run has not
    made again are removed; nothing else that lies in `target` is touched. ``report.json`` is moved last, so
    what it lists is there. Ctrl-C waits while files are moved or removed.

    Parameters
    ----------
    target : path
        Made with its parents where it is missing.
    tidy : bool
        Whether files of an earlier run are removed; not where only a part of what that made is made anew.

    Yields
    ------
    Path
        An empty folder to write into; sub-folders are kept.

    Raises
    ------
    InputError
        `target` cannot be made or written, the disk is full, or a folder stands where a file must go.

    Examples
    --------
    >>> import tempfile
    >>> out = Path(tempfile.mkdtemp()) / "demo_out"
    >>> with staged_folder(out) as folder:
    ...     _ = (folder / "flat.svg").write_text("<svg/>")
    >>> [p.name for p in out.iterdir()]
    ['flat.svg']
    """
    target = Path(target)
    made: list[Path] = []
    stage = target / f".skinfab-{secrets.token_hex(4)}"
    try:
        with signals_wait():
            made = _make_folders(target)
            _or_explain(stage.mkdir, target)
        try:
            yield stage
        except OSError as fault:
            # Only what a full or read-only disk causes is ours to explain; a missing input file is not.
            if fault.errno in _NO_ROOM:
                raise InputError(explain_os_error(fault, target)) from fault
            raise
        except InputError as fault:
            # The hidden folder is ours to know: the user gave the target.
            raise InputError(str(fault).replace(str(stage), str(target))) from fault
        with signals_wait():
            _or_explain(lambda: _move_into_place(stage, target, tidy=tidy), target)
    finally:
        with signals_wait():
            shutil.rmtree(stage, ignore_errors=True)
            for folder in reversed(made):
                if not any(folder.iterdir()):
                    folder.rmdir()


@contextmanager
def signals_wait() -> Iterator[None]:
    """Hold Ctrl-C and its like back until the end of this short piece of work.

    Examples
    --------
    >>> try:
    ...     with signals_wait():
    ...         signal.raise_signal(signal.SIGINT)
    ...         print("whole")
    ... except KeyboardInterrupt:
    ...     print("then interrupted")
    whole
    then interrupted
    """
    if threading.current_thread() is not threading.main_thread():
        yield  # Python delivers signals to the main thread only
        return
    held: list[int] = []
    # A signal mask would not do: any other thread (a progress bar's) would take the signal and hand it on.
    before = {s: signal.getsignal(s) for s in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGALRM)}
    for number, handler in before.items():
        if callable(handler):
            signal.signal(number, lambda got, frame: held.append(got))
    try:
        yield
    finally:
        for number, handler in before.items():
            if callable(handler):
                signal.signal(number, handler)
        for got in dict.fromkeys(held):
            signal.raise_signal(got)


def _or_explain(work: Callable[[], None], target: Path) -> None:
    try:
        work()
    except OSError as fault:
        raise InputError(explain_os_error(fault, target)) from fault


def _make_folders(target: Path) -> list[Path]:
    """Make `target` and its missing parents; which of them are new, outermost first."""
    missing = [p for p in (target, *target.parents) if not os.path.lexists(p)]
    try:
        target.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise InputError(f"cannot write into {target}: a file of that name is in the way; give another folder") from None
    except OSError as fault:
        raise InputError(explain_os_error(fault, target)) from fault
    return missing[::-1]


def _move_into_place(stage: Path, target: Path, *, tidy: bool) -> None:
    new = sorted((p.relative_to(stage) for p in stage.rglob("*") if p.is_file()), key=lambda p: (p == Path("report.json"), p))
    for name in new:
        # All checks come before the first rename: either everything moves or nothing.
        if (target / name).is_dir():
            raise InputError(f"cannot write {target / name}: a folder of that name is in the way; move it or give another -o")
        folder = target / name.parent
        folder.mkdir(parents=True, exist_ok=True)
        if folder.stat().st_dev != stage.stat().st_dev:
            raise InputError(f"{folder} lies on another disk than {target}, so the results cannot appear as one; give another -o")
    stale = _made_earlier(target) - set(new) if tidy else set()
    for name in new:
        with (stage / name).open("rb+") as written:
            os.fsync(written.fileno())
    for name in new:
        os.replace(stage / name, target / name)
    for name in stale:
        (target / name).unlink(missing_ok=True)


def _made_earlier(target: Path) -> set[Path]:
    """The G-code, tool-path and mould files that the report of an earlier run lists, by path inside `target`."""
    report = target / "report.json"
    try:
        if report.stat().st_size > REPORT_MAX_BYTES:
            return set()
        data = json.loads(report.read_text(encoding="utf-8"))
        listed = [str(entry["file"]) for part in ("gcode", "moulds") for entry in data[part]]
        listed += [f"toolpath/{PurePosixPath(entry['file']).stem}.svg" for entry in data["gcode"]]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return set()  # no earlier run, or somebody else's report.json: nothing of ours to remove
    found = set()
    for name in map(PurePosixPath, listed):
        # Exactly one file straight inside one of our own folders: a doctored report must not reach anything else.
        if len(name.parts) == 2 and name.parts[0] in OWN_FOLDERS and name.parts[1] != ".." and (target / name).is_file():
            found.add(Path(name))
    return found
