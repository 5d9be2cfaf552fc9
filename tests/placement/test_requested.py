"""Placing what a file asks for, and its errors."""

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.material import load_material
from skinfab.placement.check import check_sensor
from skinfab.placement.requested import nearest_on_pieces, place_from_file

MATERIAL = load_material()
SPIRAL = 'kind = "contact-spiral"\nparams = { n = 3, x = 1.7, b = 1.5, l = 3, s = 15 }\n'


def run(tmp_path: Path, text: str, made: tuple) -> tuple:
    file = tmp_path / "sensors.toml"
    file.write_text(text)
    mesh, piece = made
    return place_from_file(file, mesh, [piece], material=MATERIAL)


def test_pose_point_auto_and_fill(tmp_path: Path, sheet: Callable) -> None:
    made = sheet(140, 100)
    text = f"""
[[sensor]]
{SPIRAL}pose = "auto"
[[sensor]]
{SPIRAL}channel = 7
pose = {{ piece = "P1", x = 20, y = 30, angle_deg = 90 }}
[[sensor]]
{SPIRAL}id = "thumb"
pose = {{ point = [70.0, 80.0, 3.0] }}
[auto]
kinds = ["contact-spiral"]
sizes = [22]
per_piece = 2
"""
    sensors, warnings = run(tmp_path, text, made)
    by_id = {s.id: s for s in sensors}
    assert not warnings and {s.channel for s in sensors} == {0, 1, 2, 3, 7}
    assert (by_id["C2"].x, by_id["C2"].y, by_id["C2"].channel) == (20, 30, 7) and by_id["C2"].angle == pytest.approx(np.pi / 2)
    thumb = by_id["thumb"]
    c, s = np.cos(thumb.angle), np.sin(thumb.angle)
    np.testing.assert_allclose(np.array([thumb.x, thumb.y]) + np.array([[c, -s], [s, c]]) @ thumb.pattern.middle, [70, 80], atol=1e-9)
    assert sum(x.pattern.s == 22 for x in sensors) == 2
    for x in sensors:
        assert check_sensor(made[1], x, sensors, material=MATERIAL) == []


def test_only_what_is_listed(tmp_path: Path, sheet: Callable) -> None:
    sensors, warnings = run(tmp_path, f'[[sensor]]\n{SPIRAL}pose = "auto"\n', sheet(140, 100))
    assert [s.id for s in sensors] == ["C1"] and not warnings


@pytest.mark.parametrize(
    ("pose", "error", "says"),
    [
        (
            '{ piece = "P1", x = 130, y = 30 }',
            RefusedError,
            r"sensor 1 .C1. of sensors.toml: C1 is \d+\.\d mm outside piece P1, which spans 0 to 140 x 0 to 100 mm; .* shrink it$",
        ),
        ("{ point = [1.0, 1.0, 0.0] }", RefusedError, r"C1 is .* outside piece P1"),
        ('{ piece = "P2", x = 1, y = 3 }', InputError, "sensor 1 .C1. of sensors.toml: no piece 'P2'; there are P1"),
    ],
)
def test_what_does_not_fit_is_named(tmp_path: Path, sheet: Callable, pose: str, error: type, says: str) -> None:
    with pytest.raises(error, match=says):
        run(tmp_path, f"[[sensor]]\n{SPIRAL}pose = {pose}\n", sheet(140, 100))


def test_no_room_anywhere(tmp_path: Path, sheet: Callable) -> None:
    with pytest.raises(
        RefusedError, match=r"sensor 1 \(C1\) of sensors.toml: it fits on no piece, whose largest free circle is 1\d\.\d mm"
    ):
        run(tmp_path, f'[[sensor]]\n{SPIRAL}pose = "auto"\n', sheet(60, 15))


def test_two_on_one_place(tmp_path: Path, sheet: Callable) -> None:
    same = f'[[sensor]]\n{SPIRAL}pose = {{ piece = "P1", x = 20, y = 30 }}\n'
    with pytest.raises(RefusedError, match="C2 overlaps C1"):
        run(tmp_path, same + same, sheet(140, 100))


def test_nearest_point_is_taken_through_the_flattening(sheet: Callable) -> None:
    mesh, piece = sheet(40, 40, scale=0.5)
    which, flat, away = nearest_on_pieces(mesh, [piece], np.array([10.0, 26.0, 9.0]))
    assert which == 0 and away == pytest.approx(9)
    np.testing.assert_allclose(flat, [5, 13], atol=1e-9)


def test_a_point_far_from_the_object_is_of_another_scale(tmp_path: Path, sheet: Callable) -> None:
    made = sheet(140, 100)
    limit = 0.05 * np.hypot(140, 100)

    def ask(z: float) -> str:
        return f"[[sensor]]\n{SPIRAL}pose = {{ point = [70.0, 50.0, {z}] }}\n"

    assert len(run(tmp_path, ask(z=limit - 0.01), made)[0]) == 1
    with pytest.raises(InputError, match=r"sensor 1 \(C1\) of sensors.toml: the point is 8\.61 mm from the object; coordinates are mm"):
        run(tmp_path, ask(z=limit + 0.01), made)
    with pytest.raises(InputError, match=r"the point is 860 mm from .* spans x 0 to 140, y 0 to 100, z 0 to 0$"):
        run(tmp_path, ask(z=860.0), made)


def test_too_large_a_spiral_is_told_the_largest_that_fits(tmp_path: Path, sheet: Callable) -> None:
    made = sheet(45, 40)

    def ask(s: float, n: int) -> str:
        return "[[sensor]]\n" + SPIRAL.replace("s = 15", f"s = {s}").replace("n = 3", f"n = {n}") + 'pose = "auto"\n'

    with pytest.raises(RefusedError) as refused:
        run(tmp_path, ask(90, 20), made)
    said = re.search(r"the largest that fits with this x and l is s = (\S+) with n = (\d+) and b = 1.5, on P1", str(refused.value))
    assert said and 30 < float(said[1]) < 42
    sensors, _ = run(tmp_path, ask(float(said[1]), int(said[2])), made)
    assert len(sensors) == 1
    with pytest.raises(RefusedError, match="fits on no piece"):
        run(tmp_path, ask(float(said[1]) + 1, int(said[2])), made)
    with pytest.raises(RefusedError, match=r"with x = 1.7, b = 1.5 and l = 3 no smaller s fits either$"):
        run(tmp_path, ask(15, 3), sheet(60, 8))
