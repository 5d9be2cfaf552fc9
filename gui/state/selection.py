"""What the pointer is on and what is selected: the same in the 3D and the flat view."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Target:
    """One thing on the object; at most one field of `piece`, `sensor` and `seam` counts, the most special one.

    Parameters
    ----------
    face : int
        Mesh face under the pointer; -1 where there is none.
    piece, sensor : str
        Ids; "" where there is none.
    seam : int
        Edge id of ``skin.mesh.topology`` on a seam; -1 where there is none.
    also : tuple of str
        Ids of more sensors that are selected together with `sensor`; some may be gone by now.
    """

    face: int = -1
    piece: str = ""
    sensor: str = ""
    seam: int = -1
    also: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return self.face >= 0 or bool(self.piece) or bool(self.sensor) or self.seam >= 0


NOTHING = Target()
