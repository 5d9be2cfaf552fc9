"""Find seams by itself: few good pieces, cut on creases where there are any.

Two ways are tried on a mesh of a few thousand triangles and the better one is kept: from the regions between
sharp edges (exact for polyhedra and machined parts), and from the whole surface opened by one cut (best for
organic shapes). A finer mesh then gets the seams by shortest paths, and every piece is judged anew on it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.model import Mesh
from skinfab.seams.coarse import coarsen, transfer
from skinfab.seams.creases import borders, crease_seams, merge_small
from skinfab.seams.cut import seam_length
from skinfab.seams.glue import glue_pieces
from skinfab.seams.judge import Limits
from skinfab.seams.refine import Judged, refine_seams
from skinfab.seams.weights import seam_weights

BoolArray = NDArray[np.bool_]

#: Seams are searched on about this many triangles.
_COARSE_FACES = 6000

#: The search aims below the bound by this part of what it allows above 4, because the fine mesh shows more.
_AIM = 0.7

#: In the search a flattening need not be driven to the end: d is known to 1 % of what is above 4.
_SEARCH_DECREASE = 1e-2

#: Gluing may cost this part of what the bound allows above 4.
_GLUE_EXCESS = 0.1

#: An object that falls into more pieces than this is hardly meant for a skin: the second way is not tried.
_MANY = 100

#: A transferred scrap under this part of the surface joins its neighbour.
_SCRAP = 0.002


#: On the fine mesh only pieces under this part of the surface are worth trying to glue.
_SMALL = 0.03


@dataclass(frozen=True, eq=False)
class Seams:
    """A seam set and the good pieces it gives.

    Parameters
    ----------
    cut : (e,) bool
        Per edge of the mesh.
    pieces : list of (OpenPiece, Verdict)
    """

    cut: BoolArray
    pieces: list[Judged]


def find_seams(mesh: Mesh, limits: Limits, *, neck: float = 4.0, progress: Callable[[float], None] | None = None) -> Seams:
    """Seams that part `mesh` into disks within `limits`, without flips or overlap.

    Parameters
    ----------
    mesh : Mesh
        Manifold, consistently wound; closed or open, any genus, any number of components.
    limits : Limits
    neck : float, mm
        Pieces are not joined across less than this.
    progress : callable, optional
        Called with the part that is done, 0 to 1.

    Returns
    -------
    Seams
        Flattened as far as it takes to accept them; `finish.finish` drives d to its least.
    """
    aim = replace(limits, mean=4 + _AIM * (limits.mean - 4))
    small = coarsen(mesh, _COARSE_FACES)
    report = progress or (lambda done: None)
    search_share = 1.0 if small is mesh else 0.5
    seams = _search(small, aim, limits, neck, lambda done: report(search_share * done))
    if small is mesh:
        return seams
    cut = transfer(small, seams.cut, mesh)
    _, label = mesh.topology.face_components(cut)
    merged = merge_small(mesh, label, _SCRAP * mesh.area)
    # Within a piece the seams that part nothing (darts) stay; between pieces only the borders do.
    EF = mesh.topology.EF
    inside = (EF[:, 1] >= 0) & (label[EF[:, 0]] == label[EF[:, 1]])
    cut = (cut & inside) | borders(mesh, merged)
    fine = {"tolerance": _SEARCH_DECREASE}
    cut, pieces = refine_seams(mesh, cut, limits, seam_weights(mesh), progress=lambda done: report(0.5 + 0.4 * done), **fine)
    return Seams(*glue_pieces(mesh, cut, pieces, limits, neck=neck, excess=np.inf, smaller_than=_SMALL * mesh.area, **fine))


def _search(mesh: Mesh, aim: Limits, limits: Limits, neck: float, progress: Callable[[float], None]) -> Seams:
    weight = seam_weights(mesh)
    creases = crease_seams(mesh)
    starts = [creases] if creases.any() else []
    starts.append(np.zeros(len(mesh.topology.E), dtype=bool))
    found: list[Seams] = []
    for k, start in enumerate(starts):
        begun = k / len(starts)

        def report(done: float, begun: float = begun) -> None:
            progress(begun + 0.8 * done / len(starts))

        cut, pieces = refine_seams(mesh, start, aim, weight, tolerance=_SEARCH_DECREASE, progress=report)
        cut, pieces = glue_pieces(mesh, cut, pieces, aim, neck=neck, excess=_GLUE_EXCESS * (limits.mean - 4), tolerance=_SEARCH_DECREASE)
        found.append(Seams(cut, pieces))
        progress((k + 1) / len(starts))
        if len(pieces) > _MANY:
            break
    return min(found, key=lambda s: _cost(mesh, s))


def _cost(mesh: Mesh, seams: Seams) -> float:
    """Pieces, seam length and stretch in one number: 0.005 of mean d weighs as much as a piece or a root of the area in seam."""
    areas = np.array([mesh.face_areas[piece.faces].sum() for piece, _ in seams.pieces])
    mean = float(np.average([v.distortion.mean for _, v in seams.pieces], weights=areas))
    return len(seams.pieces) + seam_length(mesh, seams.cut) / np.sqrt(mesh.area) + 200 * (mean - 4)
