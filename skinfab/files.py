"""Files are written whole or not at all: to a temporary name beside the target, then renamed."""

from __future__ import annotations

import errno
import os
import secrets
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from skinfab.errors import InputError

#: What is said of a full disk, so that what runs a command knows its fault from those of its input.
DISK_FULL = "the disk is full"


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
        with suppress(FileNotFoundError, NotADirectoryError):  # then it was never begun, and why is being told
            partial.unlink()


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


def require_apart(folder: str | Path, names: Sequence[str], inputs: Sequence[str | Path], *, perhaps: Sequence[str] = ()) -> None:
    """Refuse a folder in which results would replace what they are made from, or what somebody else put there.

    A run leaves all of its files or none; where some lie there and others do not, no earlier run left them.

    Parameters
    ----------
    folder : path
        Where the results go; it need not exist.
    names : sequence of str
        The files that every run leaves.
    inputs : sequence of path
        Files or folders that are read.
    perhaps : sequence of str
        Files that some runs leave and others remove.

    Raises
    ------
    InputError
        One of the files is an input, lies in one, or is of no earlier run.

    Examples
    --------
    >>> import tempfile
    >>> folder = Path(tempfile.mkdtemp())
    >>> _ = (folder / "samples.csv").write_text("t,U")
    >>> require_apart(folder, ["samples.csv", "result.json"], [folder / "samples.csv"])
    Traceback (most recent call last):
        ...
    skinfab.errors.InputError: ...samples.csv is read and would be replaced by the result of that name; give another -o
    """
    folder = Path(folder)
    there = [folder / name for name in names if os.path.lexists(folder / name)]
    for target in (*there, *(folder / name for name in perhaps)):
        for source in map(Path, inputs):
            if source.exists() and target.exists() and (target.samefile(source) or source.resolve() in target.resolve().parents):
                raise InputError(f"{target} is read and would be replaced by the result of that name; give another -o")
    if there and len(there) < len(names):
        missing = next(name for name in names if folder / name not in there)
        raise InputError(f"{there[0]} is there already and is of no earlier run, which would have left {missing} too; give another -o")


def explain_os_error(fault: OSError, target: str | Path) -> str:
    """One sentence for a failed write: what, where, what to do."""
    if fault.errno == errno.ENOSPC:
        return f"cannot write {target}: {DISK_FULL}; free some space and run again"
    if fault.errno in (errno.ENOENT, errno.ENOTDIR):
        return f"cannot write {target}: {_missing(fault, Path(target))}"
    if fault.errno == errno.EEXIST and Path(target).is_file():
        return f"cannot write {target}: it is a file, not a folder; choose another folder"
    if fault.errno == errno.EISDIR:
        return f"cannot write {target}: it is a folder; name a file in it"
    if fault.errno in (errno.EACCES, errno.EROFS, errno.EPERM):
        return f"cannot write {target}: no permission; choose another folder"
    return f"cannot write {target}: {fault.strerror or fault}"


def _missing(fault: OSError, target: Path) -> str:
    """Why there is no such place: a folder that is there may still take no files, as those do in which the system shows itself."""
    folder = Path(fault.filename).parent if isinstance(fault.filename, str) else target.parent
    if folder.is_dir():
        return f"{folder} takes no new files; choose another folder"
    file = next((p for p in folder.parents if p.is_file()), folder)
    return f"{file} is a file, not a folder; choose another folder" if file.is_file() else "its folder does not exist; create it first"
