"""A fault of a mesh: its kind, where it is first met, and what mends it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.topology import Topology

#: "nothing": it does no harm; "clean": harmless, always mended; "repair": by --repair; "no": make the mesh anew.
MendedBy = Literal["nothing", "clean", "repair", "no"]


@dataclass(frozen=True)
class Fault:
    """One kind of fault.

    Parameters
    ----------
    kind : str
    count : int
        How many elements have it.
    first : str
        The first of them: "face 12", "edge 3-17", "vertex 5"; counted from 0.
    remedy : str
        What is done about it, or what the user has to do.
    mended_by : str
        "nothing" (does no harm), "clean" (always mended), "repair" (by --repair) or "no".
    """

    kind: str
    count: int
    first: str
    remedy: str
    mended_by: MendedBy

    @property
    def blocks(self) -> bool:
        """The mesh cannot be used as it is."""
        return self.mended_by in ("repair", "no")

    @property
    def sentence(self) -> str:
        """What, where, what is done."""
        many = f"{self.count} x " if self.count > 1 else ""
        means = {"nothing": "", "clean": "always mended: ", "repair": "--repair: ", "no": "not mended: "}[self.mended_by]
        return f"{many}{self.kind}, first at {self.first}; {means}{self.remedy}"


def face(index: int) -> str:
    """How messages name a face."""
    return f"face {index}"


def vertex(index: int) -> str:
    """How messages name a vertex."""
    return f"vertex {index}"


def edge_of(top: Topology) -> Callable[[int], str]:
    """How messages name an edge: by its vertices."""
    return lambda index: f"edge {top.E[index, 0]}-{top.E[index, 1]}"


class FaultList:
    """Collects the faults that are there, in the order they are looked for."""

    def __init__(self) -> None:
        self.found: list[Fault] = []

    def look(self, kind: str, where: NDArray[np.bool_], name: Callable[[int], str], mended_by: MendedBy, remedy: str) -> None:
        """Note a fault if any element has it."""
        if where.any():
            self.found.append(Fault(kind, int(where.sum()), name(int(np.argmax(where))), remedy, mended_by))
