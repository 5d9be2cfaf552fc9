"""Pieces without a sensor, and why."""

from __future__ import annotations

from skinfab.material import Material
from skinfab.placement.auto import SEED_SIZES, no_room, spiral_of_size
from skinfab.placement.space import Footprint, Space, need_of
from skinfab.skin import Skin


def bare_pieces(skin: Skin, material: Material) -> list[str]:
    """What to tell of the pieces of a document that have no sensor: that there is no room for one, or that one was left out.

    Parameters
    ----------
    skin : Skin
    material : Material
        With the margin that the printer needs.

    Returns
    -------
    list of str
        At most two sentences; none where every piece has a sensor.
    """
    spaces = [Space(skin.object, piece, material) for piece in skin.pieces if not skin.sensors_on(piece.id)]
    if not spaces:
        return []
    smallest = spiral_of_size(min(SEED_SIZES), material)
    least = Footprint.of(smallest).radius + need_of(smallest, material)
    narrow = [space for space in spaces if space.raster.clearance.max(initial=0.0) < least]
    left = [space.piece.id for space in spaces if space not in narrow]
    said = no_room(narrow, smallest)
    if len(left) == 1:
        said.append(f"piece {left[0]} has no sensor, though there seems to be room: place one there, or leave it as it is")
    elif left:
        listed = f"{', '.join(left[:-1])} and {left[-1]}"
        said.append(f"pieces {listed} have no sensor, though there seems to be room: place some there, or leave them as they are")
    return said
