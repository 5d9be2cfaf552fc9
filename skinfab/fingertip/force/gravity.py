"""The centre of gravity of a held object, from the force and moment of the whole hand in several poses.

In the hand's frame the object's weight F acts at t, so M = t x F: a pose gives the line q + c F through t, q = F x M / |F|^2.
As published ("Machine Learning-Enhanced Fingertip Tactile Sensing", eqs. 3 to 9) t is the point nearest to all lines, A t = b with
A = sum(I - g g^T) and b = sum(q). A sensor's offsets turn all lines aside alike, and no number of poses shows it. Here they are
fitted with the point: M = t x F + c holds with one constant c, whatever the offsets of force and moment are, and force and
moment both have errors, so that the point of largest likelihood is that of a regression with errors in both variables.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.wrench import SensorNoise

FloatArray = NDArray[np.float64]

#: Standard gravity, m/s^2.
GRAVITY = 9.80665
#: A result whose standard deviation in its worst direction is larger than this, mm, is refused: the paper's own typical error.
WORST_SD_MM = 5.0
#: Lines that lie apart by more than their noise explains, by a chance of less than this, do not meet.
MEET_CHANCE = 0.001
#: Of an eigenvalue beside the largest one: below, there are too few poses, or all alike.
_SINGULAR = 1e-9
_STEPS, _SETTLED = 100, 1e-7
#: Of an estimated covariance of three components: one more than they are.
_SPENT = 4
#: The part of the errors that an ellipsoid of 95 % holds, also where the covariance is an estimate.
_STATED = 0.95


@dataclass(frozen=True, eq=False)
class Centre:
    """A centre of gravity.

    Parameters
    ----------
    point : (3,) float, mm
        In the frame of the forces and moments.
    covariance : (3, 3) float, mm^2
        Of the point; where the lines lie apart by more than the noise explains, as much larger.
    offset : (3,) float, N mm
        What the moment is off by (c above: the offsets of force and moment together); zeros as published.
    eigenvalue : float
        Smallest of A, divided by the number of poses: 0 where all lines are parallel, 2/3 where they come from everywhere.
    residual_mm : (n,) float
        From the point to each line, less the offset.
    misfit : float
        Sum of squares by what the noise explains: about 1; far above, the lines do not meet.
    chance : float
        Of lines that lie as far apart from noise alone. NaN where the noise was not given.
    """

    point: FloatArray
    covariance: FloatArray
    offset: FloatArray
    eigenvalue: float
    residual_mm: FloatArray
    misfit: float
    chance: float

    @property
    def sd_mm(self) -> float:
        """Standard deviation in the worst direction."""
        return float(np.sqrt(np.linalg.eigvalsh(self.covariance)[-1]))

    @property
    def worst(self) -> FloatArray:
        """The worst direction, a unit vector."""
        direction: FloatArray = np.linalg.eigh(self.covariance)[1][:, -1]
        return direction

    @property
    def meets(self) -> bool:
        """Do the lines meet in a point, within the noise?"""
        return not self.chance < MEET_CHANCE


def lines(force: FloatArray, moment: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The lines of poses: a point q (n, 3) mm on each, the nearest to the origin, and its unit direction g (n, 3).

    Examples
    --------
    >>> q, g = lines(np.array([[0.0, 0.0, -2.0]]), np.cross([[10.0, 20.0, 150.0]], [[0.0, 0.0, -2.0]]))
    >>> q.tolist(), g.tolist()
    ([[10.0, 20.0, 0.0]], [[0.0, 0.0, -1.0]])
    """
    square = np.einsum("ij,ij->i", force, force)[:, None]
    return np.cross(force, moment) / square, force / np.sqrt(square)


