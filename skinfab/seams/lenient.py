"""Lay one piece flat as well as it goes, and say in words what is wrong with it and what to do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError, SkinfabError
from skinfab.flatten.bff import flatten_disk
from skinfab.flatten.disk import lower
from skinfab.flatten.distortion import Distortion, best_scale, distortion_of, mean_over, shaped_areas, singular_values
from skinfab.flatten.isometric import IsometricSolver
from skinfab.flatten.methods import METHODS
from skinfab.flatten.methods import method as flattening
from skinfab.mesh.model import Mesh
from skinfab.seams.auto import Seams
from skinfab.seams.cones import flatten_with_cones
from skinfab.seams.cut import OpenPiece, mesh_edges
from skinfab.seams.finish import finish
from skinfab.seams.judge import Limits, Verdict, excess, judge, verdict_of

BoolArray = NDArray[np.bool_]

#: The method that cuts through cone points before it flattens.
CONES = "bff-cones"

#: A conformal layout of a larger mean d is of a piece that is hardly open yet: pieces that keep to a bound of 4.05 have one under 5
#: or 6. Laid flat with more than this, lengths are off ten times, and the piece would dwarf all others in a drawing.
_HOPELESS = 100.0

#: Newton steps on a piece that cannot keep to the bound: it is to be seen where it is stretched, not driven to the end.
_STEPS_TO_SEE = 5

#: The same from far off: on a scan of 85,000 triangles opened by one slit they bring the mean d from thousands to 11 or 49, and
#: a third more steps to the least, 10.6 or 13.9.
_STEPS_FROM_AFAR = 25


@dataclass(frozen=True, eq=False)
class LaidFlat:
    """A piece as flat as it goes.

    Parameters
    ----------
    piece : OpenPiece
        As asked for, or opened further by cones.
    UV : (p, 2) float64, mm, optional
        In the piece frame; None where it cannot be laid flat at all.
    distortion : Distortion, optional
        Of `UV`.
    fault : str
        What is wrong and what to do, to follow the piece's name; "" where all is well.
    cut : (k,) int64
        Mesh edges that were cut besides, by cones.
    """

    piece: OpenPiece
    UV: NDArray[np.float64] | None
    distortion: Distortion | None
    fault: str
    cut: NDArray[np.int64]


def require_method(name: str, cones: int | None) -> None:
    """A method that there is, and cones only with the one that has some.

    Raises
    ------
    InputError
        Otherwise.
    """
    known = ("auto", CONES, *METHODS)
    if name not in known:
        raise InputError(f"no flattening method {name!r}; there are {', '.join(known)}")
    if cones is not None and (name != CONES or cones < 1):
        raise InputError(f"{cones} cones with method {name}; give at least 1, with {CONES}")


def lay_flat(
    mesh: Mesh, piece: OpenPiece, limits: Limits, *, method: str = "auto", cones: int | None = None, forbidden: BoolArray | None = None
) -> LaidFlat:
    """Lay a piece flat by a method, whatever its shape.

    Parameters
    ----------
    mesh : Mesh
    piece : OpenPiece
    limits : Limits
    method : str
        "auto" (least d without overlap, as `skinfab segment`), "bff-cones", or one of `flatten.methods.METHODS`.
    cones : int, optional
        How many, with "bff-cones"; default as many as pay.
    forbidden : (e,) bool, optional
        Mesh edges that cones must not cut.
    """
    nothing = np.zeros(0, dtype=np.int64)
    if not shaped_areas(mesh.V[piece.vertices], piece.F)[1].any():
        return LaidFlat(piece, None, None, "has no area, so it cannot lie flat: glue it to its neighbour", nothing)
    try:
        if method == CONES:
            return _through_cones(mesh, piece, limits, cones, forbidden)
        shape = shape_fault(piece)
        if shape and not _can_be_flat(piece):
            return LaidFlat(piece, None, None, shape, nothing)
        verdict = _verdict(mesh, piece, limits, method, is_disk=not shape)
        if not verdict.distortion.mean <= _HOPELESS:
            return LaidFlat(piece, None, None, shape or "is hardly open yet, so it cannot lie flat: cut it further", nothing)
        return LaidFlat(piece, verdict.UV, verdict.distortion, shape or fault_of(verdict, limits), nothing)
    except (SkinfabError, ArithmeticError, np.linalg.LinAlgError) as fault:
        return LaidFlat(
            piece, None, None, f"cannot be laid flat by {method} ({fault}): cut it otherwise, or choose another method", nothing
        )


def kept_flat(mesh: Mesh, piece: OpenPiece, UV: NDArray[np.float64], limits: Limits) -> LaidFlat:
    """A piece that lies flat already, held against `limits` anew."""
    verdict = verdict_of(mesh, piece, UV, limits)
    fault = shape_fault(piece) or fault_of(verdict, limits)
    return LaidFlat(piece, UV, verdict.distortion, fault, np.zeros(0, dtype=np.int64))


def shape_fault(piece: OpenPiece) -> str:
    """Why a piece is no disk and what to cut; "" where it is one."""
    if piece.is_disk:
        return ""
    loops = len(piece.topology.boundary_loops)
    if not loops:
        return "is closed, so it cannot lie flat: cut it open"
    if not _can_be_flat(piece):
        return "has a handle, so it cannot lie flat: cut through the handle"
    return f"is a ring with {loops} borders: cut from one border to another"


def fault_of(verdict: Verdict, limits: Limits) -> str:
    """What is wrong with a disk and what to do; "" where it keeps to `limits`."""
    d = verdict.distortion
    if d.flipped:
        return f"has {d.flipped} triangles turned over when laid flat: choose method auto, or cut it further"
    if verdict.too_distorted:
        return f"has {excess(d, limits)}: cut it further, or raise the bound"
    if verdict.overlaps:
        return f"covers {d.overlap_mm2:.3g} mm^2 twice when laid flat: cut it further, or choose method bijective"
    if verdict.too_large:
        (w, h), (W, H) = verdict.UV.max(axis=0), limits.size
        lips = "" if w > max(W, H) or h > min(W, H) else " with the lips of its mould"
        size, bed = f"{w:.0f} x {h:.0f} mm", f"{W:.0f} x {H:.0f} mm"
        return f"is {size} flat and does not fit the bed ({bed}){lips}: cut it smaller, or choose a larger printer"
    if verdict.neck is not None:
        return (
            f"has a neck {verdict.neck.width:.1f} mm wide, and {limits.neck:g} mm survive handling: cut it there, or glue a dart beside it"
        )
    return ""


def _can_be_flat(piece: OpenPiece) -> bool:
    """A disk, with holes or without."""
    loops = len(piece.topology.boundary_loops)
    return loops > 0 and piece.topology.euler == 2 - loops


def _verdict(mesh: Mesh, piece: OpenPiece, limits: Limits, method: str, *, is_disk: bool) -> Verdict:
    V, F, topology = mesh.V[piece.vertices], piece.F, piece.topology
    if method != "auto" or not is_disk:
        # What is no disk has to be cut in any case: until then a quick layout shows where.
        uv = flattening(method if method != "auto" else "bff")(V, F, topology=topology)
        if not np.isfinite(uv).all():
            raise RefusedError("some points have no finite place")
        return verdict_of(mesh, piece, uv, limits)
    quick = flatten_disk(V, F, topology=topology)
    if _is_hopeless(V, F, quick):
        return verdict_of(mesh, piece, lower(V, F, quick, topology=topology, max_steps=_STEPS_FROM_AFAR).UV, limits)
    verdict = judge(mesh, piece, limits)
    if verdict.accepted:
        return finish(mesh, Seams(np.zeros(0, dtype=bool), [(piece, verdict)]), limits).pieces[0][1]
    if verdict.too_distorted and not verdict.distortion.flipped:
        # It was given up as soon as that much was clear.
        further = IsometricSolver(V, F).refine(verdict.UV, max_steps=_STEPS_TO_SEE)
        return verdict_of(mesh, piece, further.UV, limits)
    return verdict


def _is_hopeless(V: NDArray[np.float64], F: NDArray[np.int64], quick: NDArray[np.float64]) -> bool:
    """Whether a conformal layout is so far off that dozens of Newton steps would only confirm it."""
    areas, shaped = shaped_areas(V, F)
    d = distortion_of(singular_values(V, F, quick * best_scale(V, F, quick)))[shaped]
    return bool(np.isfinite(d).all() and mean_over(d, areas[shaped]) > _HOPELESS)


def _through_cones(mesh: Mesh, piece: OpenPiece, limits: Limits, cones: int | None, forbidden: BoolArray | None) -> LaidFlat:
    alone = Mesh(mesh.V[piece.vertices], piece.F, mesh.name)
    cut, opened, uv, _ = flatten_with_cones(alone, count=cones)
    edges = mesh_edges(mesh, piece, np.flatnonzero(cut & ~alone.topology.is_boundary))
    if forbidden is not None and forbidden[edges].any():
        raise InputError("the way to a cone is forbidden; allow it")
    whole = OpenPiece(piece.faces[opened.faces], piece.vertices[opened.vertices], opened.F, opened.topology)
    verdict = verdict_of(mesh, whole, uv, limits)
    return LaidFlat(whole, verdict.UV, verdict.distortion, fault_of(verdict, limits), edges)
