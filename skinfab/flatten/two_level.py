"""Lower d on a fine mesh by factoring a coarse one only, and tell how much lower it could get.

Newton's system on the fine mesh is solved by conjugate gradients. What is long-waved in the residual is solved on
the coarse mesh, what is short-waved by each vertex's own 2 x 2 block (Bramble, Pasciak and Xu 1990, "Parallel
Multilevel Preconditioners", with two levels); so a dozen products with the matrix do what a factorisation would.

Every step of conjugate gradients says by how much it lowers Newton's quadratic model. Their sum, and a geometric
tail for the steps not taken (after Strakos and Tichy 2002, "On Error Estimation in the Conjugate Gradient Method"),
is what d could still lose.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, csr_array

from skinfab.flatten.isometric import IsometricSolver
from skinfab.linalg import Cholesky
from skinfab.tolerances import SIMPLIFY_EFFECT

FloatArray = NDArray[np.float64]

#: Conjugate gradients stop when the tail is under this share of the sum ...
_TAIL = 0.05
#: ... and not before this many steps: the short waves go in the first four, and only then do the middle ones show.
_LEAST_ITERATIONS = 8
#: Ratio of two steps' gains is the mean over this many.
_RATIO_OVER = 4
_MOST_ITERATIONS = 40
#: No tail is believed to fall off more slowly than this.
_SLOWEST = 0.95

#: Rounds end at a fifth of what is accepted: room for what the quadratic model misses.
_AIM = SIMPLIFY_EFFECT / 5
#: Newton's method doubles its digits from round to round; where three do not get there, more will not.
_MOST_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class Relaxed:
    """A layout with less distortion than it had.

    Parameters
    ----------
    UV : (n, 2) float64, mm
    mean_d : float
    effect : float
        What the mean d of `UV` can still lose, at most: so much could it before the last round, or if the rounds gain
        ever less but slowly, so much would all later ones gain.
    products : int
        With the fine matrix: what the work is made of.
    """

    UV: FloatArray
    mean_d: float
    effect: float
    products: int


class CoarseCorrection:
    """Solves for the long waves: the Hessian of a coarse mesh at its own least d, factored once.

    Parameters
    ----------
    solver : IsometricSolver
        Of the coarse mesh.
    UV : (k, 2) float64, mm
        Its layout of least d.
    interpolation : (n, k) sparse
        From the coarse mesh's vertices to the fine one's.
    """

    def __init__(self, solver: IsometricSolver, UV: FloatArray, interpolation: csr_array) -> None:
        self._cholesky = Cholesky(solver.hessian(UV)[0])
        self._up, self._down = interpolation, csr_array(interpolation.T)

    def __call__(self, residual: FloatArray) -> FloatArray:
        """(n, 2) to (n, 2)."""
        coarse = self._cholesky.solve(np.ascontiguousarray(self._down @ residual).ravel())
        found: FloatArray = self._up @ coarse.reshape(-1, 2)
        return found


def relax(solver: IsometricSolver, UV: FloatArray, correction: CoarseCorrection) -> Relaxed:
    """Newton's rounds on the fine mesh, without factoring it, until d can lose no more than a fifth of `SIMPLIFY_EFFECT`.

    Parameters
    ----------
    solver : IsometricSolver
        Of the fine mesh.
    UV : (n, 2) float64, mm
        Without flips.
    correction : CoarseCorrection
    """
    u, products, before = UV, 0, np.inf
    for _ in range(_MOST_ROUNDS):
        lower, gradient = solver.hessian(u)
        step, promise, spent = _solve(lower, gradient.reshape(-1, 2), correction)
        u, mean = solver.descend(u, step, float(gradient @ step.ravel()))
        products += spent
        ratio = min(promise / before, _SLOWEST)
        effect, before = promise * max(1.0, ratio / (1 - ratio)), promise
        if effect <= _AIM:
            break
    return Relaxed(u, mean, effect, products)


def _solve(lower: csc_array, gradient: FloatArray, correction: CoarseCorrection) -> tuple[FloatArray, float, int]:
    """Newton's step (n, 2), by how much its full length would lower the quadratic model, and the products it took."""
    diagonal = lower.diagonal()
    upper = csr_array((lower.data, lower.indices, lower.indptr), shape=lower.shape)  # the same arrays, read by rows

    def product(x: FloatArray) -> FloatArray:
        flat = x.ravel()
        return (lower @ flat + upper @ flat - diagonal * flat).reshape(-1, 2)

    blocks = _inverse_blocks(lower)

    def precondition(r: FloatArray) -> FloatArray:
        own = np.stack([blocks[0] * r[:, 0] + blocks[1] * r[:, 1], blocks[1] * r[:, 0] + blocks[2] * r[:, 1]], axis=1)
        return own + correction(r)

    step, residual = np.zeros_like(gradient), -gradient
    z = precondition(residual)
    direction, size = z, _dot(residual, z)
    gains: list[float] = []
    while len(gains) < _MOST_ITERATIONS and size > 0:
        image = product(direction)
        length = size / _dot(direction, image)
        step = step + length * direction
        residual = residual - length * image
        gains.append(length * size / 2)
        if len(gains) >= _LEAST_ITERATIONS and _tail(gains) <= _TAIL * sum(gains):
            break
        z = precondition(residual)
        size, before = _dot(residual, z), size
        direction = z + size / before * direction
    return step, sum(gains) + _tail(gains), len(gains)


def _dot(a: FloatArray, b: FloatArray) -> float:
    # Not by BLAS, whose threads cost more to wake than so short a sum takes.
    return float(np.einsum("ij,ij->", a, b))


def _tail(gains: list[float]) -> float:
    """What the steps not taken would gain, were it to fall off as over the last ones."""
    if not gains:
        return 0.0
    if len(gains) <= _RATIO_OVER:
        return gains[-1] * _SLOWEST / (1 - _SLOWEST)
    ratio = min((gains[-1] / gains[-1 - _RATIO_OVER]) ** (1 / _RATIO_OVER), _SLOWEST)
    return gains[-1] * ratio / (1 - ratio)


def _inverse_blocks(lower: csc_array) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Inverses of the vertices' own 2 x 2 blocks: xx, xy, yy, (n,) each."""
    diagonal = lower.diagonal()
    xx, yy = diagonal[::2], diagonal[1::2]
    xy = lower.diagonal(-1)[::2]
    determinant = xx * yy - xy * xy
    return yy / determinant, -xy / determinant, xx / determinant
