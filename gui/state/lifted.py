"""What there is to say of sensors that a cut took off."""

from __future__ import annotations

from collections.abc import Sequence

from gui.state.problem import Problem
from skinfab.placement.lifted import Lifted


def taken_off(lifted: Sequence[Lifted], *, by_last_step: bool) -> list[Problem]:
    """One line for each piece they lay on, and one for each that does not fit any more; `by_last_step`: undo brings them back.

    Examples
    --------
    >>> taken_off([], by_last_step=True)
    []
    """
    undo = "; Ctrl+Z brings {} back" if by_last_step else ""
    waiting: dict[str, list[str]] = {}
    for each in lifted:
        if not each.why:
            waiting.setdefault(each.sensor.piece, []).append(each.sensor.id)
    lines = [f"{counted(ids)} taken off {piece} until it lies flat again" + undo.format(them(ids)) for piece, ids in waiting.items()]
    lines += [f"{e.sensor.id} stays off: {e.why}; make room for it and press F6, or place another" for e in lifted if e.why]
    return [Problem(line, "lifted", kind="warning") for line in lines]


def counted(ids: Sequence[str]) -> str:
    """ "C3", or "10 sensors".

    Examples
    --------
    >>> counted(["C3"]), counted(["C3", "C4"])
    ('C3', '2 sensors')
    """
    return ids[0] if len(ids) == 1 else f"{len(ids)} sensors"


def them(ids: Sequence[str]) -> str:
    """ "it" or "them"."""
    return "it" if len(ids) == 1 else "them"
