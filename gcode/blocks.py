"""Lines of several codes, as RS-274 allows and GRBL reads them: one command a code, in the order in which they act."""

from __future__ import annotations

import re

#: A word: its letter and its number.
_WORD = re.compile(r"\s*([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))", re.IGNORECASE)
#: A line of one motion at its start, or of words alone: nothing to part.
_SINGLE = re.compile(r"(?:N\d+\s*)?(?:G\s*0*[0-3](?![\d.]))?[^GMTN]*", re.IGNORECASE)

_PUMP = ("M3", "M4", "M5")
_ENDING = ("M0", "M1", "M2", "M30")
_DWELL = "G4"
#: Codes that take the line's places and arcs; a dwell takes its P alone, so it may stand beside one of them (GRBL's gcode.c).
_TAKE_AXES = {"G0", "G1", "G2", "G3", "G10", "G28", "G30", "G38.2", "G38.3", "G38.4", "G38.5", "G43.1", "G92"}
#: Of each of these GRBL takes one a line (NIST IR 6556, table 4): two are its error 21.
_MODAL_GROUPS = (
    (*_TAKE_AXES, "G80"),
    (_DWELL, "G10", "G28", "G28.1", "G30", "G30.1", "G53", "G92", "G92.1"),
    ("G17", "G18", "G19"),
    ("G20", "G21"),
    ("G43.1", "G49"),
    ("G54", "G55", "G56", "G57", "G58", "G59"),
    ("G90", "G91"),
    ("G93", "G94"),
    _PUMP,
    _ENDING,
)
#: Codes that may stand beside others; a line with any other one is left as it is, for its words may be that code's own.
_KNOWN = {code for group in _MODAL_GROUPS for code in group} | {
    "G28.1",
    "G30.1",
    "G40",
    "G53",
    "G61",
    "G91.1",
    "G92.1",
    "M6",
    "M7",
    "M8",
    "M9",
}


def parted(body: str) -> list[str]:
    """A line without its comment, as lines of one code each; a line that is no such block comes back as it is.

    The pump turns first, then the head dwells, then units, planes and modes are set, then F, then the head moves, by the last
    motion where the line names none, and what stops comes last. Words that only number the line are left out.

    Examples
    --------
    >>> parted("G21 G17 G90 G94"), parted("G90 G1 X2 F100 M3 S5")
    (['G21', 'G17', 'G90', 'G94'], ['M3S5', 'G90', 'G1X2F100'])
    >>> parted("X1 Y2 G91 M2"), parted("G1 X1"), parted("G21 F300")
    (['G91', 'X1Y2', 'M2'], ['G1 X1'], ['G21', 'F300'])
    >>> parted("G4 P1 G1 Y80"), parted("G4 P1")
    (['G4P1', 'G1Y80'], ['G4P1'])
    """
    if _SINGLE.fullmatch(body) and body[0] not in "nN":
        return [body]
    words, at = [], 0
    while at < len(body):
        found = _WORD.match(body, at)
        if not found:
            return [body]  # let the reader say what is wrong with it
        words.append((found[1].upper(), found[2]))
        at = found.end()
    words = words[1:] if words[0][0] == "N" else words
    codes = [f"{letter}{float(number):g}" for letter, number in words if letter in "GMT"]
    known = all(code[0] == "T" or code in _KNOWN for code in codes) and all(letter != "N" for letter, _ in words)
    dwells = _DWELL in codes
    spoken = "GMTXYZIJFSP" if dwells else "GMTXYZIJFS"
    own_words = set(codes).isdisjoint(_TAKE_AXES) and any(letter not in spoken for letter, _ in words)
    if not known or own_words or any(sum(code in group for code in codes) > 1 for group in _MODAL_GROUPS) or len(set(codes)) < len(codes):
        return [body]
    taking, pump, last = ([code for code in codes if code in group] for group in (_TAKE_AXES, _PUMP, _ENDING))
    settings = [code for code in codes if code not in (*taking, *pump, *last, _DWELL)]
    # S acts before a dwell, which ink may fill.
    early = "SP" if dwells else "S" * bool(pump)
    own = [letter + number for letter, number in words if letter not in "GMT" and letter not in early]
    rate = [letter + number for letter, number in words if letter == "S" and letter in early]
    wait = ["".join([_DWELL, *(letter + number for letter, number in words if letter == "P")])] if dwells else []
    turned = ["".join([code, *rate]) for code in pump] or rate
    moved = taking + own
    if not taking:
        # F is set in the units of its own line.
        feed = [word for word in own if word[0] in "FS"]
        axes = [word for word in own if word[0] not in "FS"]
        moved = own if axes else feed
    return [*turned, *wait, *settings, *(["".join(moved)] if moved else []), *last]
