"""The ablation leaves out what it says, and judges on other images than it learns from."""

from skinfab.bench.optical_ablation import WHOLE, measure_terms, terms


def test_a_fingertip_without_noise_is_read_better() -> None:
    names = (WHOLE, "no noise of tips")
    whole, still = measure_terms(names=names, images=120)
    assert (whole.without, still.without) == names and whole.simulated
    assert 0 < still.offset_mm < whole.offset_mm < 1


def test_each_term_is_another_fingertip() -> None:
    known = {(tip.errors, tip.dome.drape_mm, shear) for tip, shear in terms().values()}
    assert len(known) == len(terms())
