"""Colours of faces, the same in both views: by piece, by distortion, as a checker board, by painted preference."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gui.state.derived import Derived
from gui.theme import Theme, rgb
from skinfab.report.object_view import PIECE_COLOURS
from skinfab.skin import Skin

Bytes = NDArray[np.uint8]

#: Ends of the colour bar of distortion d, fixed so that pictures of different objects can be compared.
HEAT_RANGE = (4.0, 4.2)

#: Side of a square of the checker board, mm.
CHECK_MM = 5.0

#: From the first to the second end of the bar, evenly: darker is worse, whether or not one tells red from green.
_HEAT = np.array([[240, 244, 236], [252, 214, 130], [240, 146, 74], [198, 66, 84], [104, 24, 110]], dtype=np.float64)

#: A face that lies on no piece, or that no one has painted.
_BARE = {"light": (196, 200, 206), "dark": (98, 104, 112)}

#: Of the pieces' colours in a dark window: they keep their hue, and light lines stand out from them.
_DARKER = 0.55


def heat(d: ArrayLike) -> Bytes:
    """Colour of distortions (k,): (k, 3); beyond the bar's ends those of the ends.

    Examples
    --------
    >>> heat([4.0, 4.1, 9.0, np.inf]).tolist()
    [[240, 244, 236], [240, 146, 74], [104, 24, 110], [104, 24, 110]]
    """
    low, high = HEAT_RANGE
    at = np.clip((np.asarray(d, dtype=np.float64) - low) / (high - low), 0, 1)
    steps = np.linspace(0, 1, len(_HEAT))
    return np.stack([np.interp(at, steps, _HEAT[:, k]) for k in range(3)], axis=-1).round().astype(np.uint8)


def piece_colours(count: int, theme: Theme) -> Bytes:
    """Of the first `count` pieces, (count, 3): those of the report, darker where lines are light."""
    strength = _DARKER if theme.name == "dark" else 1.0
    return (255 * strength * PIECE_COLOURS[np.arange(count) % len(PIECE_COLOURS)]).round().astype(np.uint8)


def face_colours(skin: Skin, derived: Derived, shading: str, theme: Theme) -> Bytes:
    """Of all faces of the mesh, (m, 3), made once for both views; `shading` is one of the session's."""
    if shading == "preferences":  # other ones with every stroke of the brush, and quickly made
        return _face_colours(skin, derived, shading, theme)
    of = (skin.mesh, skin.pieces)
    return derived.once(f"colours {shading} {theme.name}", of, lambda: _face_colours(skin, derived, shading, theme))


def _face_colours(skin: Skin, derived: Derived, shading: str, theme: Theme) -> Bytes:
    bare = _BARE[theme.name]
    colours = np.full((len(skin.mesh.F), 3), bare, dtype=np.uint8)
    if shading == "preferences":
        if skin.marks is not None:
            colours[skin.marks.preference > 0] = _mixed(bare, rgb(theme.good))
            colours[skin.marks.preference < 0] = _mixed(bare, rgb(theme.error))
        return colours
    own = piece_colours(len(skin.pieces), theme)
    for k, piece in enumerate(skin.pieces):
        colours[piece.faces] = heat(derived.distortion(skin.mesh, piece).d) if shading == "distortion" else own[k]
    return colours


def _mixed(one: tuple[int, int, int], other: tuple[int, int, int]) -> tuple[int, ...]:
    return tuple((a + 2 * b) // 3 for a, b in zip(one, other, strict=True))
