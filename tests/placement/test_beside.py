"""Copies lie where they fit, near their originals; where they do not, that is said."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.material import load_material
from skinfab.patterns.registry import make_pattern
from skinfab.placement.beside import copy_beside
from skinfab.placement.check import validate
from skinfab.placement.edit import middle_of
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source

MATERIAL = load_material()
SPIRAL = make_pattern("contact-spiral", {"s": 15})


def of(pair: tuple, *sensors: Sensor) -> Skin:
    mesh, piece = pair
    return Skin(mesh, Source("sheet.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), (piece,), sensors)


def spiral(id: str, x: float, y: float, channel: int, angle: float = 0.0) -> Sensor:
    middle = middle_of(Sensor(id, "P1", SPIRAL, 0.0, 0.0, angle, channel))
    return Sensor(id, "P1", SPIRAL, float(x - middle[0]), float(y - middle[1]), angle, channel)


def test_a_copy_lies_in_line_with_its_original_and_close(sheet: Callable) -> None:
    skin = of(sheet(120, 60), spiral("C1", 30, 30, 0))
    sensors, new = copy_beside(skin, ["C1"], material=MATERIAL)
    validate(replace(skin, sensors=sensors), MATERIAL)
    (dx, dy) = middle_of(sensors[1]) - middle_of(sensors[0])
    assert new == ("C2",) and sensors[0] is skin.sensors[0] and sensors[1].channel == 1 and sensors[1].angle == 0.0
    assert min(abs(dx), abs(dy)) < 1e-9 and 12 < max(abs(dx), abs(dy)) < 24


def test_one_copy_after_the_other_until_the_piece_is_full(sheet: Callable) -> None:
    skin = of(sheet(80, 50), spiral("C1", 15, 15, 0))
    refusal = ""
    while not refusal:
        try:
            skin = replace(skin, sensors=copy_beside(skin, ["C1"], material=MATERIAL)[0])
        except RefusedError as refused:
            refusal = str(refused)
        validate(skin, MATERIAL)
    assert 6 <= len(skin.sensors) <= 12, "80 x 50 mm, of which each takes 15 x 18"
    assert refusal == "there is no room on P1 for a copy of C1; make it smaller first, or add a sensor to another piece"


def test_copies_of_several_lie_as_the_originals_do(sheet: Callable) -> None:
    skin = of(sheet(150, 100), spiral("C1", 20, 20, 0), spiral("C2", 45, 30, 1, angle=0.7))
    sensors, new = copy_beside(skin, ["C2", "C1"], material=MATERIAL)
    validate(replace(skin, sensors=sensors), MATERIAL)
    by_id = {s.id: s for s in sensors}
    ways = [middle_of(by_id[n]) - middle_of(by_id[o]) for n, o in zip(new, ("C2", "C1"), strict=True)]
    assert ways[0] == pytest.approx(ways[1]) and [by_id[n].angle for n in new] == [0.7, 0.0]


def test_where_it_does_not_fit_as_it_lies_it_is_turned(sheet: Callable) -> None:
    lines = make_pattern("strain-lines", {"l1": 40, "l2": 30, "b": 6})
    # An L: the original lies along one arm, and only the other has room.
    skin = of(sheet(60, 80, without=lambda c: (c[:, 0] > 20) & (c[:, 1] > 20)), Sensor("S1", "P1", lines, 8.0, 7.0, 0.0, 0))
    validate(skin, MATERIAL)
    sensors, _ = copy_beside(skin, ["S1"], material=MATERIAL)
    validate(replace(skin, sensors=sensors), MATERIAL)
    assert abs(np.sin(sensors[1].angle)) > 0.9


def test_one_that_is_not_there_is_named(sheet: Callable) -> None:
    with pytest.raises(InputError, match="there is no sensor C9"):
        copy_beside(of(sheet(60, 60), spiral("C1", 30, 30, 0)), ["C9"], material=MATERIAL)
