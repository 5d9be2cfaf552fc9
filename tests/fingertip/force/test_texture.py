"""Peaks against sines of known frequency, sliding against where it is known to be, and the paper's tables on simulated materials."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.force.logs import WrenchLog
from skinfab.fingertip.force.simulator import MATERIALS, SlideScene, slide
from skinfab.fingertip.force.texture import (
    BAND_NAMES,
    PUBLISHED_NAMES,
    Slide,
    band_features,
    interpolated_peaks,
    published_features,
    published_peaks,
    sliding_part,
)

TIME = np.arange(512) / 200


@pytest.mark.parametrize("frequency", [3.1, 4.97, 7.42])
def test_interpolated_peaks_beat_the_grid(frequency: float) -> None:
    signal = 0.03 * np.sin(2 * np.pi * frequency * TIME + 1)
    ours, theirs = (find(signal, 200.0, count=1) for find in (interpolated_peaks, published_peaks))
    assert abs(ours.frequency[0] - frequency) < 0.01 and ours.magnitude[0] == pytest.approx(
        0.015, rel=0.02
    )  # a parabola is not quite the window's shape
    assert theirs.frequency[0] * 512 / 200 == pytest.approx(round(theirs.frequency[0] * 512 / 200))  # on the paper's 0.39 Hz steps
    assert abs(theirs.frequency[0] - frequency) > abs(ours.frequency[0] - frequency)


def test_three_peaks_come_in_the_order_of_their_frequencies() -> None:
    signal = 0.02 * np.sin(2 * np.pi * 7 * TIME) + 0.05 * np.sin(2 * np.pi * 3 * TIME) + 0.01 * np.sin(2 * np.pi * 5 * TIME)
    assert interpolated_peaks(signal, 200.0).frequency == pytest.approx([3, 5, 7], abs=0.02)
    # Above 10 Hz nothing is looked at, however strong it is.
    assert interpolated_peaks(signal + np.sin(2 * np.pi * 20 * TIME), 200.0).frequency == pytest.approx([3, 5, 7], abs=0.02)


def test_the_load_falls_out_of_the_bands_and_not_out_of_the_published_magnitudes() -> None:
    plain = sliding_part(slide(MATERIALS["cardboard 10 mm"], seed=2))
    doubled = replace(plain, tangential=2 * plain.tangential, normal=2 * plain.normal, noise_n=2 * plain.noise_n)
    assert band_features(doubled) == pytest.approx(band_features(plain))
    assert published_features(doubled)[3:6] == pytest.approx(2 * published_features(plain)[3:6])
    assert len(band_features(plain)) == len(BAND_NAMES) and len(published_features(plain)) == len(PUBLISHED_NAMES)


def test_the_part_that_slides_is_found_and_the_offset_taken_off() -> None:
    scene = SlideScene(offset_n=0.1)
    part = sliding_part(slide(MATERIALS["towel"], seed=5, scene=scene))
    assert len(part.normal) / 200 == pytest.approx(scene.slide_s, abs=0.8)
    assert part.normal.mean() == pytest.approx(1.0, abs=0.01)
    assert part.ratio.mean() == pytest.approx(MATERIALS["towel"].friction, abs=0.02)
    assert not part.notes


def test_a_log_that_begins_under_load_says_that_its_offset_is_not_known() -> None:
    log = slide(MATERIALS["towel"], seed=5)
    late = WrenchLog(log.name, log.time[150:], log.force[150:], log.moment[150:])
    assert "offset is not known" in sliding_part(late).notes[0]


def test_the_papers_peaks_come_out() -> None:
    # 35 mm/s over 10 and 5 mm: 3.5 and 7.0 Hz. The paper prints 3.52 (the same bin) and 7.42, which is the next bin but one.
    exact = SlideScene(speed_scatter=0.0)
    for name, true, printed in (("cardboard 10 mm", 3.5, 3.52), ("cardboard 5 mm", 7.0, 7.42)):
        parts = [sliding_part(slide(MATERIALS[name], seed=k, scene=exact)) for k in range(7)]
        theirs, ours = (
            [find(part.tangential, 200.0, count=1).frequency[0] for part in parts] for find in (published_peaks, interpolated_peaks)
        )
        assert np.abs(np.array(theirs) - printed).max() < 0.4
        assert abs(np.median(ours) - true) < 0.02 < abs(np.median(theirs) - true) + 0.01


def test_a_corrugation_between_two_steps_is_told_by_interpolation_alone() -> None:
    between = replace(MATERIALS["cardboard 5 mm"], pitch_mm=35.0 / 7.22)  # 18.5 steps of 0.39 Hz
    exact = SlideScene(speed_scatter=0.0)
    part = sliding_part(slide(between, seed=3, scene=exact))
    theirs, ours = (find(part.tangential, 200.0, count=1).frequency[0] for find in (published_peaks, interpolated_peaks))
    assert abs(theirs - 7.22) > 0.15 and abs(ours - 7.22) < 0.05


@pytest.mark.parametrize(
    ("name", "average", "least", "most"),
    [
        ("towel", 12.93, 10.29, 14.43),
        ("paper towel", 11.64, 10.53, 12.69),
        ("painter's tape", 8.79, 7.68, 10.21),
        ("copy paper", 6.86, 6.04, 8.40),
    ],
)
def test_the_papers_inclinations_come_out(name: str, average: float, least: float, most: float) -> None:
    seen = np.median([published_features(sliding_part(slide(MATERIALS[name], seed=k)))[6:] for k in range(9)], axis=0)
    assert seen[2] == pytest.approx(average, abs=0.4)
    assert seen[1] == pytest.approx(least, abs=1.0) and seen[0] == pytest.approx(most, abs=1.0)


def flat(n: int = 600, *, load: float = 1.0, rate: float = 200.0) -> WrenchLog:
    force = np.tile([0.0, 0.0, -load], (n, 1))
    return WrenchLog("a.csv", np.arange(n) / rate, force, np.cross([0, 0, 20.0], force))


@pytest.mark.parametrize(
    ("log", "says"),
    [
        (flat(60), "60 samples"),
        (flat(load=0.01), "nothing presses"),
        (flat(rate=20.0), "20 samples a second"),
        (flat(), "there is no tangential force"),
    ],
)
def test_what_is_no_slide_is_refused(log: WrenchLog, says: str) -> None:
    with pytest.raises(InputError, match=says):
        sliding_part(log)


def test_a_spectrum_longer_than_the_slide_is_refused() -> None:
    short = Slide(np.ones(400), np.ones(400), np.ones(400), 200.0)
    with pytest.raises(InputError, match="slide for longer"):
        published_features(short)
    assert np.isfinite(band_features(short)).all()  # bands take what there is


def test_moments_in_n_m_are_refused_unless_the_log_says_so() -> None:
    log = slide(MATERIALS["towel"], seed=5)
    with pytest.raises(InputError, match="the moments are in N m"):
        sliding_part(replace(log, moment=log.moment / 1000))
    assert sliding_part(replace(log, units_said=True)).rate_hz == pytest.approx(200)
