"""Sensors stay on their spot of the object when pieces change."""

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest
from shapes import grid

from skinfab.flatten.mapping import FlatMap
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.carry import carry, put_back
from skinfab.placement.check import check_sensor
from skinfab.placement.edit import middle_of
from skinfab.placement.lifted import Lifted
from skinfab.placement.sensor import Sensor
from skinfab.seams.cut import open_pieces
from skinfab.seams.edit import path_edges

MATERIAL = load_material("carbon-grease-ecoflex")
SPIRAL = make_pattern("contact-spiral", {"n": 3, "x": 1.7, "b": 1.5, "l": 3, "s": 25})


def sheet() -> Mesh:
    """A flat square of 120 mm, standing in space; vertex (i, j) has number 13 j + i."""
    V, F = grid(12, 12)
    return Mesh(120 * V[:, [0, 2, 1]], F)


def flat_pieces(mesh: Mesh, column: int | None = None, *, turn: float = 0.0, ids: str = "PQ") -> list[Piece]:
    """The sheet in one piece, or parted at a column, each turned and moved somewhere."""
    cut = mesh.topology.is_boundary.copy()
    if column is not None:
        cut[path_edges(mesh, [13 * j + column for j in range(13)])] = True
    c, s = np.cos(turn), np.sin(turn)
    pieces = []
    for k, part in enumerate(open_pieces(mesh, cut)):
        UV = mesh.V[part.vertices][:, [0, 2]] @ np.array([[c, s], [-s, c]])
        pieces.append(Piece(f"{ids[k]}1", part.faces, part.vertices, part.F, UV - UV.min(axis=0)))
    return pieces


def sensor_at(x: float, y: float, angle: float = 0.3, id: str = "C1") -> Sensor:
    """Middle of the pattern at (x, y) of the sheet in one piece."""
    sensor = Sensor(id, "P1", SPIRAL, 0.0, 0.0, angle, 0)
    dx, dy = np.array([x, y]) - middle_of(sensor)
    return dataclasses.replace(sensor, x=float(dx), y=float(dy))


def sensor_at_of(piece: Piece, x: float) -> Sensor:
    """Middle of the pattern at (x, 60) of a piece of the parted sheet."""
    return dataclasses.replace(sensor_at(x, 60), piece=piece.id)


def bisect(holds: Callable[[float], bool], low: float, high: float) -> float:
    """The least x at which something holds from there on."""
    while high - low > 1e-7:
        middle = (low + high) / 2
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high


def on_object(mesh: Mesh, piece: Piece, sensor: Sensor) -> np.ndarray:
    return FlatMap(mesh, piece).to_object(sensor.printed_path.point_at(np.linspace(0, 1, 50))).xyz


@pytest.mark.parametrize("turn", [0.0, 1.0, np.pi, -2.5])
def test_a_sensor_lies_where_it_lay_on_the_object(turn: float) -> None:
    mesh = sheet()
    before, after = flat_pieces(mesh), flat_pieces(mesh, 4, turn=turn)
    sensor = sensor_at(80, 50)
    carried = carry(mesh, [sensor], before, after, material=MATERIAL)
    (new,) = carried.sensors
    assert new.piece == "Q1" and carried.remarks == () and carried.lost == ()
    np.testing.assert_allclose(on_object(mesh, after[1], new), on_object(mesh, before[0], sensor), atol=1e-9)
    assert (new.angle - sensor.angle - turn + 1e-9) % (2 * np.pi) < 1e-6


def test_sensors_on_pieces_that_stayed_are_not_touched() -> None:
    mesh = sheet()
    before = flat_pieces(mesh, 4)
    after = [before[0], *flat_pieces(mesh, 4, turn=0.5)[1:]]
    on_first = dataclasses.replace(sensor_at(20, 50), id="C2")
    on_second = dataclasses.replace(sensor_at(40, 50), piece="Q1")
    carried = carry(mesh, [on_second, on_first], before, after)
    assert carried.sensors[1] is on_first
    assert carried.sensors[0] is not on_second and carried.sensors[0].id == "C1"


def test_a_cut_through_a_sensor_is_said_and_the_sensor_kept() -> None:
    mesh = sheet()
    carried = carry(mesh, [sensor_at(45, 50)], flat_pieces(mesh), flat_pieces(mesh, 4), material=MATERIAL)
    assert [s.id for s in carried.sensors] == ["C1"] and carried.sensors[0].piece == "Q1"
    assert len(carried.remarks) == 1
    assert "outside piece Q1" in carried.remarks[0] and carried.remarks[0].endswith("move, turn or shrink it")
    assert carry(mesh, [sensor_at(45, 50)], flat_pieces(mesh), flat_pieces(mesh, 4)).remarks == ()


def test_a_spot_that_is_gone_is_said() -> None:
    mesh = sheet()
    sensor, other = sensor_at(20, 50), sensor_at(80, 50, id="C2")
    carried = carry(mesh, [sensor, other], flat_pieces(mesh), flat_pieces(mesh, 4)[1:])
    assert carried.lost == (sensor,) and [s.id for s in carried.sensors] == ["C2"]
    assert carried.remarks == (
        "C1 was taken off: its spot on the object is on no flat piece any more; cut so that it is, or place it anew",
    )
    nothing = carry(mesh, [sensor, other], flat_pieces(mesh), [])
    assert nothing.lost == (sensor, other) and len(nothing.remarks) == 2 and nothing.sensors == ()


