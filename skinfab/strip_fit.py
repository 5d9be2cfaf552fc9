"""What printed calibration strips tell of the ink: the cross-section that conducts, the contacts and the scatter.

Of strips of several lengths L, each with two contacts, ln R = ln(k L + 2 R_contact) + e with k = rho / A_eff and e
normal with standard deviation sigma: the scatter from print to print is a factor, not a sum (the paper's tables of
starting resistances spread by more than ten times). Least squares in ln R are then maximum likelihood.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.electrical import KOHM_MM_PER_OHM_CM
from skinfab.errors import InputError, RefusedError
from skinfab.material import Material

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

#: A table larger than this is none of ours.
TABLE_MAX_BYTES = 1_000_000


@dataclass(frozen=True)
class Strips:
    """Measured strips.

    Parameters
    ----------
    length_mm, r_kohm : (n,) float
    unmeasured : tuple of str
        Lines of the table without a resistance: strips that broke or were not measured.
    """

    length_mm: NDArray[np.float64]
    r_kohm: NDArray[np.float64]
    unmeasured: tuple[str, ...] = ()


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
    """

    effective_area_mm2: Estimate
    log_sigma: Estimate
    contact_resistance_kohm: Estimate
    n: int
    lengths: int
    misfit_p: float


def read_strips(path: str | Path) -> Strips:
    """Read a CSV file with the columns length_mm and r_kohm; an empty r_kohm is a strip that was not measured.

    Raises
    ------
    InputError
        The file cannot be read, a column is missing, or a value is not a positive number.
    """
    path = Path(path)
    try:
        if path.stat().st_size > TABLE_MAX_BYTES:
            raise InputError(f"{path} is too large for a table of strips; give the strips.csv that skinfab strips made")
        rows = list(csv.DictReader(path.read_text(encoding="utf-8-sig").splitlines(), restval="", strict=True))
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror or fault}; give the strips.csv that skinfab strips made, filled in") from fault
    except (UnicodeDecodeError, csv.Error) as fault:
        raise InputError(f"{path} is not a CSV file: {fault}; save the table as CSV, UTF-8") from fault
    measured: list[tuple[float, float]] = []
    unmeasured = []
    for number, row in enumerate(rows, start=2):
        for name in ("length_mm", "r_kohm"):
            if name not in row:
                raise InputError(f"{path}: there is no column {name!r}; the first line names the columns, length_mm and r_kohm among them")
        if not row["r_kohm"].strip():
            unmeasured.append(f"line {number}")
            continue
        measured.append(
            (_positive(row["length_mm"], f"{path}, line {number}: length_mm"), _positive(row["r_kohm"], f"{path}, line {number}: r_kohm"))
        )
    length, r = np.array(measured, dtype=float).reshape(-1, 2).T
    return Strips(length, r, tuple(unmeasured))


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
    if flat >= 0 or inside[-1]:
        raise RefusedError(
            f"with a scatter of {math.sqrt(variance):.2g} in ln R, {n} strips do not tell for sure that resistance grows with length; "
            "measure more strips, or look for broken ones"
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


def _misfit(y: NDArray[np.float64], groups: Sequence[NDArray[np.int64]], squares: float) -> float:
    """The F test of lack of fit, against the scatter within each length."""
    from scipy import stats

    pure = sum(float(((y[group] - y[group].mean()) ** 2).sum()) for group in groups)
    between, within = len(groups) - 2, len(y) - len(groups)
    if within < 1 or not pure > 0:
        return 1.0
    return float(stats.f.sf(max(squares - pure, 0.0) / between / (pure / within), between, within))


def _positive(text: str, what: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value < math.inf:
        raise InputError(f"{what} is {text!r}; it must be a positive number, or an empty r_kohm where a strip is broken")
    return value