def published_centre(force: ArrayLike, moment: ArrayLike, covariance: ArrayLike | None = None, *, freedom: float = math.inf) -> Centre:
    """The point nearest to all lines, as published: right where the sensors have no offset.

    Parameters
    ----------
    force : (n, 3) float, N
        Of all fingers together, in the hand's frame, a row a pose.
    moment : (n, 3) float, N mm
    covariance : (6, 6) or (n, 6, 6) float, optional
        Of force and moment of a pose, N and N mm; where left out, it is that of `SensorNoise`, in the size that the lines'
        distances show.
    freedom : float
        Independent samples that the covariance was estimated from; infinite where it is known.

    Raises
    ------
    InputError
        Shapes do not fit, there are fewer than two poses, or one without a force.
    RefusedError
        All lines are parallel.

    Examples
    --------
    >>> F = np.array([[0.0, 0.0, -2.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
    >>> published_centre(F, np.cross([[10.0, 20.0, 150.0]], F)).point.round(6).tolist()
    [10.0, 20.0, 150.0]
    """
    F, M, S, scaled = checked(force, moment, covariance, least=2)
    q, g = lines(F, M)
    across = np.eye(3) - g[:, :, None] * g[:, None, :]
    A = across.sum(axis=0)
    eigenvalue = require_regular(A, len(F))
    inverse = np.linalg.inv(A)
    t = inverse @ q.sum(axis=0)
    size = np.linalg.norm(F, axis=1)[:, None, None]
    # q moves with F and M, and so does the line's direction, about which t lies at g . t.
    by_force = (-cross_matrices(M) - 2 * q[:, :, None] * F[:, None, :]) / size**2 + (
        (g @ t)[:, None, None] * np.eye(3) + g[:, :, None] * t
    ) @ across / size
    jacobian = np.concatenate([by_force, cross_matrices(F) / size**2], axis=2)
    apart = q - np.einsum("nij,j->ni", across, t)
    of_line = np.einsum("nij,njk,nlk->nil", jacobian, S, jacobian)
    # Of a line only the distance to it counts: two numbers a pose, in a plane across it.
    plane = np.linalg.svd(g[:, None, :])[2][:, 1:]
    seen = np.einsum("nij,nj->ni", plane, apart)
    square = np.einsum("ni,nij,nj->", seen, np.linalg.inv(plane @ of_line @ plane.transpose(0, 2, 1)), seen)
    misfit, chance, factor = explained(float(square), 2 * len(F) - 3, scaled, freedom)
    spread = inverse @ of_line.sum(axis=0) @ inverse.T
    return Centre(t, factor * spread, np.zeros(3), eigenvalue, np.linalg.norm(apart, axis=1), misfit, chance)


