"""What the wires of a mould cross, counted afresh from where they are laid."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
import shapely

from skinfab.wire_exits import WirePad, WireSlot


def crossings(pads: Sequence[WirePad], slots: Sequence[WireSlot]) -> list[str]:
    """All crossings of what is laid, counted afresh with shapely: each by the two names that a warning must hold."""
    wires = {f"pad {s.terminal} of {s.sensor}": (s, shapely.LineString([s.pad, s.at, s.out])) for s in slots}
    found = []
    for (name, (slot, wire)), (other, (its, line)) in combinations(wires.items(), 2):
        if wire.intersects(line) and not np.array_equal(slot.at, its.at):
            found.append(f"the wires of {name} and {other} cross near")
    for name, (slot, wire) in wires.items():
        mine = next(p for p in pads if p.name == name)
        over = {p.sensor for p in pads for run in (p.ink, p.pad) if len(run) > 1 and wire.distance(shapely.LineString(run)) < mine.bead / 2}
        found += [f"the wire of {name} near ({mine.at[0]:.1f}, {mine.at[1]:.1f}) mm has no way out clear"] * bool(over - {slot.sensor})
        runs = [mine.ink, *(p.pad for p in pads if p.sensor == mine.sensor and p is not mine)]
        own = shapely.union_all([shapely.LineString(run) for run in runs if len(run) > 1]) - shapely.Point(mine.at).buffer(mine.bead)
        if not own.is_empty and wire.distance(own) < mine.bead / 2:
            found.append(f"the wire of {name} near ({mine.at[0]:.1f}, {mine.at[1]:.1f}) mm crosses its own conductor near")
    return found
