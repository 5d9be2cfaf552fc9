"""Do the sensor conditions differ? The paper's tests: repeated-measures ANOVA with Bonferroni, or Friedman with Nemenyi.

Friedman's is taken where Shapiro and Wilk's test calls one condition not normal, or cannot tell because it does not vary. Where
Mauchly's test denies sphericity, the ANOVA's p is that of Greenhouse and Geisser.
"""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]

#: The paper's level.
LEVEL = 0.05


@dataclass(frozen=True)
class Pair:
    """Two conditions, and how likely a difference as large is by chance, corrected for the number of pairs."""

    a: str
    b: str
    p: float


@dataclass(frozen=True)
class Comparison:
    """Whether conditions differ.

    Parameters
    ----------
    method : str
        ``repeated-measures ANOVA`` or ``Friedman``.
    statistic : float
        F, or Q.
    dof : tuple of int
        Of F two, of Q one.
    p : float
    normality_p : float
        The least of the conditions'; NaN where one does not vary.
    sphericity_p : float
        Mauchly's; NaN where it was not asked for or cannot be had of so few participants.
    pairs : tuple of Pair
        All, in the order of the conditions.
    """

    method: str
    statistic: float
    dof: tuple[int, ...]
    p: float
    normality_p: float
    sphericity_p: float
    pairs: tuple[Pair, ...]

    def differing(self) -> tuple[Pair, ...]:
        """Pairs that differ at the paper's level; none where the conditions together do not."""
        return tuple(pair for pair in self.pairs if pair.p < LEVEL) if self.p < LEVEL else ()

    def __str__(self) -> str:
        name = "F" if len(self.dof) == 2 else "Q"
        p = "p < 0.0001" if self.p < 1e-4 else f"p = {self.p:.4f}"
        return f"{self.method}: {name}({', '.join(map(str, self.dof))}) = {self.statistic:.2f}, {p}"


def compare(accuracy: Mapping[str, FloatArray]) -> Comparison:
    """Compare conditions that the same participants went through.

    Parameters
    ----------
    accuracy : mapping of (n,) float
        By condition, in the order of the participants.

    Raises
    ------
    InputError
        There are fewer than three participants or conditions, their numbers differ, or no condition differs from another in anyone.
    """
    names = list(accuracy)
    if len({len(each) for each in accuracy.values()}) > 1:
        raise InputError("not every condition has all participants; compare what the same participants did")
    table = np.column_stack([np.asarray(accuracy[name], dtype=float) for name in names]) if names else np.empty((0, 0))
    n, k = table.shape
    if n < 3 or k < 3:
        raise InputError(f"{n} participants in {k} conditions are too few to compare; three of both are the least")
    if (table == table[:, :1]).all():
        raise InputError("all conditions are alike in every participant, so there is nothing to compare")
    normality = _normality(table)
    return _anova(table, names, normality) if normality >= LEVEL else _friedman(table, names, normality)


def _normality(table: FloatArray) -> float:
    from scipy.stats import shapiro

    if (np.ptp(table, axis=0) == 0).any():
        return float("nan")
    return min(float(shapiro(column).pvalue) for column in table.T)


def _anova(table: FloatArray, names: list[str], normality: float) -> Comparison:
    from scipy.stats import ttest_rel

    with _deprecations_of_others():
        import pandas as pd
        import pingouin

        found = pingouin.rm_anova(pd.DataFrame(table, columns=names), correction=True).iloc[0]
    spherical = float(found.get("p_spher", np.nan))
    p = found["p_GG_corr"] if spherical < LEVEL else found["p_unc"]
    couples = list(itertools.combinations(range(len(names)), 2))
    pairs = []
    for i, j in couples:
        # Two conditions that are alike in everyone have no t; they do not differ.
        alike = (table[:, i] == table[:, j]).all()
        chance = 1.0 if alike else float(ttest_rel(table[:, i], table[:, j]).pvalue)
        pairs.append(Pair(names[i], names[j], min(len(couples) * chance, 1.0)))
    dof = (int(found["ddof1"]), int(found["ddof2"]))
    return Comparison("repeated-measures ANOVA", float(found["F"]), dof, float(p), normality, spherical, tuple(pairs))


def _friedman(table: FloatArray, names: list[str], normality: float) -> Comparison:
    from scipy.stats import friedmanchisquare

    with _deprecations_of_others():
        import scikit_posthocs

        p = scikit_posthocs.posthoc_nemenyi_friedman(table).to_numpy()
    found = friedmanchisquare(*table.T)
    pairs = tuple(Pair(names[i], names[j], float(p[i, j])) for i, j in itertools.combinations(range(len(names)), 2))
    return Comparison("Friedman", float(found.statistic), (len(names) - 1,), float(found.pvalue), normality, float("nan"), pairs)


@contextmanager
def _deprecations_of_others() -> Iterator[None]:
    """pingouin calls pandas in ways that pandas is going to drop: nothing that a user of ours could mend."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", category=DeprecationWarning)
        warnings.simplefilter("ignore", category=FutureWarning)
        yield
