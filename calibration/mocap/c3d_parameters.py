"""Whether a C3D file's parameter section holds together: the library reads on at the end of a file for ever."""

from __future__ import annotations

from typing import Literal

_BLOCK = 512
#: The processors whose numbers a file may have, by the byte that says so: Intel, DEC, and MIPS.
INTEL, _DEC, _MIPS = 84, 85, 86
#: Bytes of a value by its type: characters, bytes, integers, floating point.
_WIDTHS = {255: 1, 1: 1, 2: 2, 4: 4}
#: More axes than this are none by the format.
_AXES = 7


def fault(data: bytes) -> str:
    """What is wrong with the section, or nothing.

    Its entries are a chain: each one says how far it is to the next, and a parameter's axes say how many bytes it has.
    Both must say the same, and lie in the file (the C3D user guide, "The parameter section").

    Examples
    --------
    >>> fault(bytes(600))
    'its parameters lie before the file'
    >>> entry = bytes([5]) + b"\\xff" + b"POINT" + (3).to_bytes(2, "little") + b"\\0"
    >>> head = b"\\x02\\x50" + bytes(510) + bytes([1, 80, 1, 84])
    >>> fault(head + entry + bytes(2)), fault(head + entry)
    ('', 'its parameters are cut off')
    """
    at = (data[0] - 1) * _BLOCK
    if at < 0:
        return "its parameters lie before the file"
    if at + 4 > len(data):
        return "its parameters are cut off"
    if (processor := data[at + 3]) not in (INTEL, _DEC, _MIPS):
        return f"its numbers are of processor {processor}, not {INTEL}, {_DEC} or {_MIPS}"
    at += 4
    while at:
        entry = _entry(data, at, "big" if processor == _MIPS else "little")
        if isinstance(entry, str):
            return entry
        at = entry
    return ""


def _entry(data: bytes, at: int, order: Literal["big", "little"]) -> int | str:
    """Where the entry after this one begins, 0 after the last, or what is wrong with it."""
    cut_off = "its parameters are cut off"
    if at >= len(data):
        return cut_off
    signed = data[at] - 256 * (data[at] > 127)  # negative where the entry is locked
    if not signed:
        return 0
    offset_at = at + 2 + abs(signed)
    if offset_at + 3 > len(data):
        return cut_off
    name = data[at + 2 : offset_at].decode("ascii", errors="replace")
    offset = int.from_bytes(data[offset_at : offset_at + 2], order)
    end = offset_at + 2
    if not data[at + 1]:
        return f"parameter {name!r} is of no group"
    if data[at + 1] < 128:  # a parameter: its group's number; a group's own is negative
        width, axes = _WIDTHS.get(data[end]), data[end + 1] if end + 1 < len(data) else 0
        if width is None or axes > _AXES:
            return f"parameter {name!r} is of type {data[end]} with {axes} axes, which there is none of"
        count = 1
        for length in data[end + 2 : end + 2 + axes]:
            count *= length
        end += 2 + axes + count * width
    if end >= len(data):
        return cut_off
    end += 1 + data[end]  # its description
    if end > len(data):
        return cut_off
    if offset and offset_at + offset != end:
        return f"the entry {name!r} has {end - offset_at} bytes and says {offset}"
    return end if offset else 0
