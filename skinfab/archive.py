"""A zip of JSON and `.npy` arrays that is written the same every time and read with nothing taken on trust.

Sizes are checked in the zip's own directory before anything is read, and an array's header is matched letter
by letter against the one header that fits: no `eval` of what it says, no pickle, no allocation by its claim.
"""

from __future__ import annotations

import re
import struct
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.strict_json import strict_json

#: Deflated arrays of real meshes shrink by 2 to 10; a member that claims more than this is a zip bomb.
MAX_RATIO = 100

#: Smallest total that is still checked against the ratio: under it nothing can do harm.
FREE_BYTES = 16_000_000

#: Nobody has a skin this large: 100 million triangles need 10 GB.
MAX_BYTES = 20_000_000_000

MAX_JSON_BYTES = 64_000_000
MAX_MEMBERS = 100_000

#: Every zip tool reads this date; the format knows none earlier.
_EPOCH = (1980, 1, 1, 0, 0, 0)

_MAGIC = b"\x93NUMPY"
_HEADER = re.compile(
    r"\{\s*'descr':\s*'(?P<dtype>[^']{1,20})',\s*'fortran_order':\s*(?P<fortran>True|False),"
    r"\s*'shape':\s*\((?P<shape>[0-9, ]{0,80})\),?\s*\}\s*"
)


def write_archive(path: Path, *, text: Mapping[str, str], arrays: Mapping[str, NDArray[Any]]) -> None:
    """Write text members, then arrays as ``NAME.npy`` ('<f8' or '<i8', C order), in the order given.

    Parameters
    ----------
    path : Path
    text : mapping of member name to str
    arrays : mapping of member name without ``.npy`` to array of float or int

    Raises
    ------
    RefusedError
        An array holds NaN or infinity.
    """
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        for name, content in text.items():
            archive.writestr(_member(name), content.encode())
        for name, array in arrays.items():
            plain = np.ascontiguousarray(array, dtype="<f8" if np.issubdtype(array.dtype, np.floating) else "<i8")
            if not np.isfinite(plain).all():
                raise RefusedError(f"{name} holds a value that is not finite; the document was not written")
            with archive.open(_member(f"{name}.npy"), "w") as stream:
                np.lib.format.write_array(stream, plain, version=(1, 0), allow_pickle=False)


def _member(name: str) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name, date_time=_EPOCH)
    info.create_system = 3  # Unix, on every system: it is one of the bytes
    info.external_attr = 0o644 << 16
    return info


