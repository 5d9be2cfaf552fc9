"""Whether the bed or a neck, not the bound, is what makes pieces many, in a sentence."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from skinfab.mesh.model import Mesh
from skinfab.seams.judge import Limits, Parted
from skinfab.seams.refine import Judged


def parted_text(pieces: Sequence[Judged], limits: Limits) -> list[str]:
    """A sentence for the bed and one for necks, each where it parted what the bound did not.

    Parameters
    ----------
    pieces : sequence of (OpenPiece, Verdict)
        As `find_seams` gives them, before they are finished.
    limits : Limits
        What they were found for.
    """
    parts: dict[Parted, int] = {}
    for _, verdict in pieces:
        if verdict.parted is not None:
            parts[verdict.parted] = parts.get(verdict.parted, 0) + 1
    parts = {parted: count for parted, count in parts.items() if count > 1}
    sentences = []
    large = {parted: count for parted, count in parts.items() if parted.large}
    narrow = {parted: count for parted, count in parts.items() if not parted.large}
    if large:
        width, height = limits.size
        bed = f"{sum(large.values())} of the pieces are parts of what does not fit the bed with its mould ({width:g} x {height:g} mm)"
        fewer = _fewer(len(pieces), large)
        sentences.append(f"{bed}; {fewer} on a larger bed" if fewer else f"{bed}; there may be fewer on a larger one")
    if narrow:
        width = min(parted.neck for parted in narrow)
        necks = f"{sum(narrow.values())} of the pieces are parted at a neck of {width:.2g} mm, as {limits.neck:g} mm survive handling"
        sentences.append(f"{necks}; {_fewer(len(pieces), narrow)} if the object were larger, or the material's neck less")
    return sentences


def _fewer(count: int, parts: dict[Parted, int]) -> str:
    """How many pieces would do without that limit; empty where that is not known."""
    if not all(parted.flat for parted in parts):
        return ""
    left = count - sum(parts.values()) + len(parts)
    return f"{left} piece{'' if left == 1 else 's'} would do"


def carried_parted(mesh: Mesh, pieces: Sequence[Judged], other: Mesh, found: Sequence[Judged]) -> list[Judged]:
    """`found` pieces of a fine mesh with what is known of the `pieces` of a coarse one that most of their triangles lie on."""
    if not any(verdict.parted for _, verdict in pieces):
        return list(found)
    owner = np.empty(len(mesh.F), dtype=np.int64)
    for k, (piece, _) in enumerate(pieces):
        owner[piece.faces] = k
    tree = cKDTree(mesh.V[mesh.F].mean(axis=1))
    carried: list[Judged] = []
    for piece, verdict in found:
        on = owner[tree.query(other.V[other.F[piece.faces]].mean(axis=1))[1]]
        known = pieces[int(np.bincount(on).argmax())][1].parted
        carried.append((piece, replace(verdict, parted=verdict.parted or known)))
    return carried
