"""What to try next, where a result is sound but hardly what was wanted."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from skinfab.skin import Skin

#: An object as it is worn comes apart into fewer pieces; more than this, and its insides are likely to be among them.
_MANY_PIECES = 20


def many_pieces(skin: Skin, *, wrapped: bool) -> list[str]:
    """What to do about a closed object that has come apart into very many pieces: a sentence, or none."""
    import numpy as np

    from skinfab.seams.cut import open_pieces
    from skinfab.seams.rules import edge_mask

    if len(skin.pieces) <= _MANY_PIECES or wrapped or skin.mesh.topology.is_boundary.any():
        return []
    apart = f"the object comes apart into {len(skin.pieces)} pieces"
    whole = np.zeros(len(skin.mesh.topology.E), dtype=bool)
    locked = whole if skin.marks is None else edge_mask(skin.mesh, skin.marks.locked)
    by_locks = len(open_pieces(skin.mesh, locked)) - len(open_pieces(skin.mesh, whole))
    if by_locks > len(skin.pieces) / 2:
        return [f"{apart}, most of them because locked seams part it there; unlock those that are not needed"]
    return [
        f"{apart}; if its inner walls or screw holes are among them, --wrap 8 skins the "
        "outside alone, as far as a fingertip gets (docs/wrapping.md)"
    ]
