"""Files are written whole or not at all: to a temporary name beside the target, then renamed."""

from __future__ import annotations

import errno
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from skinfab.errors import InputError


@contextmanager
def atomic_path(target: str | Path) -> Iterator[Path]:
    """Give a temporary path beside `target`; rename it onto `target` on success, remove it otherwise.

    Parameters
    ----------
    target : path
        The file to be written. Its folder must exist.

    Yields
    ------
    Path
        Where to write. It has the suffix of `target`, for writers that look at it.

    Raises
    ------
    InputError
        The disk is full, or the folder is missing or not writable.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> with atomic_path(folder / "a.txt") as partial:
    ...     _ = partial.write_text("whole")
    >>> (folder / "a.txt").read_text(), len(list(folder.iterdir()))
    ('whole', 1)
    """
    target = Path(target)
    partial = target.with_name(f".{target.stem}.{secrets.token_hex(4)}.partial{target.suffix}")
    try:
        yield partial
        with partial.open("rb+") as written:
            os.fsync(written.fileno())
        os.replace(partial, target)
    except OSError as fault:
        raise InputError(explain_os_error(fault, target)) from fault
    finally:
        partial.unlink(missing_ok=True)


def atomic_write(target: str | Path, content: str | bytes) -> None:
    """Write `content` to `target`, whole or not at all (text as UTF-8 with \\n line ends)."""
    data = content.encode() if isinstance(content, str) else content
    with atomic_path(target) as partial:
        partial.write_bytes(data)


def require_place(target: str | Path) -> None:
    """Refuse a place where no file can be written, before the work whose result it is to hold.

    Raises
    ------
    InputError
        Its folder does not exist, or it is a folder itself.
    """
    target = Path(target)
    if target.is_dir():
        raise InputError(f"cannot write {target}: it is a folder; name a file in it")
    if not target.parent.is_dir():
        raise InputError(f"cannot write {target}: its folder does not exist; create it first")


def explain_os_error(fault: OSError, target: str | Path) -> str:
    """One sentence for a failed write: what, where, what to do."""
    if fault.errno == errno.ENOSPC:
        return f"cannot write {target}: the disk is full; free some space and run again"
    if fault.errno == errno.ENOENT:
        return f"cannot write {target}: its folder does not exist; create it first"
    if fault.errno in (errno.EACCES, errno.EROFS, errno.EPERM):
        return f"cannot write {target}: no permission; choose another folder"
    return f"cannot write {target}: {fault.strerror or fault}"
