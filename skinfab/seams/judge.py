"""Is a piece good? Flatten it and hold it against the limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.bijective import flatten_bijective
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import Distortion, measure
from skinfab.flatten.neck import Neck, find_neck
from skinfab.flatten.orient import orient
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import OpenPiece
from skinfab.tolerances import NEWTON_DECREASE, OVERLAP_FRACTION

#: Laid flat without overlap, a piece may be this much more distorted than the bound allows: a dart can still save it.
_APART_EXCESS = 2.0


@dataclass(frozen=True)
class Limits:
    """What a piece must keep to.

    Parameters
    ----------
    mean : float
        Its mean d at most.
    p99 : float
        What 99 % of its area keep to, at most; infinite: not asked for.
    size : (float, float), mm
        Width and height of the bed, less the mould's walls; either way round.
    fits : callable, optional
        Whether a piece with this outline, (b, 2) mm in the piece frame, fits the bed with what its mould has about it.
    neck : float, mm
        What hangs on less than this, laid flat, would tear off; 0: not asked for.
    """

    mean: float = 4.05
    p99: float = np.inf
    size: tuple[float, float] = (np.inf, np.inf)
    fits: Callable[[NDArray[np.float64]], bool] | None = None
    neck: float = 0.0


@dataclass(frozen=True)
class Parted:
    """A larger piece that was parted because of a length, not of its flatness.

    Parameters
    ----------
    first_face : int
        Of the mesh; which piece it was.
    large : bool
        It did not fit the bed.
    neck : float, mm
        Width of a neck too narrow; 0: it had none.
    flat : bool
        It was good but for that.
    """

    first_face: int
    large: bool
    neck: float
    flat: bool


@dataclass(frozen=True, eq=False)
class Verdict:
    """A flattened piece and what is wrong with it.

    Parameters
    ----------
    UV : (p, 2) float64, mm
        In the piece frame.
    distortion : Distortion
    too_distorted, overlaps, too_large : bool
    neck : Neck, optional
        One that is too narrow; not looked for in what is bad already.
    parted : Parted, optional
        Of which the piece is a part, see `refine_seams`.
    """

    UV: NDArray[np.float64]
    distortion: Distortion
    too_distorted: bool
    overlaps: bool
    too_large: bool
    neck: Neck | None = None
    parted: Parted | None = None

    @property
    def accepted(self) -> bool:
        return not (self.too_distorted or self.overlaps or self.too_large) and self.neck is None


def judge(mesh: Mesh, piece: OpenPiece, limits: Limits, *, tolerance: float = NEWTON_DECREASE, untangle: bool = True) -> Verdict:
    """Flatten a disk, to `tolerance` of what is above 4, and hold it against `limits`.

    A piece that cannot keep to the bound is flattened only as far as that takes to see. One that overlaps is
    flattened anew without overlap where that costs little (unless `untangle` is off, which is quicker): it may then
    need a dart, but not be parted.
    """
    V, F, topology = mesh.V[piece.vertices], piece.F, piece.topology
    uv = flatten_isometric(V, F, topology=topology, tolerance=tolerance, hopeless_above=limits.mean)
    first = verdict_of(mesh, piece, uv, limits)
    if not first.overlaps or first.too_distorted or first.too_large or not untangle:
        return first
    most = 4 + _APART_EXCESS * (limits.mean - 4)
    uv = flatten_bijective(V, F, topology=topology, tolerance=tolerance, hopeless_above=most)
    apart = verdict_of(mesh, piece, uv, limits)
    return first if apart.distortion.mean > most else apart


def excess(distortion: Distortion, limits: Limits) -> str:
    """In words, which bound on d a piece that is too distorted does not keep to."""
    if distortion.mean <= limits.mean and not distortion.p99 <= limits.p99:
        return f"a p99 of d of {distortion.p99:.3f}, over the bound {limits.p99:g}"
    return f"mean d {distortion.mean:.3f}, over the bound {limits.mean:g}"


def verdict_of(mesh: Mesh, piece: OpenPiece, uv: NDArray[np.float64], limits: Limits) -> Verdict:
    """Hold a flattening of `piece`, (p, 2) mm in any frame, against `limits`."""
    uv = orient(uv)
    distortion = measure(mesh.V[piece.vertices], piece.F, uv, topology=piece.topology)
    area = float(mesh.face_areas[piece.faces].sum())
    (w, h), (W, H) = np.ptp(uv, axis=0), sorted(limits.size, reverse=True)
    outline = uv[piece.topology.boundary_loops[0]]
    too_distorted = not distortion.mean <= limits.mean or not distortion.p99 <= limits.p99 or distortion.flipped > 0
    overlaps = not distortion.overlap_mm2 <= OVERLAP_FRACTION * area
    return Verdict(
        UV=uv,
        distortion=distortion,
        too_distorted=too_distorted,
        overlaps=overlaps,
        # What is far from flat yet has no size yet, but more area than the bed has will not fit in any case.
        too_large=bool(
            area > W * H or (distortion.mean <= limits.mean and (w > W or h > H or (limits.fits is not None and not limits.fits(outline))))
        ),
        neck=None if too_distorted or overlaps else find_neck(piece.F, uv, limits.neck, topology=piece.topology),
    )