class Archive:
    """An archive opened for reading; a context manager.

    Parameters
    ----------
    path : Path
    head, what : str
        The JSON member that says what shape the arrays have, and what such an archive is called: for messages.

    Raises
    ------
    InputError
        Out of proportion (a zip bomb), or a name in it points outside or comes twice.
    zipfile.BadZipFile
        Not a zip, or cut short.
    """

    def __init__(self, path: Path, *, head: str = "skin.json", what: str = "a skin document") -> None:
        self._head, self._what = head, what
        self._size = path.stat().st_size
        try:
            self._zip = zipfile.ZipFile(path)
        except (ValueError, NotImplementedError, OverflowError, struct.error) as fault:  # a damaged directory
            raise zipfile.BadZipFile(str(fault)) from fault
        try:
            self._members = self._checked()
        except InputError:
            self._zip.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None:
        self._zip.close()

    def _checked(self) -> dict[str, zipfile.ZipInfo]:
        infos = self._zip.infolist()
        total = sum(info.file_size for info in infos)
        if total > MAX_BYTES or (total > FREE_BYTES and total > MAX_RATIO * self._size) or len(infos) > MAX_MEMBERS:
            raise InputError(f"holds {total:,} bytes in {len(infos)} members where the file has {self._size:,}; refused as a zip bomb")
        members: dict[str, zipfile.ZipInfo] = {}
        for info in infos:
            name = info.filename
            if name.startswith("/") or "\\" in name or ":" in name or ".." in name.split("/"):
                raise InputError(f"holds {name[:80]!r}, a path outside the document; refused")
            if name in members:
                raise InputError(f"holds {name[:80]!r} twice; refused")
            members[name] = info
        return members

    def json(self, name: str) -> dict[str, Any]:
        """A JSON object of finite numbers."""
        try:
            data = strict_json(self._read(name, at_most=MAX_JSON_BYTES))
        except (ValueError, RecursionError) as fault:  # ValueError: JSON, UTF-8 and digits alike
            raise InputError(f"{name} is not JSON ({fault})") from fault
        if not isinstance(data, dict):
            raise InputError(f"{name} is not a JSON object")
        return data

    def array(self, name: str, dtype: str, shape: tuple[int, ...]) -> NDArray[Any]:
        """The array ``NAME.npy``, which must be finite and of just this dtype ('<f8' or '<i8') and shape."""
        count = 1
        for n in shape:
            if n < 0:
                raise InputError(f"{name}.npy is said to have shape {shape}; no size can be negative")
            count *= n
        raw = self._read(f"{name}.npy", at_most=8 * count + 1024)
        start = _data_start(raw, f"{name}.npy", dtype, shape, head=self._head)
        if len(raw) - start != 8 * count:
            raise InputError(f"{name}.npy has {len(raw) - start} bytes of data where shape {shape} needs {8 * count}")
        array = np.frombuffer(raw, dtype=dtype, offset=start).reshape(shape).astype(dtype[1:], copy=True)
        if dtype == "<f8" and not np.isfinite(array).all():
            raise InputError(f"{name}.npy holds a value that is not finite")
        return array

    def _read(self, name: str, *, at_most: int) -> bytes:
        info = self._members.get(name)
        if info is None:
            raise InputError(f"{name} is missing; not {self._what}")
        if info.file_size > at_most:
            raise InputError(f"{name} has {info.file_size:,} bytes where at most {at_most:,} can be right")
        if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            # An LZMA header alone may claim gigabytes of working memory.
            raise InputError(f"{name} is packed by method {info.compress_type}; only stored and deflated members are read")
        try:
            # The reader stops at `file_size` bytes whatever the packed data would unpack to, then checks the CRC.
            return self._zip.read(info)
        except (RuntimeError, NotImplementedError) as fault:  # encrypted, or of a zip version zipfile does not know
            raise InputError(f"{name} cannot be unpacked ({fault}); save the document without a password") from fault
        except (zlib.error, struct.error, EOFError, OSError, ValueError) as fault:
            raise zipfile.BadZipFile(f"{name} is damaged: {fault}") from fault


def _data_start(raw: bytes, name: str, dtype: str, shape: tuple[int, ...], *, head: str) -> int:
    """Where the data begin in a ``.npy`` file, once its header says exactly what is wanted.

    NumPy's own reader evaluates the header as a Python literal and believes its shape; deep brackets,
    object dtypes and vast shapes are how it is abused. Here the header is text to be compared.
    """
    if raw[:6] != _MAGIC or len(raw) < 12:
        raise InputError(f"{name} is not a .npy array")
    width = {1: 2, 2: 4, 3: 4}.get(raw[6])
    if width is None:
        raise InputError(f"{name} is of .npy version {raw[6]}; 1 to 3 are known")
    start = 8 + width + int.from_bytes(raw[8 : 8 + width], "little")
    match = _HEADER.fullmatch(raw[8 + width : min(start, 1024)].decode("latin-1"))
    if match is None or start > len(raw):
        raise InputError(f"{name} has a header that is not of a plain array")
    if match["dtype"] != dtype or match["fortran"] != "False":
        raise InputError(
            f"{name} is of dtype {match['dtype']!r}{' in Fortran order' * (match['fortran'] == 'True')}; it must be {dtype!r} in C order"
        )
    given = tuple(int(n) for n in match["shape"].replace(" ", "").split(",") if n)
    if given != shape:
        raise InputError(f"{name} has shape {given}; {head} says {shape}")
    return start
