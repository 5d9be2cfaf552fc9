"""What printed calibration strips tell of the ink: the cross-section that conducts, the contacts and the scatter.

Of strips of several lengths L, each with two contacts, ln R = ln(k L + 2 R_contact) + e with k = rho / A_eff and e
normal with standard deviation sigma: the scatter from print to print is a factor, not a sum (the paper's tables of
starting resistances spread by more than ten times). Least squares in ln R are then maximum likelihood.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.electrical import KOHM_MM_PER_OHM_CM
from skinfab.errors import RefusedError
from skinfab.material import Ink, Material
from skinfab.strip_table import Strips

#: The least that is fitted: with fewer strips sigma is not known to a factor of two, with fewer lengths a contact
#: cannot be told from a line that does not grow as it should.
STRIPS_MIN = 6
LENGTHS_MIN = 3

#: Lengths nearer to each other than this fraction count as one.
SAME_LENGTH = 0.01

#: Confidence of all intervals.
CONFIDENCE = 0.95

#: How finely contacts are tried, in lengths of line that resist as much as both: 0, and steps of half a per cent.
_TRIED = 3001

#: A strip is called an outlier where scatter alone puts the farthest of so many as far off once in a hundred plates.
OUTLIER_P = 0.01

#: The cross-section that conducts is that of the bead, or less where it is rough and broken: the paper's tables, which spread by
#: fifteen times, are within this factor of it. Resistances in ohm or megaohm are a thousand times off.
AREA_FACTOR = 30.0


@dataclass(frozen=True)
class Estimate:
    """A value, its standard error, and its 95 % interval."""

    value: float
    se: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.3g} (standard error {self.se:.2g}, 95 %: {self.low:.3g} to {self.high:.3g})"


@dataclass(frozen=True)
class Outlier:
    """The strip farthest from what the others lead one to expect.

    Parameters
    ----------
    name : str
    r_kohm, expected_kohm : float
        As measured, and the model's median without it.
    """

    name: str
    r_kohm: float
    expected_kohm: float

    def __str__(self) -> str:
        times = self.r_kohm / self.expected_kohm
        off = f"{times:.3g} times" if times > 1 else f"1/{1 / times:.3g} of"
        return f"{self.name} has {self.r_kohm:.4g} kohm, {off} what the other strips lead one to expect"


@dataclass(frozen=True)
class StripFit:
    """What the strips tell.

    Parameters
    ----------
    effective_area_mm2, log_sigma, contact_resistance_kohm : Estimate
    n : int
        Strips fitted.
    lengths : int
        Different lengths among them.
    misfit_p : float
        How likely means over each length lie as far from the model as these, if the model is right; one where
        each length has one strip.
    outlier : Outlier, optional
        A strip that does not belong to the others.
    """

    effective_area_mm2: Estimate
    log_sigma: Estimate
    contact_resistance_kohm: Estimate
    n: int
    lengths: int
    misfit_p: float
    outlier: Outlier | None = None


def fit_strips(strips: Strips, *, resistivity_ohm_cm: float) -> StripFit:
    """Fit (A_eff, sigma, R_contact), with standard errors and intervals that hold for few strips too.

    With q = 2 R_contact / k, the length of line that resists as much as both contacts, the model is
    ln R = ln k + ln(L + q): for each q, ln k is a mean. So all q >= 0 are tried, and the intervals of A_eff and R_contact
    are those of the profile of the sum of squares (F distribution), which are not symmetric; that of sigma is from chi squared.

    Parameters
    ----------
    strips : Strips
    resistivity_ohm_cm : float
        Of the ink, as its maker says; only the ratio of it to A_eff can be measured.

    Raises
    ------
    RefusedError
        It cannot be told: too few strips or lengths, all resistances alike, or no sure growth of resistance with length.

    Examples
    --------
    >>> strips = Strips(np.array([40.0, 160, 640] * 3), np.array([61.0, 205, 900, 55, 230, 780, 70, 190, 850]))
    >>> fit = fit_strips(strips, resistivity_ohm_cm=63.0)
    >>> round(fit.effective_area_mm2.value, 2), round(fit.contact_resistance_kohm.value, 1), round(fit.log_sigma.value, 2)
    (0.5, 5.2, 0.09)
    """
    from scipy import stats

    length, y = strips.length_mm, np.log(strips.r_kohm)
    n, groups = len(length), _groups(length)
    if n < STRIPS_MIN or len(groups) < LENGTHS_MIN:
        raise RefusedError(
            f"{n} strips of {len(groups)} length{'s' * (len(groups) != 1)} cannot tell area, contact and scatter apart; "
            f"measure at least {STRIPS_MIN} strips of at least {LENGTHS_MIN} lengths"
        )
    q = np.concatenate([[0.0], np.geomspace(1e-2 * length.min(), 1e3 * length.max(), _TRIED - 1)])
    rest = y - np.log(length + q[:, None])
    log_k = rest.mean(axis=1)
    squares = ((rest - log_k[:, None]) ** 2).sum(axis=1)
    best = int(np.argmin(squares))
    freedom = n - 2
    variance = float(squares[best]) / freedom
    if not variance > 1e-12:
        raise RefusedError(
            "the strips lie on the model to the last digit, so they tell nothing of the scatter; give resistances as measured"
        )
    # Joint region of (ln k, q) that the F distribution of one parameter at a time cuts off.
    room = variance * stats.f.ppf(CONFIDENCE, 1, freedom) - (squares - squares[best])
    flat = variance * stats.f.ppf(CONFIDENCE, 1, freedom) - (((y - y.mean()) ** 2).sum() - squares[best])
    inside = room >= 0
    outlier = _outlier(strips, rest - log_k[:, None], squares)
    if flat >= 0 or inside[-1]:
        raise RefusedError(
            f"with a scatter of {math.sqrt(variance):.2g} in ln R, {n} strips do not tell for sure that resistance grows with length; "
            + (f"{outlier}: measure it again, or leave its r_kohm empty" if outlier else "measure more strips, or look for broken ones")
        )
    reach = np.sqrt(room[inside] / n)
    lowest, highest = log_k[inside] - reach, log_k[inside] + reach
    k, contact = math.exp(log_k[best]), math.exp(log_k[best]) * float(q[best]) / 2
    # Of ln k and q, from the derivatives 1 and 1 / (L + q).
    slope = np.column_stack([np.ones(n), 1 / (length + q[best])])
    covariance = variance * np.linalg.inv(slope.T @ slope)
    by_contact = np.array([contact, k / 2])
    area = KOHM_MM_PER_OHM_CM * resistivity_ohm_cm / k
    sigma, chi = math.sqrt(variance), stats.chi2.ppf([(1 + CONFIDENCE) / 2, (1 - CONFIDENCE) / 2], freedom)
    contacts = q[inside] / 2
    return StripFit(
        Estimate(area, area * math.sqrt(covariance[0, 0]), area * k / math.exp(highest.max()), area * k / math.exp(lowest.min())),
        Estimate(sigma, sigma / math.sqrt(2 * freedom), *(sigma * math.sqrt(freedom / each) for each in chi)),
        Estimate(
            contact,
            math.sqrt(by_contact @ covariance @ by_contact),
            float((contacts * np.exp(lowest)).min()),
            float((contacts * np.exp(highest)).max()),
        ),
        n,
        len(groups),
        _misfit(y, groups, float(squares[best])),
        outlier,
    )


def require_plausible(fit: StripFit, ink: Ink) -> None:
    """The area must be that of the bead, give or take a factor of ``AREA_FACTOR``.

    Raises
    ------
    RefusedError
        It is not, as where the resistances are in another unit.
    """
    area, bead = fit.effective_area_mm2.value, ink.bead_area_mm2
    if bead / AREA_FACTOR <= area <= bead * AREA_FACTOR:
        return
    small = area < bead
    times = bead / area if small else area / bead
    hint = "are these ohm? Divide them by 1000" if small else "are these megaohm? Multiply them by 1000"
    raise RefusedError(
        f"the strips' resistances mean that {area:.3g} mm^2 conduct, {times:.3g} times {'less' if small else 'more'} than the bead's own "
        f"{bead:.3g} mm^2: r_kohm must be in kilo-ohm and length_mm in mm; {hint}; otherwise check the ink's resistivity_ohm_cm "
        "and bead_area_mm2 in the material profile"
    )


def fitted_material(material: Material, fit: StripFit) -> Material:
    """The material with what the strips told; what the printer extrudes stays as it was."""
    ink = replace(
        material.ink,
        effective_area_mm2=fit.effective_area_mm2.value,
        contact_resistance_kohm=fit.contact_resistance_kohm.value,
        log_sigma=fit.log_sigma.value,
    )
    return replace(material, ink=ink)


def _groups(length: NDArray[np.float64]) -> list[NDArray[np.int64]]:
    """Positions of the strips of each length."""
    order = np.argsort(length, kind="stable")
    breaks = np.flatnonzero(np.diff(length[order]) > SAME_LENGTH * length[order][:-1]) + 1
    return [group for group in np.split(order, breaks) if len(group)]


def _outlier(strips: Strips, off: NDArray[np.float64], squares: NDArray[np.float64]) -> Outlier | None:
    """The strip without which the fit is better by more than scatter explains: the F test of a mean shift of one strip
    (Cook and Weisberg, "Residuals and influence in regression", 1982, 2.2.2), with Bonferroni's bound over all strips.

    `off` are the residuals about the mean for each contact tried, (q, n), and `squares` their sums of squares.
    """
    from scipy import stats

    n = len(strips.length_mm)
    without = squares[:, None] - n / (n - 1) * off**2
    best = without.argmin(axis=0)
    left = np.take_along_axis(without, best[None], axis=0)[0]
    k = int(left.argmin())
    gain = (float(squares.min()) - left[k]) / max(float(left[k]) / (n - 3), np.finfo(float).tiny)
    if n * stats.f.sf(gain, 1, n - 3) >= OUTLIER_P:
        return None
    return Outlier(strips.name(k), float(strips.r_kohm[k]), float(strips.r_kohm[k]) / math.exp(off[best[k], k] * n / (n - 1)))


def _misfit(y: NDArray[np.float64], groups: Sequence[NDArray[np.int64]], squares: float) -> float:
    """The F test of lack of fit, against the scatter within each length."""
    from scipy import stats

    pure = sum(float(((y[group] - y[group].mean()) ** 2).sum()) for group in groups)
    between, within = len(groups) - 2, len(y) - len(groups)
    if within < 1 or not pure > 0:
        return 1.0
    return float(stats.f.sf(max(squares - pure, 0.0) / between / (pure / within), between, within))
