"""Lines with a number and a checksum, as a sender writes them: does the checksum hold?"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import reduce

from gcode.moves import Finding
from gcode.words import lines_of

_SUMMED = re.compile(r"\s*([Nn]\s*\d+[^*]*)\*\s*(\d+)")


def checksum(text: str) -> int:
    """Marlin's: all bytes before the asterisk, one upon another by exclusive or.

    Examples
    --------
    >>> checksum("N3 T0")
    57
    """
    return reduce(int.__xor__, text.encode(), 0)


def line_findings(text: str) -> Iterator[Finding]:
    """Lines whose checksum is wrong, at which a printer asks for the line again without end.

    Examples
    --------
    >>> print(*line_findings("N3 T0*57\\nN4 G0 X1*57"))
    line 2: its checksum is 57, its bytes make 100, so the printer refuses it again and again; take number and checksum out, the sender \
makes its own
    """
    if "*" not in text:
        return
    for line, raw in enumerate(lines_of(text), 1):
        found = _SUMMED.match(raw) if "*" in raw else None
        if found and (found[2].lstrip("0") or "0") != str(made := checksum(found[1])):
            yield Finding(
                line,
                f"its checksum is {found[2]}, its bytes make {made}, so the printer refuses it again and again",
                "take number and checksum out, the sender makes its own",
            )
