"""Lines of several codes, as RS-274 allows and GRBL reads them: one command a code, in the order in which they act."""

from __future__ import annotations

import re

#: A word: its letter and its number.
_WORD = re.compile(r"\s*([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))", re.IGNORECASE)
#: Two codes, or one that is not the first word.
_BLOCK = re.compile(r"[GM]\s*\d.*[GM]\s*\d|^(?:N\d+\s*)?[EFIJKRSXYZ].*[GM]\s*\d", re.IGNORECASE)

_PUMP = {"M3", "M4", "M5"}
#: Codes that take the line's places, arcs and times; a line has one of them at most.
_TAKE_AXES = {"G0", "G1", "G2", "G3", "G4", "G10", "G28", "G30", "G38", "G92"}
_ENDING = {"M0", "M1", "M2", "M30"}


def parted(body: str) -> list[str]:
    """A line without its comment, as lines of one code each; a line that is no such block comes back as it is.

    RS-274 (NIST IR 6556, table 8) sets the feed first, then turns the spindle, then units, planes and modes, then moves,
    and stops last.

    Examples
    --------
    >>> parted("G21 G17 G90 G94"), parted("G90 G1 X2 F100 M3 S5")
    (['G21', 'G17', 'G90', 'G94'], ['M3S5', 'G90', 'G1X2F100'])
    >>> parted("X1 Y2 G91 M2"), parted("G1 X1")
    (['G91', 'X1Y2', 'M2'], ['G1 X1'])
    """
    if not _BLOCK.search(body):
        return [body]
    words, at = [], 0
    while at < len(body):
        found = _WORD.match(body, at)
        if not found:
            return [body]  # let the reader say what is wrong with it
        words.append((found[1].upper(), found[2]))
        at = found.end()
    if words[0][0] == "N":
        words = words[1:]
    codes = [f"{letter}{float(number):g}" for letter, number in words if letter in "GM"]
    taking = [code for code in codes if code.partition(".")[0] in _TAKE_AXES]
    if not codes or len(taking) > 1 or len(set(codes)) < len(codes):
        return [body]
    pump = [code for code in codes if code in _PUMP]
    rest = [(letter, number) for letter, number in words if letter not in "GM"]
    rate = "".join(letter + number for letter, number in rest if letter == "S" and pump)
    moved = "".join(letter + number for letter, number in rest if not (letter == "S" and pump))
    settings = [code for code in codes if code not in (*_PUMP, *_ENDING, *taking)]
    last = [code for code in codes if code in _ENDING]
    motion = [taking[0] + moved] if taking else [moved] if moved else []
    return [*(code + (rate if k == 0 else "") for k, code in enumerate(pump)), *settings, *motion, *last]