def centre_of_gravity(force: ArrayLike, moment: ArrayLike, covariance: ArrayLike | None = None, *, freedom: float = math.inf) -> Centre:
    """The point of largest likelihood, with the sensors' offsets fitted beside it.

    Parameters
    ----------
    force, moment, covariance, freedom
        As of `published_centre`.

    Raises
    ------
    InputError
        Shapes do not fit, there are fewer than three poses, or one without a force.
    RefusedError
        The poses do not tell the point from the offset: their forces lie on one straight line, or nearly at one place.

    Examples
    --------
    Offsets of 0.1 N and 5 N mm change nothing, and move the published point by millimetres:

    >>> F = 2 * np.array([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.0, -0.8]])
    >>> M = np.cross([[10.0, 20.0, 150.0]], F) + [5.0, 0.0, 0.0]
    >>> F = F + [0.1, 0.0, 0.0]
    >>> centre_of_gravity(F, M).point.round(6).tolist(), published_centre(F, M).point.round(0).tolist()
    ([10.0, 20.0, 150.0], [6.0, 18.0, 145.0])
    """
    F, M, S, scaled = checked(force, moment, covariance, least=3)
    apart = F - F.mean(axis=0)
    moved = np.einsum("ni,ni->", apart, apart) * np.eye(3) - apart.T @ apart
    values = np.linalg.eigvalsh(moved)
    if not values[0] > _SINGULAR * max(values[-1], float(np.einsum("ni,ni->", F, F))):
        raise _undetermined(F)
    unit = np.eye(3)
    # Plain least squares to begin with: M less its mean is t x (F less its mean), whose normal equations are `moved` t = ...
    t = np.linalg.solve(moved, np.cross(apart, M - M.mean(axis=0)).sum(axis=0))
    x = np.concatenate([t, (M - np.cross(t, F)).mean(axis=0)])
    square, information = 0.0, np.eye(6)
    for _ in range(_STEPS):
        t = x[:3]
        to_residual = np.concatenate(
            [-np.broadcast_to(cross_matrices(t[None]), (len(F), 3, 3)), np.broadcast_to(unit, (len(F), 3, 3))], axis=2
        )
        residual = M - np.cross(t, F) - x[3:]
        gain = S @ to_residual.transpose(0, 2, 1)
        try:
            weight = np.linalg.inv(to_residual @ gain)
        except np.linalg.LinAlgError:  # the point ran off so far that next to it nothing else counts
            raise _undetermined(F) from None
        # The force as it most likely was: linearised about what was read, the point would be drawn towards the origin.
        likely = F - np.einsum("nij,njk,nk->ni", gain, weight, residual)[:, :3]
        design = np.concatenate([cross_matrices(likely), -np.broadcast_to(unit, (len(F), 3, 3))], axis=2)
        information = np.einsum("nji,njk,nkl->il", design, weight, design)
        slope = np.einsum("nji,njk,nk->i", design, weight, residual)
        # The moments' part of x is N mm and the point's mm: scaled, so that neither is lost in the other's digits.
        if not (np.diag(information) > 0).all():
            raise _undetermined(F)
        scale = 1 / np.sqrt(np.diag(information))
        try:
            step = -scale * np.linalg.solve(information * np.outer(scale, scale), scale * slope)
        except np.linalg.LinAlgError:
            raise _undetermined(F) from None
        x = x + step
        square = float(np.einsum("ni,nij,nj->", residual, weight, residual))
        if np.abs(step[:3]).max() < _SETTLED * (1 + np.abs(x[:3]).max()):
            break
    else:
        raise _undetermined(F)
    misfit, chance, factor = explained(square, 3 * len(F) - 6, scaled, freedom)
    scale = 1 / np.sqrt(np.diag(information))
    spread = np.outer(scale, scale) * np.linalg.inv(information * np.outer(scale, scale))
    q, g = lines(F, M - x[3:])
    away = q - x[:3]
    distance = np.linalg.norm(away - np.einsum("ni,ni->n", away, g)[:, None] * g, axis=1)
    eigenvalue = float(np.linalg.eigvalsh(len(F) * unit - g.T @ g)[0]) / len(F)
    return Centre(x[:3].copy(), factor * spread[:3, :3], x[3:].copy(), eigenvalue, distance, misfit, chance)


def require_certain(centre: Centre, force: ArrayLike, *, worst_sd_mm: float = WORST_SD_MM) -> None:
    """Refuse a centre that the poses leave too uncertain, and say how far they span.

    Raises
    ------
    RefusedError
    """
    if centre.sd_mm <= worst_sd_mm:
        return
    direction = ", ".join(f"{each:.2f}" for each in centre.worst)
    raise RefusedError(
        f"the centre of gravity is uncertain by {centre.sd_mm:.1f} mm (one standard deviation) along ({direction}), and "
        f"{worst_sd_mm:g} mm are allowed: gravity came from directions within {pose_span(force):.0f} degrees; turn the hand farther, or "
        "take more samples"
    )


def pose_span(force: ArrayLike) -> float:
    """Largest angle between two poses' directions of gravity, degrees.

    Examples
    --------
    >>> round(pose_span([[0, 0, -1.0], [1.0, 0, 0], [0, 1.0, 0]]), 6)
    90.0
    """
    F = np.asarray(force, dtype=float)
    g = F / np.linalg.norm(F, axis=1, keepdims=True)
    return float(np.degrees(np.arccos(np.clip((g @ g.T).min(), -1.0, 1.0))))


def _undetermined(F: FloatArray) -> RefusedError:
    return RefusedError(
        f"the {len(F)} poses do not tell the centre of gravity from an offset of the sensor: gravity came from directions within "
        f"{pose_span(F):.0f} degrees, or along one line; turn the hand farther, and about another axis too"
    )


