"""A copy of unsaved work after every change, and what a crash has left of it."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import secrets
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from skinfab.document import load_skin, save_skin
from skinfab.errors import SkinfabError
from skinfab.files import atomic_write
from skinfab.skin import Skin


@dataclass(frozen=True)
class Left:
    """Work that a run which ended without saving has left.

    Parameters
    ----------
    file : Path
        The copy, a skin document.
    path : Path or None
        What it is a newer state of; None where it was never saved.
    when : float
        Seconds since the epoch.
    object : str
        Name of the mesh's file; "" where it is not known.
    """

    file: Path
    path: Path | None
    when: float
    object: str = ""

    def load(self) -> Skin:
        """The document.

        Raises
        ------
        InputError
            It is damaged.
        """
        return load_skin(self.file)

    def discard(self) -> None:
        """Remove the copy."""
        self.file.unlink(missing_ok=True)
        self.file.with_suffix(".json").unlink(missing_ok=True)
        self.file.with_suffix(".lock").unlink(missing_ok=True)


class Autosave:
    """Keeps one copy of the document that is being worked on, written by a thread of its own.

    Parameters
    ----------
    folder : Path
        Where copies lie; made if missing.
    failed : callable
        Called with a sentence, from the thread, where a copy cannot be written.
    """

    def __init__(self, folder: Path, *, failed: Callable[[str], None]) -> None:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        self._file = folder / f"{os.getpid()}-{secrets.token_hex(4)}.skin"
        # Held as long as this process lives, however it ends: process numbers come again.
        self._lock = self._file.with_suffix(".lock").open("w")
        fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        self._failed = failed
        self._wanted: tuple[Skin, Path | None] | None = None
        self._change = threading.Condition()
        self._writing = False
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="autosave", daemon=True)
        self._thread.start()

    def keep(self, skin: Skin, path: Path | None) -> None:
        """Write a copy soon; only the newest counts."""
        with self._change:
            self._wanted = skin, path
            self._change.notify_all()

    def drop(self) -> None:
        """There is nothing unsaved any more."""
        with self._change:
            self._wanted = None
            self._change.wait_for(lambda: not self._writing)
            self._file.unlink(missing_ok=True)
            self._file.with_suffix(".json").unlink(missing_ok=True)

    def settle(self, timeout_s: float = 10.0) -> bool:
        """Wait until what was last asked for is written; whether it is."""
        with self._change:
            return self._change.wait_for(lambda: self._wanted is None and not self._writing, timeout_s)

    def close(self, *, keep: bool = False) -> None:
        """End the thread: the program ends as it should, and drops the copy unless it is to be kept for the next start."""
        if keep:
            self.settle()
        else:
            self.drop()
        with self._change:
            self._closed = True
            self._change.notify_all()
        self._thread.join(timeout=10)
        self._lock.close()
        if not keep:
            self._file.with_suffix(".lock").unlink(missing_ok=True)

    def _run(self) -> None:
        while True:
            with self._change:
                self._change.wait_for(lambda: self._closed or self._wanted is not None)
                if self._closed:
                    return
                assert self._wanted is not None
                (skin, path), self._wanted, self._writing = self._wanted, None, True
            try:
                save_skin(skin, self._file)
                note = {"path": None if path is None else str(path), "when": time.time(), "pid": os.getpid(), "object": skin.source.file}
                atomic_write(self._file.with_suffix(".json"), json.dumps(note) + "\n")
            except SkinfabError as fault:
                self._failed(f"the copy of unsaved work could not be written: {fault}")
            finally:
                with self._change:
                    self._writing = False
                    self._change.notify_all()


def left_over(folder: Path) -> list[Left]:
    """What runs that are no longer there have left in `folder`, the newest first."""
    found = []
    for file in folder.glob("*.skin"):
        if _is_held(file.with_suffix(".lock")):
            continue
        path, when, object = None, 0.0, ""
        with contextlib.suppress(OSError, ValueError, KeyError, TypeError):  # the note is written after the copy
            note = json.loads(file.with_suffix(".json").read_text(encoding="utf-8"))
            path, when = (None if note["path"] is None else Path(note["path"])), float(note["when"])
            object = str(note["object"])
        found.append(Left(file, path, when or file.stat().st_mtime, object))
    return sorted(found, key=lambda left: -left.when)


def _is_held(lock: Path) -> bool:
    """Whether the process that writes the copy is still there."""
    try:
        with lock.open("r+") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except BlockingIOError:
        return True
    return False