def test_a_sensor_of_an_unknown_piece_is_lost_in_words() -> None:
    mesh = sheet()
    sensor = dataclasses.replace(sensor_at(20, 50), piece="P9")
    carried = carry(mesh, [sensor], flat_pieces(mesh), flat_pieces(mesh))
    assert carried.lost == (sensor,) and "C1 was taken off" in carried.remarks[0]


def test_a_sensor_half_beside_its_piece_follows_the_half_that_has_a_spot() -> None:
    mesh = sheet()
    before, after = flat_pieces(mesh), flat_pieces(mesh, turn=0.7)
    sensor = sensor_at(-2, 60)
    (new,) = carry(mesh, [sensor], before, after).sensors
    old_spots, new_spots = on_object(mesh, before[0], sensor), on_object(mesh, after[0], new)
    there = np.isfinite(old_spots).all(axis=1)
    assert 0 < there.sum() < 50
    np.testing.assert_allclose(new_spots[there], old_spots[there], atol=1e-9)
    far = carry(mesh, [sensor_at(-200, 60)], before, after)
    assert not far.sensors and len(far.lost) == 1


def test_two_that_come_too_close_are_told_of_once() -> None:
    mesh = sheet()
    both = [sensor_at(80, 50), sensor_at(90, 50, id="C2")]
    remarks = carry(mesh, both, flat_pieces(mesh), flat_pieces(mesh, turn=0.2), material=MATERIAL).remarks
    assert len(remarks) == 1 and remarks[0].startswith("C2 overlaps C1")


def test_a_lifted_sensor_comes_back_to_its_spot() -> None:
    mesh = sheet()
    before, after = flat_pieces(mesh), flat_pieces(mesh, 4, turn=1.0)
    sensor = sensor_at(80, 50)
    put = put_back(mesh, [Lifted(sensor, before[0])], [], after, material=MATERIAL)
    (new,) = put.back
    assert put.sensors == (new,) and put.still == ()
    piece = next(p for p in after if p.id == new.piece)
    np.testing.assert_allclose(on_object(mesh, piece, new), on_object(mesh, before[0], sensor), atol=1e-6)


def test_returned_sensors_stand_where_they_stood_in_the_list() -> None:
    mesh = sheet()
    before, after = flat_pieces(mesh), flat_pieces(mesh, 4, turn=1.0)
    off = [Lifted(sensor_at(80, 50, id="C1"), before[0], place=0), Lifted(sensor_at(80, 50, id="C2"), before[0], place=2)]
    there = [dataclasses.replace(sensor_at(20, 50), id=id, channel=channel) for id, channel in (("A", 7), ("B", 5))]
    put = put_back(mesh, [dataclasses.replace(off[1], sensor=dataclasses.replace(off[1].sensor, channel=3)), off[0]], there, after)
    assert [s.id for s in put.sensors] == ["C1", "A", "C2", "B"] and [s.id for s in put.back] == ["C1", "C2"]


def test_a_lifted_sensor_stays_off_where_it_has_no_spot_or_does_not_fit() -> None:
    mesh = sheet()
    before, after = flat_pieces(mesh), flat_pieces(mesh, 4)
    lifted = Lifted(sensor_at(80, 50), before[0])

    def why(*there: Sensor, pieces: list[Piece] = after) -> str:
        put = put_back(mesh, [lifted], there, pieces, material=MATERIAL)
        assert put.back == () and put.sensors == there
        (still,) = put.still
        assert still.sensor is lifted.sensor and still.piece is lifted.piece
        return still.why

    assert why(pieces=[]) == "" == why(pieces=[p for p in after if p.UV[:, 0].max() < 60])
    (own,) = put_back(mesh, [lifted], [], after).back
    other = dataclasses.replace(own, id="C9", channel=9)
    assert why(other) == "overlaps C9"
    assert why(dataclasses.replace(other, id="c1")) == "another sensor is named C1"
    assert why(dataclasses.replace(other, channel=0)) == "C9 has its channel 0"
    assert put_back(mesh, [lifted], [other], after).back == (own,), "without a material only names and channels are asked"


@pytest.mark.parametrize(("lack", "fits"), [(0.004, True), (0.09, True), (0.5, False)])
def test_what_is_too_close_by_a_hair_is_moved_on_and_by_more_is_told(lack: float, fits: bool) -> None:
    """Pieces that are flattened anew differ by some hundredths: a sensor at the margin would no longer be printable."""
    mesh = sheet()
    before, after = flat_pieces(mesh), flat_pieces(mesh, 4)
    # Where the cut at 40 mm leaves just the margin, less what is lacking.
    fault = check_sensor(after[1], sensor_at_of(after[1], 10.0), (), material=MATERIAL)
    assert fault
    least = bisect(lambda x: not check_sensor(after[1], sensor_at_of(after[1], x), (), material=MATERIAL), 10.0, 30.0)
    sensor = sensor_at(40 + least - lack, 60)
    carried = carry(mesh, [sensor], before, after, material=MATERIAL)
    (new,) = carried.sensors
    assert (carried.remarks == ()) is fits
    away = abs(middle_of(new)[0] - (least - lack))
    assert lack < away < 2.5 * lack + 1e-6 if fits else away < 1e-9
    lifted = put_back(mesh, [Lifted(sensor, before[0])], (), after, material=MATERIAL)
    assert bool(lifted.back) is fits
