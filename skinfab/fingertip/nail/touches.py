"""Which rows of a table are of one touch: they must be held out together, as who knows a part of a touch knows the others."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from skinfab.fingertip.nail.labels import Label

#: Rows that are less apart, s, have no time between them for a finger to be lifted and put down again.
_NO_TIME_S = 0.1


def touches_of(labels: Sequence[Label]) -> tuple[list[str], list[str]]:
    """A name for each row, alike where rows are of one touch, and what is to be said of it.

    Rows of one participant and of one name in ``trial`` are of one touch. Where nobody gave names, rows of one log, participant and label
    that follow one another without a gap are, unless these are all of the class.

    Parameters
    ----------
    labels : sequence of n Label

    Examples
    --------
    >>> rows = [Label("a.csv", 0.0, 1.0, "pin"), Label("a.csv", 1.0, 2.0, "pin"), Label("a.csv", 5.0, 6.0, "pin")]
    >>> names, _ = touches_of(rows)
    >>> names[0] == names[1], names[1] == names[2]
    (True, False)
    """
    out = [f"{each.participant}/{each.trial or k}" for k, each in enumerate(labels)]
    unnamed = sorted((k for k, each in enumerate(labels) if not each.trial), key=lambda k: (labels[k].log, labels[k].start_s))
    if not unnamed:
        return out, []
    joined = list(out)
    for before, k in itertools.pairwise(unnamed):
        a, b = labels[before], labels[k]
        if (a.log, a.participant, a.label) == (b.log, b.participant, b.label) and b.start_s - a.end_s < _NO_TIME_S:
            joined[k] = joined[before]
    # A class of one touch could not be held out at all.
    of: dict[str, set[str]] = {}
    for name, each in zip(joined, labels, strict=True):
        of.setdefault(each.label, set()).add(name)
    alone = {label for label, names in of.items() if len(names) == 1}
    out = [own if each.label in alone else one for own, one, each in zip(out, joined, labels, strict=True)]
    touches = len({out[k] for k in unnamed})
    follow = ", where those of one label that follow one another without a gap are one" if touches < len(unnamed) else ", one each"
    notes = [f"{len(unnamed)} rows have no name in the column trial and are taken for {touches} touches{follow}; name them if they are not"]
    if apart := sorted({labels[k].label for k in unnamed if joined[k] != out[k]}):
        notes.append(
            f"all rows of {', '.join(apart)} follow one another and are held out one by one: if they are parts of one touch, more is right "
            "than of new ones; name each touch in the column trial"
        )
    return out, notes


def touches_by_class(labels: Sequence[Label]) -> dict[str, int]:
    """How often each class was touched.

    Examples
    --------
    >>> touches_by_class([Label("a.csv", 0.0, 1.0, "pin"), Label("a.csv", 5.0, 6.0, "pin"), Label("a.csv", 8.0, 9.0, "edge")])
    {'pin': 2, 'edge': 1}
    """
    groups: dict[str, set[str]] = {}
    for each, name in zip(labels, touches_of(labels)[0], strict=True):
        groups.setdefault(each.label, set()).add(name)
    return {label: len(names) for label, names in groups.items()}
