"""Contacts of unequal forces on a tactel array: what is taken for ripples of the strong one, and what is told."""

import math

import numpy as np
import pytest

from skinfab.fingertip.array import matched
from skinfab.fingertip.array.analyser import Analyser, Reading
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.matched import ArrayModel
from skinfab.fingertip.array.simulator import Skin
from skinfab.fingertip.array.tracking import Event
from skinfab.tolerances import MATCH_UNEXPLAINED, PEAK_OTHER

SEED = Geometry()
SKIN, MODEL = Skin(SEED), ArrayModel.nominal(SEED)
GAINS = 1 + 0.03 * np.random.default_rng(7).standard_normal(SEED.shape)


def read(frames: list[np.ndarray], *, rate: float = 15.0) -> tuple[list[Reading], list[Event]]:
    """As read with gains that are not known."""
    rng, analyser = np.random.default_rng(0), Analyser(MODEL, noise=2e-4)
    made = [analyser.frame(k / rate, Z * GAINS + 2e-4 * rng.standard_normal(SEED.shape)) for k, Z in enumerate(frames)]
    return made, [event for reading in made for event in reading.events]


def two(strong: float, light: float, *, axial_mm: float = 8.0) -> np.ndarray:
    return SKIN.pressed(strong, axial_mm=axial_mm, angle_rad=-0.8) + SKIN.pressed(light, axial_mm=18.0, angle_rad=1.6)


@pytest.mark.parametrize("strong", [1.0, 3.0])
def test_a_light_finger_beside_a_strong_one(strong: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Under a third of its reading the light one is taken for a ripple, and the frame for one that nothing explains."""
    for part in (0.2, 0.3, 1.0):
        (reading,), _ = read([two(strong, part * strong)])
        assert reading.state == "several" and [each.force_n for each in reading.contacts] == [
            pytest.approx(strong, rel=0.1),
            pytest.approx(part * strong, rel=0.1),
        ]
        light = min(reading.contacts, key=lambda each: abs(each.axial_mm - 18.0))
        assert math.hypot(light.axial_mm - 18.0, 12.7 * (light.angle_rad - 1.6)) < 1.0
    monkeypatch.setattr(matched, "SEVERAL_OTHER", PEAK_OTHER)
    assert read([two(strong, 0.2 * strong)])[0][0].state == "wide"


def test_what_a_strong_finger_does_meanwhile_is_told() -> None:
    """The light one comes, the strong one slips by 5 mm, the light one goes."""
    alone, slipped = two(2.0, 0.0), two(2.0, 0.6, axial_mm=13.0)
    frames = [alone] * 8 + [two(2.0, 0.6)] * 8 + [slipped] * 8 + [two(2.0, 0.0, axial_mm=13.0)] * 8 + [0 * alone] * 3
    _, events = read(frames)
    assert [(event.kind, event.number, round(15 * event.start)) for event in events] == [
        ("touch", 1, 0),
        ("touch", 2, 8),
        ("slip", 1, 15),
        ("lift", 2, 24),
        ("lift", 1, 32),
    ]
    assert math.hypot(events[2].along_mm - 5.0, events[2].around_mm) < 0.5


def test_a_wide_contact_is_no_few_points(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two strong points and light ones beside them make up a disc of 5 mm, were these not to lie apart."""
    disc = SKIN.plated(3.0, axial_mm=16.9, angle_rad=math.radians(35), size_mm=10.0)
    assert read([disc])[0][0].state == "wide"
    monkeypatch.setattr(matched, "SEVERAL_TACTELS", 0.0)
    assert read([disc])[0][0].state == "several"


def test_a_rod_beside_a_finger_is_no_three_points() -> None:
    """Points explain the frame too, and none of those that stand for the rod is a contact; three that do touch stay three."""
    rod = SKIN.lined(2.0, axial_mm=8.0, angle_rad=-1.0, line_rad=-0.6)
    Z = rod + SKIN.pressed(1.0, axial_mm=19.0, angle_rad=1.5)
    match = matched.Matcher(MODEL, noise=2e-4)
    points = match.several(Z)
    assert len(points) == 3 and float(((Z - match.predicted(points)) ** 2).sum()) < MATCH_UNEXPLAINED * float((Z**2).sum())
    (reading,), _ = read([Z])
    assert reading.state == "several" and [each.force_n for each in reading.contacts] == pytest.approx([2.0, 1.0], rel=0.06)
    assert [each.axial_mm for each in reading.contacts] == pytest.approx([8.0, 19.0], abs=0.5)
    assert reading.line is not None and reading.line.line_rad == pytest.approx(-0.6, abs=math.radians(5))
    three = SKIN.points([(1.5, 0, 0), (1.0, 0, 0), (0.7, 0, 0)], [(8.0, -1.0), (15.4, -1.0), (19.0, 1.5)])
    (reading,), _ = read([three])
    assert reading.line is None and len(reading.contacts) == 3


def test_a_finger_that_slips_beside_a_rod_is_told() -> None:
    rod = SKIN.lined(2.0, axial_mm=8.0, angle_rad=-1.0, line_rad=0.9)
    before, after = (SKIN.pressed(1.0, axial_mm=axial, angle_rad=1.5) for axial in (13.0, 19.0))
    _, events = read([rod] * 6 + [rod + before] * 8 + [rod + after] * 8 + [rod] * 6 + [0 * rod] * 3)
    assert [(event.kind, event.number) for event in events] == [("touch", 1), ("touch", 2), ("slip", 2), ("lift", 2), ("lift", 1)]
    assert math.hypot(events[2].along_mm - 6.0, events[2].around_mm) < 0.5
