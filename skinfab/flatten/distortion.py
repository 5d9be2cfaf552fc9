"""How far a flattening is from an isometry: singular values and the distortion d of each triangle.

d = (1 + s1^-2 s2^-2)(s1^2 + s2^2) is equation 1 of "Soft Sensing Skins for Arbitrary Objects" and is
the symmetric Dirichlet energy s1^2 + s2^2 + s1^-2 + s2^-2; 4 is perfect.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.overlap import overlap_area
from skinfab.mesh.topology import Topology
from skinfab.tolerances import DEGENERATE_HEIGHT

FloatArray = NDArray[np.float64]

#: x, y and z of many vectors, (m,) each.
Columns = tuple[FloatArray, ...]


@dataclass(frozen=True, eq=False)
class Distortion:
    """Distortion of one flat piece, area-weighted.

    Parameters
    ----------
    d : (m,) float
        Per triangle; infinite where a triangle collapsed; 4 where it has no area on the object to begin with
        (no shape that could be distorted: such triangles count nowhere).
    angle, area : (m,) float
        The two parts of d = angle x area, each 2 where perfect: s1/s2 + s2/s1, of the shape, and s1 s2 + 1/(s1 s2), of the size.
    mean, p95, p99, max : float
        Area-weighted mean and quantiles of d, and its largest value.
    flipped : int
        Triangles turned over (or collapsed).
    overlap_mm2 : float
        Area that is covered more than once.
    """

    d: FloatArray
    angle: FloatArray
    area: FloatArray
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
    length, along, up = _in_plane(V, F)
    return np.stack([np.stack([length, np.zeros_like(length)], axis=1), np.stack([along, up], axis=1)], axis=1)


def _in_plane(V: FloatArray, F: NDArray[np.int64]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of each triangle in its own plane, (m,) each: length of edge 0-1, and corner 2 along and above it. Column by column, for speed."""
    a, b, c = np.ascontiguousarray(F.T)
    e1, e2 = zip(*((x[b] - x[a], x[c] - x[a]) for x in np.ascontiguousarray(V.T)), strict=True)
    length = np.sqrt(_dot(e1, e1))
    with np.errstate(divide="ignore", invalid="ignore"):
        return length, _dot(e1, e2) / length, _cross_length(e1, e2) / length


def _entries(rest: tuple[FloatArray, FloatArray, FloatArray], F: NDArray[np.int64], UV: FloatArray) -> tuple[FloatArray, ...]:
    """Entries a, b, c, d of the Jacobians [[a, b], [c, d]], (m,) each."""
    length, along, up = rest
    i, j, k = np.ascontiguousarray(F.T)
    out = []
    with np.errstate(divide="ignore", invalid="ignore"):
        for u in np.ascontiguousarray(UV.T):
            first = (u[j] - u[i]) / length
            out += [first, (u[k] - u[i] - first * along) / up]
    return tuple(out)


def stretch(V: FloatArray, F: NDArray[np.int64], UV: FloatArray) -> tuple[FloatArray, FloatArray]:
    """s1^2 + s2^2 and s1 s2 of each triangle, (m,) each: d needs no more."""
    a, b, c, d = _entries(_in_plane(V, F), F, UV)
    with np.errstate(invalid="ignore"):
        return a * a + b * b + c * c + d * d, a * d - b * c


def singular_values(V: FloatArray, F: NDArray[np.int64], UV: FloatArray) -> FloatArray:
    """s1 >= |s2| of each triangle, (m, 2); s2 is negative where the triangle is turned over.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    >>> singular_values(V, np.array([[0, 1, 2]]), V[:, :2] * [2, 3]).tolist()
    [[3.0, 2.0]]
    """
    a, b, c, d = _entries(_in_plane(V, F), F, UV)
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
    square, product = stretch(V, F, UV)
    area, real = shaped_areas(V, F)
    with np.errstate(divide="ignore", invalid="ignore"):
        # s1^2 + s2^2 + s1^-2 + s2^-2 = (s1/s2 + s2/s1) (s1 s2 + 1 / (s1 s2))
        parts = square / np.abs(product), np.abs(product + 1 / product)
        d = parts[0] * parts[1]
    d = np.where(real, np.where(np.isfinite(d), d, np.inf), 4.0)
    angle, swelling = (np.where(real, np.where(np.isfinite(part), part, np.inf), 2.0) for part in parts)
    p95, p99 = quantiles(d, area, (0.95, 0.99))
    return Distortion(
        d=d,
        angle=angle,
        area=swelling,
        mean=float(np.average(d, weights=area)),
        p95=p95,
        p99=p99,
        max=float(d.max()),
        flipped=int((~(product > 0) & real).sum()),
        overlap_mm2=overlap_area(F, UV, topology=topology),
    )


def quantiles(values: FloatArray, areas: FloatArray, shares: Sequence[float]) -> list[float]:
    """The least values that these shares of the area keep to."""
    order = np.argsort(values)
    share = np.cumsum(areas[order]) / areas.sum()
    return [float(values[order[min(int(np.searchsorted(share, q)), len(values) - 1)]]) for q in shares]


def mean_over(values: FloatArray, areas: FloatArray) -> float:
    """Mean by area of what is said of each triangle; those without area count nowhere, whatever is said of them."""
    real = areas > 0
    return float(np.average(values[real], weights=areas[real]))


def best_scale(V: FloatArray, F: NDArray[np.int64], UV: FloatArray) -> float:
    """The factor on `UV` that makes the mean d smallest.

    Scaling by t turns the mean into t^2 P + Q / t^2, least at t = (Q / P)^(1/4).
    """
    square, product = stretch(V, F, UV)
    area, real = shaped_areas(V, F)
    good = real & (product > 0)
    if not good.any():
        return 1.0
    weighted = area[good] * square[good]
    return float((np.sum(weighted / product[good] ** 2) / np.sum(weighted)) ** 0.25)


def shaped_areas(V: FloatArray, F: NDArray[np.int64]) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Area of each triangle, mm^2, and whether it is wide enough to have a shape."""
    a, b, c = np.ascontiguousarray(F.T)
    e1, e2 = zip(*((x[b] - x[a], x[c] - x[a]) for x in np.ascontiguousarray(V.T)), strict=True)
    across = tuple(q - p for p, q in zip(e1, e2, strict=True))
    twice = _cross_length(e1, e2)
    longest_square = np.maximum(np.maximum(_dot(e1, e1), _dot(e2, e2)), _dot(across, across))
    return twice / 2, twice > DEGENERATE_HEIGHT * longest_square


def _dot(u: Columns, v: Columns) -> FloatArray:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


def _cross_length(u: Columns, v: Columns) -> FloatArray:
    x, y, z = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
    length: FloatArray = np.sqrt(x * x + y * y + z * z)
    return length
