"""Cut until every piece is good: open to a disk, relieve by darts, part what overlaps or is too large."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError, SkinfabError
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import OpenPiece, mesh_edges, open_pieces
from skinfab.seams.darts import grow_dart
from skinfab.seams.disk import cut_to_disk
from skinfab.seams.judge import Limits, Parted, Verdict, excess, judge
from skinfab.seams.naming import named_edges
from skinfab.seams.split import farthest_faces, overlapping_faces, part, split
from skinfab.tolerances import NEWTON_DECREASE

BoolArray = NDArray[np.bool_]

#: A piece that this many darts did not bring under the bound is parted instead.
_MOST_DARTS = 16

#: Flattened triangles, counted again each time, after which it is given up: some half a minute of work, ...
_MOST_TRIANGLES = 400_000

#: ... and this many times the whole mesh, for fine meshes whose pieces need a few more cuts.
_MOST_ROUNDS = 20

Judged = tuple[OpenPiece, Verdict]


def refine_seams(
    mesh: Mesh,
    cut: BoolArray,
    limits: Limits,
    weight: NDArray[np.float64],
    *,
    tolerance: float = NEWTON_DECREASE,
    forbidden: BoolArray | None = None,
    progress: Callable[[float], None] | None = None,
) -> tuple[BoolArray, list[Judged]]:
    """Add seams to `cut` until every piece is a disk that keeps to `limits`.

    It ends: each round cuts at least one more edge of a piece that failed, or says why it cannot.

    Parameters
    ----------
    mesh : Mesh
        Manifold, consistently wound.
    cut : (e,) bool
    limits : Limits
    weight : (e,) float
        Cost of cutting each edge.
    tolerance : float
        How far each flattening is driven, see `IsometricSolver.refine`.
    forbidden : (e,) bool, optional
        Edges that are never cut; a high `weight` has to lead the seams round them.
    progress : callable, optional
        Called with the part of the area that is done.

    Returns
    -------
    cut : (e,) bool
    pieces : list of (OpenPiece, Verdict)
        By first face; what was parted by the bed or a neck says so.

    Raises
    ------
    InputError
        No seam opens a piece to a disk: the mesh is not manifold or not consistently wound.
    RefusedError
        Forbidden edges leave no seam that would help, a single triangle breaks `limits`, or the surface is too rough or too
        detailed to come to an end with.
    """
    cut = cut.copy()
    left = _MOST_TRIANGLES + _MOST_ROUNDS * len(mesh.F)
    todo: list[tuple[OpenPiece, int, Parted | None]] = [(piece, 0, None) for piece in open_pieces(mesh, cut)]
    done: list[Judged] = []
    finished_area = 0.0
    while todo:
        piece, darts, parted = todo.pop()
        verdict = None
        if piece.is_disk:
            left -= len(piece.F)
            if left < 0:
                raise _endless(mesh, len(done), 1 - finished_area / mesh.area)
            verdict = judge(mesh, piece, limits, tolerance=tolerance)
            if verdict.accepted:
                done.append((piece, verdict if parted is None else replace(verdict, parted=parted)))
                finished_area += float(mesh.face_areas[piece.faces].sum())
                if progress:
                    progress(finished_area / mesh.area)
                continue
            parted = parted or _by_length(piece, verdict)
        opened, darts = next_cut(mesh, piece, verdict, weight, darts, forbidden=forbidden)
        if forbidden is not None and forbidden[opened].any():
            kept = opened[forbidden[opened]]
            opened = opened[~forbidden[opened]]
            if cut[opened].all():
                raise _forbidden(mesh, piece, verdict, kept, limits)
        if cut[opened].all():
            raise _stuck(mesh, piece, verdict, limits)
        cut[opened] = True
        parts = open_pieces(mesh, cut, faces=piece.faces)
        todo += [(part, darts if len(parts) == 1 else 0, parted) for part in parts]
    return cut, sorted(done, key=lambda item: int(item[0].faces[0]))


def next_cut(
    mesh: Mesh,
    piece: OpenPiece,
    verdict: Verdict | None,
    weight: NDArray[np.float64],
    darts: int = 0,
    *,
    forbidden: BoolArray | None = None,
) -> tuple[NDArray[np.int64], int]:
    """Mesh edges to open next, and how many darts the piece then has.

    Parameters
    ----------
    mesh : Mesh
    piece : OpenPiece
    verdict : Verdict or None
        What is wrong with it; None where it is no disk.
    weight : (e,) float
        Cost of cutting each edge.
    darts : int
        It has already.
    forbidden : (e,) bool, optional
        Edges that a dart goes round; what parts the piece may still take some.
    """
    if verdict is None:
        topology = piece.topology
        edge_weight = weight[mesh_edges(mesh, piece, np.arange(len(topology.E)))]
        return mesh_edges(mesh, piece, cut_to_disk(topology, edge_weight, len(piece.vertices))), darts
    if verdict.too_distorted and not verdict.too_large and darts < _MOST_DARTS:
        dart = grow_dart(mesh, piece, verdict.distortion.d, weight, forbidden=forbidden)
        if len(dart):
            return dart, darts + 1
    if verdict.neck is not None and not verdict.too_large:
        return part(mesh, piece, verdict.neck.side == 1, verdict.neck.side == 2, weight), 0
    if verdict.overlaps and not verdict.too_distorted:
        ends = overlapping_faces(mesh, piece, verdict.UV)
    else:
        ends = farthest_faces(piece, verdict.UV)
    return split(mesh, piece, ends, weight), 0


def _by_length(piece: OpenPiece, verdict: Verdict) -> Parted | None:
    """What is to be remembered of a piece that is parted because of the bed or a neck."""
    if not verdict.too_large and verdict.neck is None:
        return None
    flat = not verdict.too_distorted and not verdict.overlaps
    return Parted(int(piece.faces[0]), verdict.too_large, 0.0 if verdict.neck is None else verdict.neck.width, flat)


def _endless(mesh: Mesh, pieces: int, missing: float) -> RefusedError:
    return RefusedError(
        f"{mesh.name} is too rough or too detailed for a skin: {pieces} pieces lie flat, but {missing:.0%} of the surface does not "
        "yet; smooth or simplify the mesh, raise --max-distortion, or cut it by hand"
    )


def _forbidden(mesh: Mesh, piece: OpenPiece, verdict: Verdict | None, edges: NDArray[np.int64], limits: Limits) -> RefusedError:
    """The edges that the next cut would have to take, and what it is for."""
    where = f"the {len(piece.faces)} faces about face {int(piece.faces[0])}"
    if verdict is None:
        why = "they are not open to a disk"
    elif verdict.too_distorted:
        why = f"they have {excess(verdict.distortion, limits)}"
    elif verdict.too_large:
        why = "they do not fit the bed"
    else:
        why = "they cover themselves" if verdict.overlaps else "they have a neck that would tear"
    names = named_edges(mesh, edges)
    return RefusedError(f"the forbidden edges leave no seam that lays {where} flat; allow some of them, such as {names} ({why})")


def _stuck(mesh: Mesh, piece: OpenPiece, verdict: Verdict | None, limits: Limits) -> SkinfabError:
    """Why a piece that is not good cannot be cut any further."""
    where = f"face {int(piece.faces[0])}"
    if verdict is None:
        return InputError(
            f"no seam opens the {len(piece.faces)} faces about {where} to a disk: edges are non-manifold or wound both ways; use --repair"
        )
    if verdict.too_large:
        (w, h), (W, H) = verdict.UV.max(axis=0), limits.size
        return RefusedError(
            f"{where} alone is {w:.0f} x {h:.0f} mm and does not fit the bed ({W:.0f} x {H:.0f} mm); "
            "subdivide the mesh or choose a larger printer"
        )
    if verdict.neck is not None:
        return RefusedError(
            f"{where} holds together what lies about it by a neck of {verdict.neck.width:.2g} mm ({limits.neck:g} mm survive handling); "
            "subdivide the mesh or scale it up"
        )
    return RefusedError(f"{where} alone has {excess(verdict.distortion, limits)}; use --repair")
