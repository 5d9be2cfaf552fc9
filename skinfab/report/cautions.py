"""What the figures themselves warn of: pieces that fit badly in places, sensors that are stretched by being worn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from skinfab.flatten.distortion import Distortion, singular_values
from skinfab.pieces import Piece
from skinfab.placement.lifted import off_words
from skinfab.report.words import listed
from skinfab.skin import Skin
from skinfab.tolerances import CAUTION_D_MAX, CAUTION_D_P99, CAUTION_WRAP_STRAIN

#: Entries of one warning that are spelt out, worst first; the rest are named.
_SPELT_OUT = 4


def cautions(skin: Skin, distortions: Sequence[Distortion], sensors: Sequence[Mapping[str, Any]]) -> list[str]:
    """Sensors that are off, and one sentence for each kind of bad figure, with all pieces or sensors it is true of.

    Parameters
    ----------
    skin : Skin
    distortions : sequence of Distortion
        One a piece, in order, all finite.
    sensors : sequence of mappings
        As in the report: id and wrap_strain (max, resistance_factor).

    Returns
    -------
    list of str
        Empty when all is well.
    """
    return [*off_words(skin.lifted), *_distorted(skin, distortions), *_strained(sensors)]


def worst_place(skin: Skin, piece: Piece, d: Distortion) -> tuple[np.ndarray, float]:
    """Centre of the piece's most distorted triangle on the object, (3,) mm, and the strain of the worn skin there.

    The strain is the larger one of the triangle's two: negative where the flat skin is too large and is squeezed.
    """
    worst = int(np.argmax(d.d))
    V = piece.V(skin.mesh)
    long, short = singular_values(V, piece.F[worst : worst + 1], piece.UV)[0]
    # The singular values lead from the object to the plane; worn is the way back. The larger term of d decides.
    strain = 1 / long - 1 if long * abs(short) >= 1 else 1 / abs(short) - 1
    return V[piece.F[worst]].mean(axis=0), float(strain)


def _distorted(skin: Skin, distortions: Sequence[Distortion]) -> list[str]:
    bad = [(piece, d) for piece, d in zip(skin.pieces, distortions, strict=True) if d.max > CAUTION_D_MAX or d.p99 > CAUTION_D_P99]
    if not bad:
        return []
    bad.sort(key=lambda each: -each[1].max)
    entries = [_place(skin, piece, d) for piece, d in bad[:_SPELT_OUT]]
    return [
        f"{listed([piece.id for piece, _ in bad], 'piece')}: the flat shape is far off in places (d of 4 is perfect; x, y, z on the "
        f"object): {'; '.join(entries)}{_more(bad)}. Elsewhere the skin is sound"
    ]


def _place(skin: Skin, piece: Piece, d: Distortion) -> str:
    (x, y, z), strain = worst_place(skin, piece, d)
    share = f", over {d.p99:.2f} on one hundredth of the area" if d.p99 > CAUTION_D_P99 else ""
    return (
        f"{piece.id} up to {d.max:.1f} at ({x:.1f}, {y:.1f}, {z:.1f}) mm, where the skin is {_way(strain)} by about "
        f"{abs(strain):.0%}{share}".replace("%", " %")
    )


def _strained(sensors: Sequence[Mapping[str, Any]]) -> list[str]:
    bad = [s for s in sensors if abs(s["wrap_strain"]["max"]) > CAUTION_WRAP_STRAIN]
    if not bad:
        return []
    bad.sort(key=lambda s: -abs(s["wrap_strain"]["max"]))
    entries = []
    for s in bad[:_SPELT_OUT]:
        worst, whole = s["wrap_strain"]["max"], s["wrap_strain"]["resistance_factor"]
        entries.append(
            f"{s['id']} is {_way(worst)} by {abs(worst):.0%} in one place (times {(1 + worst) ** 2:.2f} there, "
            f"times {whole:.2f} over its whole length)".replace("%", " %")
        )
    return [
        f"{listed([s['id'] for s in bad], 'sensor')}: worn, the resistance at rest will be off by (1 + e)^2, e the wrap strain "
        f"from place to place: {'; '.join(entries)}{_more(bad)}. Move what must be exact to a flatter place"
    ]


def _way(strain: float) -> str:
    return "stretched" if strain > 0 else "squeezed"


def _more(bad: Sequence[Any]) -> str:
    return f"; the other {len(bad) - _SPELT_OUT} less" if len(bad) > _SPELT_OUT else ""