def checked(
    force: ArrayLike, moment: ArrayLike, covariance: ArrayLike | None, *, least: int
) -> tuple[FloatArray, FloatArray, FloatArray, bool]:
    """Checked forces, moments, a covariance a pose, and whether its size is unknown."""
    F, M = np.array(force, dtype=float), np.array(moment, dtype=float)
    if F.ndim != 2 or F.shape[1] != 3 or F.shape != M.shape:
        raise InputError(f"forces have the shape {F.shape} and moments {M.shape}; give (n, 3) each, a row a pose")
    if len(F) < least:
        raise InputError(
            f"there {'is' if len(F) == 1 else 'are'} {len(F)} pose{'s' * (len(F) != 1)}, and {least} are needed; turn the hand"
        )
    if not (np.isfinite(F).all() and np.isfinite(M).all()):
        raise InputError("a force or a moment is not a number; leave that pose out")
    if weightless := np.flatnonzero(np.einsum("ij,ij->i", F, F) == 0).tolist():
        raise InputError(f"pose {weightless[0] + 1} has no force at all; leave it out, or look at the sensor")
    noise = SensorNoise()
    given = np.diag([noise.force_n**2] * 3 + [noise.moment_nmm**2] * 3) if covariance is None else np.array(covariance, dtype=float)
    if given.shape not in ((6, 6), (len(F), 6, 6)) or not np.isfinite(given).all():
        raise InputError(f"a covariance of the shape {given.shape} does not fit {len(F)} poses; give (6, 6) or ({len(F)}, 6, 6)")
    if np.linalg.eigvalsh(given).min() <= 0:
        raise InputError("a covariance is not positive: some component has no noise at all; give the sensor's noise")
    return F, M, np.broadcast_to(given, (len(F), 6, 6)), covariance is None


def explained(square: float, freedom: int, scaled: bool, of_noise: float) -> tuple[float, float, float]:
    """Misfit, its chance, and what the covariance is multiplied by."""
    wider, left = 1.0, max(of_noise - _SPENT, 1.0)
    if math.isfinite(of_noise):
        # The inverse of an estimated covariance is too large by n / (n - 4) on average (Wishart, three components of a pose's
        # residual), and the point scatters by F and not by chi-square.
        from scipy.stats import chi2, f

        square *= left / of_noise
        wider = of_noise / left * 3 * float(f.ppf(_STATED, 3, left)) / float(chi2.ppf(_STATED, 3))
    if freedom <= 0:
        return float("nan"), float("nan"), wider
    misfit = square / freedom
    if scaled:
        return misfit, float("nan"), misfit
    from scipy.stats import f as fisher

    chance = float(fisher.sf(misfit, freedom, left)) if math.isfinite(of_noise) else _chi_square(square, freedom)
    # Where something else than noise moves the lines (an object that slips, a crooked sensor), the noise does not say how far.
    return misfit, chance, wider * misfit if chance < MEET_CHANCE else wider


def _chi_square(square: float, freedom: int) -> float:
    from scipy.stats import chi2

    return float(chi2.sf(square, freedom))


def require_regular(A: FloatArray, n: int) -> float:
    """The smallest eigenvalue of the sum of n lines' projections, a pose; parallel lines are refused."""
    values = np.linalg.eigvalsh(A)
    if not values[0] > _SINGULAR * values[-1]:
        raise RefusedError(f"gravity comes from one direction in all {n} poses, so their lines are parallel; turn the hand between poses")
    return float(values[0]) / n


def cross_matrices(v: FloatArray) -> FloatArray:
    """Matrices (n, 3, 3) of v (n, 3) x."""
    out = np.zeros((len(v), 3, 3))
    out[:, 0, 1], out[:, 0, 2], out[:, 1, 2] = -v[:, 2], v[:, 1], -v[:, 0]
    out[:, 1, 0], out[:, 2, 0], out[:, 2, 1] = v[:, 2], -v[:, 1], v[:, 0]
    return out
