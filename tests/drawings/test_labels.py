"""Words cover no ink and no other word, and stand beside what they name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
import shapely

from skinfab.cli.main import main
from skinfab.document import load_skin
from skinfab.drawings.labels import CROSS_MM, Label, origin_cross, piece_labels
from skinfab.drawings.seam_sides import SeamSide, seam_sides
from skinfab.pieces import Piece
from skinfab.skin import Skin
from skinfab.wire_exits import wire_pads


def plate(w: float, h: float) -> Piece:
    UV = np.array([[0, 0], [w, 0], [w, h], [0, h]], dtype=float)
    return Piece("P1", np.arange(2), np.arange(4), np.array([[0, 1, 2], [0, 2, 3]]), UV)


def side(label: str, a: tuple[float, float], b: tuple[float, float]) -> SeamSide:
    """A straight seam of a plate, its notch in the middle."""
    along = np.subtract(b, a) / np.hypot(*np.subtract(b, a))
    return SeamSide(label, "seam", 0, np.array([a, b], dtype=float), np.add(a, b) / 2, np.array([-along[1], along[0]]))


def test_every_word_of_the_cube_is_free(skin: Skin) -> None:
    sides = seam_sides(skin.pieces)
    for k, piece in enumerate(skin.pieces):
        sensors = skin.sensors_on(piece.id)
        labels = piece_labels(piece, [s for s in sides if s.piece == k], sensors)
        assert not any(a.box.intersects(b.box) for a, b in combinations(labels, 2))
        for sensor in sensors:
            ink = shapely.LineString(sensor.printed_path.to_polyline(tolerance=0.01))
            (own,) = (label for label in labels if label.text == sensor.id)
            assert own.box.distance(ink) > sensor.pattern.bead / 2
            assert shapely.Polygon(piece.outline).contains(own.box)
            # Behind the pads rather than over the pattern, and near them.
            pads = wire_pads([sensor])
            away = own.at - np.mean([pad.at for pad in pads], axis=0)
            assert away @ pads[0].away > 0 and np.hypot(*away) < 12


def test_a_seam_shorter_than_its_number_has_none() -> None:
    piece = plate(40, 30)
    texts = {label.text for label in piece_labels(piece, [side("7", (0, 0), (1.5, 0)), side("8", (1.5, 0), (40, 0))], [])}
    assert "8" in texts and "7" not in texts


def test_numbers_do_not_heap() -> None:
    # Notches 4 mm apart in a row: two digits are 3.9 mm wide, so all have room.
    runs = [side(str(10 + k), (4.0 * k, 0), (4.0 * k + 4, 0)) for k in range(8)]
    numbers = [label for label in piece_labels(plate(40, 30), runs, []) if label.kind == "seam"]
    assert len(numbers) == 8 and not any(a.box.intersects(b.box) for a, b in combinations(numbers, 2))
    tight = [side(str(10 + k), (20 - 2.0, 5 + 0.5 * k), (20 + 2.0, 5 + 0.5 * k)) for k in range(8)]
    numbers = [label for label in piece_labels(plate(40, 30), tight, []) if label.kind == "seam"]
    assert 0 < len(numbers) < 8 and not any(a.box.intersects(b.box) for a, b in combinations(numbers, 2))


def test_a_number_steps_outside_where_ink_is_inside(skin: Skin) -> None:
    sensor = replace(skin.sensors[1], piece="P1", x=8.0, y=1.2, angle=0.0)
    seam = side("1", (0, 0), (60, 0))
    (plain,) = (label for label in piece_labels(plate(60, 30), [seam], []) if label.kind == "seam")
    (number,) = (label for label in piece_labels(plate(60, 30), [seam], [sensor]) if label.kind == "seam")
    assert plain.at[1] > 0 > number.at[1]


def test_a_number_moves_along_its_seam_where_ink_is_at_the_notch(skin: Skin) -> None:
    sensor = replace(skin.sensors[1], piece="P1", x=8.0, y=1.2, angle=0.0)
    reach = sensor.printed_path.bbox[1][0]
    seam = replace(side("1", (0, 0), (60, 0)), notch=np.array([reach + 1.0, 0.0]))
    (number,) = (label for label in piece_labels(plate(60, 30), [seam], [sensor]) if label.kind == "seam")
    ink = shapely.LineString(sensor.printed_path.to_polyline(tolerance=0.01))
    # Still inside, a little further on, rather than outside.
    assert 0 < number.at[1] < 5 and 0 < number.at[0] - seam.notch[0] < 4
    assert number.box.distance(ink) > sensor.pattern.bead / 2 and not number.over_ink


def test_a_number_that_has_to_lie_on_ink_gets_white_behind_it(skin: Skin) -> None:
    sensor = replace(skin.sensors[1], piece="P1", x=-2.0, y=6.0, angle=0.0)
    # The flank of a dart that is too narrow for a number, along nothing but a sensor.
    narrow = Piece("P1", np.arange(2), np.arange(4), np.array([[0, 1, 2], [0, 2, 3]]), np.array([[8.0, 0], [12, 0], [12, 30], [8, 30]]))
    seam = side("1", (10, 4), (10, 8))
    (number,) = (label for label in piece_labels(narrow, [seam], [sensor]) if label.kind == "seam")
    ink = shapely.LineString(sensor.printed_path.to_polyline(tolerance=0.01))
    assert number.box.distance(ink) < sensor.pattern.bead / 2 + 0.4 and number.over_ink


@pytest.mark.parametrize(("name", "least", "most"), [("cup", 25, 1), ("robot_finger", 4, 0)])
def test_numbers_of_a_whole_skin_keep_off_its_conductors(
    name: str, least: int, most: int, cut_once: Callable[[str, Path], Path], tmp_path: Path
) -> None:
    document = cut_once(name, tmp_path / "a.skin")
    assert main(["place", str(document)]) == 0
    whole = load_skin(document)
    sides, numbers, over = seam_sides(whole.pieces), 0, 0
    for k, piece in enumerate(whole.pieces):
        sensors = whole.sensors_on(piece.id)
        ink = shapely.MultiLineString([s.printed_path.to_polyline(tolerance=0.01) for s in sensors])
        labels = [label for label in piece_labels(piece, [s for s in sides if s.piece == k], sensors) if label.kind == "seam"]
        numbers += len(labels)
        for label in labels if sensors else ():
            assert label.over_ink or label.box.distance(ink) > max(s.pattern.bead for s in sensors) / 2
            over += label.over_ink
    # On the cup a dart runs so close along a sensor that neither side of it has room.
    assert numbers >= least and over <= most


@pytest.mark.parametrize(("w", "texts"), [(40.0, ["P1", "40.0 x 9.0 mm"]), (11.9, ["P1", "11.9 x 9.0"]), (4.0, ["P1"])])
def test_name_and_size_stay_clear_of_the_next_piece(w: float, texts: list[str]) -> None:
    labels = piece_labels(plate(w, 9.0), [], [])
    assert [label.text for label in labels] == texts
    for label in labels:
        x0, y0, x1, y1 = label.box.bounds
        assert x0 >= 0 and y1 <= -CROSS_MM and y0 >= -6 and x1 <= w + 10


def test_cross_and_box() -> None:
    np.testing.assert_allclose(origin_cross().reshape(-1, 2).mean(axis=0), 0)
    assert Label("size", "abcd", np.array([1.0, 2.0]), 2.0, left=True).box.bounds == pytest.approx((1, 1, 1 + 4 * 0.65 * 2, 3))
