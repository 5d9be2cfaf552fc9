"""How far a flattening is from an isometry: singular values and the distortion d of each triangle.

d = (1 + s1^-2 s2^-2)(s1^2 + s2^2) is equation 1 of "Soft Sensing Skins for Arbitrary Objects" and is
the symmetric Dirichlet energy s1^2 + s2^2 + s1^-2 + s2^-2; 4 is perfect.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.overlap import overlap_area
from skinfab.mesh.topology import Topology
from skinfab.tolerances import DEGENERATE_HEIGHT

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Distortion:
    """Distortion of one flat piece, area-weighted.

    Parameters
    ----------
    d : (m,) float
        Per triangle; infinite where a triangle collapsed; 4 where it has no area on the object to begin with
        (no shape that could be distorted: such triangles count nowhere).
    mean, p95, p99, max : float
        Area-weighted mean and quantiles of d, and its largest value.
    flipped : int
        Triangles turned over (or collapsed).
    overlap_mm2 : float
        Area that is covered more than once.
    """

    d: FloatArray
    mean: float
    p95: float
    p99: float
    max: float
    flipped: int
    overlap_mm2: float

    def __repr__(self) -> str:
        return (
            f"Distortion(mean {self.mean:.4f}, p95 {self.p95:.4f}, p99 {self.p99:.4f}, max {self.max:.4f}, "
            f"{self.flipped} flipped, overlap {self.overlap_mm2:.3g} mm^2)"
        )


def local_triangles(V: FloatArray, F: NDArray[np.int64]) -> FloatArray:
    """Each triangle laid in its own plane, corner 0 at the origin, edge 0-1 along x: (m, 2, 2), rows e1, e2 in mm."""
    p = V[F]
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    length = _length(e1)
    twice_area = _length(np.cross(e1, e2))
    with np.errstate(divide="ignore", invalid="ignore"):
        along, up = np.einsum("ij,ij->i", e1, e2) / length, twice_area / length
    return np.stack([np.stack([length, np.zeros_like(length)], axis=1), np.stack([along, up], axis=1)], axis=1)


def jacobians(V: FloatArray, F: NDArray[np.int64], UV: FloatArray) -> FloatArray:
    """Jacobian of the map object -> flat of each triangle, in its local frame, (m, 2, 2)."""
    rest = local_triangles(V, F)
    q = UV[F]
    flat = np.stack([q[:, 1] - q[:, 0], q[:, 2] - q[:, 0]], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        column0 = flat[:, 0] / rest[:, 0, :1]
        column1 = (flat[:, 1] - column0 * rest[:, 1, :1]) / rest[:, 1, 1:]
    return np.stack([column0, column1], axis=2)


def singular_values(V: FloatArray, F: NDArray[np.int64], UV: FloatArray) -> FloatArray:
    """s1 >= |s2| of each triangle, (m, 2); s2 is negative where the triangle is turned over.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    >>> singular_values(V, np.array([[0, 1, 2]]), V[:, :2] * [2, 3]).tolist()
    [[3.0, 2.0]]
    """
    J = jacobians(V, F, UV)
    a, b, c, d = J[:, 0, 0], J[:, 0, 1], J[:, 1, 0], J[:, 1, 1]
    with np.errstate(invalid="ignore"):
        q, r = np.hypot(a + d, c - b) / 2, np.hypot(a - d, c + b) / 2
        return np.stack([q + r, q - r], axis=1)


def distortion_of(s: FloatArray) -> FloatArray:
    """d of singular values (m, 2); infinite where one is zero or not a number."""
    with np.errstate(divide="ignore", invalid="ignore"):
        square = s**2
        d = (square + 1 / square).sum(axis=1)
    return np.where(np.isfinite(d), d, np.inf)


def measure(V: FloatArray, F: NDArray[np.int64], UV: FloatArray, *, topology: Topology | None = None) -> Distortion:
    """Everything said of a flat piece's distortion.

    Parameters
    ----------
    V : (n, 3) float64, mm
    F : (m, 3) int64
    UV : (n, 2) float64, mm
    topology : Topology, optional
        Of `F`, where it is at hand.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> measure(V, np.array([[0, 1, 2], [0, 2, 3]]), V[:, :2])
    Distortion(mean 4.0000, p95 4.0000, p99 4.0000, max 4.0000, 0 flipped, overlap 0 mm^2)
    """
    s = singular_values(V, F, UV)
    d = distortion_of(s)
    area, real = shaped_areas(V, F)
    d = np.where(real, d, 4.0)
    order = np.argsort(d)
    share = np.cumsum(area[order]) / area.sum()
    p95, p99 = (float(d[order[min(int(np.searchsorted(share, q)), len(d) - 1)]]) for q in (0.95, 0.99))
    return Distortion(
        d=d,
        mean=float(np.average(d, weights=area)),
        p95=p95,
        p99=p99,
        max=float(d.max()),
        flipped=int((~(s[real, 1] > 0)).sum()),
        overlap_mm2=overlap_area(F, UV, topology=topology),
    )


def best_scale(V: FloatArray, F: NDArray[np.int64], UV: FloatArray) -> float:
    """The factor on `UV` that makes the mean d smallest.

    Scaling by t turns the mean into t^2 P + Q / t^2, least at t = (Q / P)^(1/4).
    """
    s = singular_values(V, F, UV)
    area, real = shaped_areas(V, F)
    good = real & (s[:, 1] > 0)
    square = s[good] ** 2
    return float((np.sum(area[good, None] / square) / np.sum(area[good, None] * square)) ** 0.25) if good.any() else 1.0


def shaped_areas(V: FloatArray, F: NDArray[np.int64]) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Area of each triangle, mm^2, and whether it is wide enough to have a shape."""
    a, b, c = (V[corner] for corner in F.T)
    side = b - a, c - b, a - c
    twice = _length(np.cross(side[0], c - a))
    longest = np.maximum(np.maximum(_length(side[0]), _length(side[1])), _length(side[2]))
    return twice / 2, twice > DEGENERATE_HEIGHT * longest**2


def _length(rows: FloatArray) -> FloatArray:
    """Of each row of three, (m,): column by column, which is several times faster than a norm along short rows."""
    x, y, z = rows.T
    return np.sqrt(x * x + y * y + z * z)
