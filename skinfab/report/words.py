"""Numbers in words, the same in the picture and on the page."""

from __future__ import annotations

from collections.abc import Sequence, Sized


def count(things: Sized, what: str) -> str:
    """How many of what.

    Examples
    --------
    >>> count([1], "file"), count([], "file")
    ('1 file', '0 files')
    """
    return f"{len(things)} {what}{'s' * (len(things) != 1)}"


def percent(fraction: float) -> float:
    """A fraction in percent, to two digits, without the sign of a negative nothing.

    Examples
    --------
    >>> percent(0.12345), str(percent(-1e-9))
    (12.35, '0.0')
    """
    return round(100 * fraction, 2) + 0.0


def listed(names: Sequence[str], what: str) -> str:
    """Things by their names.

    Examples
    --------
    >>> listed(["P3"], "piece"), listed(["P3", "P4", "P5"], "piece")
    ('piece P3', 'pieces P3, P4, P5')
    """
    return f"{what}{'s' * (len(names) != 1)} {', '.join(names)}"
