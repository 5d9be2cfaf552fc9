"""The fit on simulated strips whose truth is known: it is found, its intervals hold it as often as they say, and where
nothing can be told it says so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import optimize

from skinfab.electrical import resistance
from skinfab.errors import RefusedError
from skinfab.material import load_material
from skinfab.strip_fit import fit_strips, fitted_material, require_plausible
from skinfab.strip_table import Strips

RHO = 63.0
LENGTHS = (40.0, 160.0, 640.0)


def simulated(*, area: float, sigma: float, contact: float, copies: int, rng: np.random.Generator) -> Strips:
    length = np.repeat(LENGTHS, copies)
    median = 0.01 * RHO * length / area + 2 * contact
    return Strips(length, median * np.exp(sigma * rng.normal(size=len(length))))


def test_many_strips_give_the_truth() -> None:
    strips = simulated(area=0.4, sigma=0.3, contact=7.0, copies=4000, rng=np.random.default_rng(3))
    fit = fit_strips(strips, resistivity_ohm_cm=RHO)
    assert fit.effective_area_mm2.value == pytest.approx(0.4, rel=0.01)
    assert fit.contact_resistance_kohm.value == pytest.approx(7.0, rel=0.05)
    assert fit.log_sigma.value == pytest.approx(0.3, rel=0.02)
    assert (fit.n, fit.lengths) == (12_000, 3) and fit.misfit_p > 0.001


def test_the_least_squares_are_those_of_a_general_solver() -> None:
    strips = simulated(area=0.5, sigma=0.2, contact=15.0, copies=4, rng=np.random.default_rng(8))

    def rest(ln: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.log(strips.r_kohm) - np.log(np.exp(ln[0]) * strips.length_mm + 2 * np.exp(ln[1]))

    solved = optimize.least_squares(rest, [0.0, 1.0])
    fit = fit_strips(strips, resistivity_ohm_cm=RHO)
    assert fit.effective_area_mm2.value == pytest.approx(0.01 * RHO / np.exp(solved.x[0]), rel=1e-3)
    assert fit.contact_resistance_kohm.value == pytest.approx(np.exp(solved.x[1]), rel=5e-3)
    assert fit.log_sigma.value == pytest.approx(np.sqrt(2 * solved.cost / 10), rel=1e-4)
    errors = np.sqrt(np.diag(np.linalg.inv(solved.jac.T @ solved.jac) * 2 * solved.cost / 10))
    assert fit.effective_area_mm2.se / fit.effective_area_mm2.value == pytest.approx(errors[0], rel=0.01)
    assert fit.contact_resistance_kohm.se / fit.contact_resistance_kohm.value == pytest.approx(errors[1], rel=0.01)


@pytest.mark.parametrize(("sigma", "contact", "copies"), [(0.1, 5.0, 3), (0.3, 40.0, 4), (0.7, 5.0, 4)])
def test_intervals_hold_the_truth_as_often_as_they_say(sigma: float, contact: float, copies: int) -> None:
    rng, tries = np.random.default_rng(11), 400
    held, spread, errors, refused = np.zeros(3), [], [], 0
    for _ in range(tries):
        strips = simulated(area=0.4, sigma=sigma, contact=contact, copies=copies, rng=rng)
        try:
            fit = fit_strips(strips, resistivity_ohm_cm=RHO)
        except RefusedError:
            refused += 1
            continue
        got = (fit.effective_area_mm2, fit.log_sigma, fit.contact_resistance_kohm)
        held += [e.low <= true <= e.high for e, true in zip(got, (0.4, sigma, contact), strict=True)]
        spread.append(np.log(got[0].value))
        errors.append(got[0].se / got[0].value)
    assert refused <= 0.02 * tries
    # 95 % of 400 is 380, give or take 4.4: three of those either way, and a contact near zero is held more often.
    share = held / (tries - refused)
    assert (share > 0.917).all() and (share[:2] < 0.983).all(), share
    # The standard error is how far the estimates scatter; they scatter less where the contact is often held at zero.
    assert np.std(spread) < 1.15 * np.mean(errors)
    assert sigma > 0.5 or np.std(spread) > 0.85 * np.mean(errors)


def test_no_contact_resistance_at_all_is_told() -> None:
    strips = simulated(area=0.4, sigma=0.2, contact=0.0, copies=8, rng=np.random.default_rng(5))
    contact = fit_strips(strips, resistivity_ohm_cm=RHO).contact_resistance_kohm
    assert contact.low == 0.0 and contact.value <= contact.high < 6


@pytest.mark.parametrize(
    ("length", "says"),
    [
        ([100.0] * 12, "12 strips of 1 length cannot tell"),
        ([40.0, 40.1, 160.0, 160.1, 40.2, 160.2], "6 strips of 2 lengths cannot tell"),
        ([40.0, 160.0, 640.0, 40.0, 160.0], "5 strips of 3 lengths cannot tell"),
        ([], "0 strips of 0 lengths"),
    ],
)
def test_too_few_are_refused(length: list[float], says: str) -> None:
    r = np.arange(1.0, len(length) + 1)
    with pytest.raises(RefusedError, match=says):
        fit_strips(Strips(np.array(length), r), resistivity_ohm_cm=RHO)


def test_a_scatter_that_hides_the_growth_is_refused() -> None:
    length = np.repeat([100.0, 110.0, 120.0], 3)
    r = np.array([80.0, 300, 150, 200, 90, 310, 120, 260, 160])
    with pytest.raises(RefusedError, match="do not tell for sure that resistance grows with length"):
        fit_strips(Strips(length, r), resistivity_ohm_cm=RHO)
    # The longer the lower: the same.
    rng = np.random.default_rng(2)
    falling = Strips(np.repeat(LENGTHS, 4), 1000 / np.repeat(LENGTHS, 4) * np.exp(0.1 * rng.normal(size=12)))
    with pytest.raises(RefusedError, match="grows with length"):
        fit_strips(falling, resistivity_ohm_cm=RHO)


def test_numbers_from_the_model_itself_are_refused() -> None:
    length = np.repeat(LENGTHS, 3)
    with pytest.raises(RefusedError, match="tell nothing of the scatter"):
        fit_strips(Strips(length, length), resistivity_ohm_cm=RHO)


def test_strips_that_break_the_law_are_noticed() -> None:
    strips = simulated(area=0.4, sigma=0.05, contact=5.0, copies=5, rng=np.random.default_rng(9))
    bridged = np.where(strips.length_mm == 160, strips.r_kohm * 2.5, strips.r_kohm)
    assert fit_strips(strips, resistivity_ohm_cm=RHO).misfit_p > 0.01
    assert fit_strips(Strips(strips.length_mm, bridged), resistivity_ohm_cm=RHO).misfit_p < 1e-4


def test_the_fitted_material_predicts_the_strips() -> None:
    strips = simulated(area=0.3, sigma=0.2, contact=9.0, copies=200, rng=np.random.default_rng(1))
    material = load_material()
    fitted = fitted_material(material, fit_strips(strips, resistivity_ohm_cm=RHO))
    assert fitted.ink.bead_area_mm2 == material.ink.bead_area_mm2  # what is extruded stays
    for length in LENGTHS:
        r = resistance(length, fitted.ink)
        assert r.median == pytest.approx(0.63 * length / 0.3 + 18, rel=0.05)
        inside = (strips.r_kohm[strips.length_mm == length] >= r.low) & (strips.r_kohm[strips.length_mm == length] <= r.high)
        assert inside.mean() == pytest.approx(0.9, abs=0.06)


def spoiled(k: int, factor: float, *, seed: int = 9, sigma: float = 0.2) -> Strips:
    strips = simulated(area=0.4, sigma=sigma, contact=5.0, copies=4, rng=np.random.default_rng(seed))
    r = strips.r_kohm.copy()
    r[k] *= factor
    return Strips(strips.length_mm, r, names=tuple(f"L{length:g} (line {j + 2})" for j, length in enumerate(strips.length_mm)))


@pytest.mark.parametrize("k", range(12))
@pytest.mark.parametrize("factor", [8.0, 1 / 8])
def test_a_strip_that_does_not_belong_is_named(k: int, factor: float) -> None:
    strips = spoiled(k, factor)
    outlier = fit_strips(strips, resistivity_ohm_cm=RHO).outlier
    assert outlier is not None and outlier.name == strips.names[k] and outlier.r_kohm == strips.r_kohm[k]
    # What the others lead one to expect: the truth, give or take their scatter.
    assert outlier.expected_kohm == pytest.approx(0.63 * strips.length_mm[k] / 0.4 + 10, rel=0.5)
    times = outlier.r_kohm / outlier.expected_kohm
    assert str(outlier).startswith(strips.names[k]) and f"{max(times, 1 / times):.3g}" in str(outlier)


def test_a_strip_in_ohm_among_others_is_named_where_nothing_else_can_be_told() -> None:
    with pytest.raises(RefusedError, match=r"grows with length; L40 \(line 3\) has .* kohm, .* times what the other strips"):
        fit_strips(spoiled(1, 1000.0), resistivity_ohm_cm=RHO)


def test_scatter_alone_is_seldom_called_an_outlier() -> None:
    rng, called = np.random.default_rng(21), 0
    for _ in range(400):
        strips = simulated(area=0.4, sigma=0.3, contact=5.0, copies=4, rng=rng)
        called += fit_strips(strips, resistivity_ohm_cm=RHO).outlier is not None
    assert called <= 11  # one in a hundred is 4, give or take 2


@pytest.mark.parametrize(("factor", "says"), [(1000.0, "are these ohm"), (0.001, "are these megaohm")])
def test_another_unit_is_refused(factor: float, says: str) -> None:
    strips = simulated(area=0.4, sigma=0.2, contact=5.0, copies=4, rng=np.random.default_rng(3))
    ink = load_material().ink
    require_plausible(fit_strips(strips, resistivity_ohm_cm=RHO), ink)
    with pytest.raises(RefusedError, match=f"the bead's own 0.484 mm\\^2: r_kohm must be in kilo-ohm and length_mm in mm; {says}"):
        require_plausible(fit_strips(replace(strips, r_kohm=strips.r_kohm * factor), resistivity_ohm_cm=RHO), ink)


@pytest.mark.parametrize(("times", "fits"), [(29.0, True), (31.0, False)])
def test_thirty_times_the_bead_is_the_bound(times: float, fits: bool) -> None:
    ink = load_material().ink
    fit = fit_strips(simulated(area=0.4, sigma=0.2, contact=5.0, copies=4, rng=np.random.default_rng(3)), resistivity_ohm_cm=RHO)
    for area in (ink.bead_area_mm2 * times, ink.bead_area_mm2 / times):
        moved = replace(fit, effective_area_mm2=replace(fit.effective_area_mm2, value=area))
        if fits:
            require_plausible(moved, ink)
        else:
            with pytest.raises(RefusedError, match="31 times"):
                require_plausible(moved, ink)
