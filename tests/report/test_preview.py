"""The pictures show what they say: colours where they belong, nothing cut off, the same bytes every time."""

import dataclasses
import io
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from skinfab.flatten.distortion import Distortion
from skinfab.material import load_material
from skinfab.progress import PHASES
from skinfab.report.build import build_report
from skinfab.report.labels import dense
from skinfab.report.object_view import SEAM_COLOUR, SENSOR_COLOUR, View, object_picture, on_object, piece_colour, sensor_points
from skinfab.report.preview import _draw_sheet, _figure, draw_preview, shown_pieces
from skinfab.skin import Skin, Source

TIMING = {**dict.fromkeys(PHASES, 0.5), "total": 3.5}


def preview(skin: Skin, distortions: list[Distortion], folder: Path) -> np.ndarray:
    report = build_report(skin, distortions, material=load_material(), timing_s=TIMING, peak_rss_mb=200.0)
    draw_preview(skin, distortions, report, folder / "preview.png")
    return imread(io.BytesIO((folder / "preview.png").read_bytes()))[..., :3]


@pytest.fixture
def drawn_small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where it is enough that it can be drawn."""
    monkeypatch.setattr("skinfab.report.preview._DPI", 40)


def near(image: np.ndarray, colour: tuple[float, ...] | np.ndarray, tolerance: float = 0.02) -> np.ndarray:
    return (np.abs(image - np.asarray(colour)) < tolerance).all(axis=-1)


def test_everything_is_in_the_picture_and_nothing_cut_off(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    image = preview(skin, distortions, tmp_path)
    assert near(image, piece_colour(0)).sum() > 10_000
    assert near(image, SENSOR_COLOUR).sum() > 1_000
    assert near(image, SEAM_COLOUR).sum() > 100
    edge = np.concatenate([image[:3].reshape(-1, 3), image[-3:].reshape(-1, 3), image[:, :3].reshape(-1, 3), image[:, -3:].reshape(-1, 3)])
    assert (edge == 1).all()


def test_the_same_skin_gives_the_same_bytes(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    preview(skin, distortions, tmp_path)
    first = (tmp_path / "preview.png").read_bytes()
    preview(skin, distortions, tmp_path)
    assert (tmp_path / "preview.png").read_bytes() == first


@pytest.mark.parametrize(("d", "colour"), [(4.0, (0.267, 0.005, 0.329)), (4.1, (0.128, 0.567, 0.551)), (7.0, (0.993, 0.906, 0.144))])
def test_heat_map_keeps_its_scale(d: float, colour: tuple[float, ...], skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    one = dataclasses.replace(distortions[0], d=np.full(len(skin.mesh.F), d))
    right_half = preview(skin, [one], tmp_path)[700:, 1000:]
    assert near(right_half, colour).mean() > 0.05  # the ends and the middle of viridis over 4.0 to 4.2


@pytest.mark.parametrize("file", ["$x_{1}$.obj", "指.obj", "a<b>&\\.obj", "x" * 200 + ".obj"])
@pytest.mark.usefixtures("drawn_small")
def test_strange_names_are_drawn_as_text(file: str, skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    preview(dataclasses.replace(skin, source=Source(file, "ab" * 32, "mm", 1.0)), distortions, tmp_path)


@pytest.mark.usefixtures("drawn_small")
def test_many_pieces_and_no_sensors(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    many = tuple(dataclasses.replace(skin.pieces[0], id=f"P{k}") for k in range(14))
    preview(dataclasses.replace(skin, pieces=many, sensors=()), distortions * 14, tmp_path)


def test_of_very_many_pieces_those_that_matter_are_shown_and_named(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    small = [dataclasses.replace(skin.pieces[0], id=f"P{k + 2}", UV=skin.pieces[0].UV * (0.05 + 0.01 * (k % 17))) for k in range(105)]
    # The one with sensors is the smallest of them.
    many = dataclasses.replace(skin, pieces=(*small, dataclasses.replace(skin.pieces[0], UV=skin.pieces[0].UV / 30)))
    shown = shown_pieces(many)
    assert len(shown) == 20 and shown[-1] == 105 and shown == sorted(shown)
    areas = [piece.area for piece in many.pieces]
    assert min(areas[k] for k in shown[:-1]) >= sorted(areas)[-20]
    axes = _figure(6.0, 5.0).add_subplot()
    _draw_sheet(axes, dataclasses.replace(many, sensors=()), shown[:-1])
    named = [text.get_text().split()[0] for text in axes.texts if text.get_text().startswith("P")]
    assert sorted(named) == sorted(many.pieces[k].id for k in shown[:-1])
    assert axes.get_title(loc="left") == "19 of 106 pieces, those with sensors and the largest; flat.pdf has all"
    # Names stand by their pieces: hardly any needs a line to it.
    assert sum(line.get_linewidth() == 0.6 for line in axes.lines) <= 3
    preview(dataclasses.replace(many, sensors=()), distortions * 106, tmp_path)


def test_front_and_back_of_a_box(skin: Skin) -> None:
    # From straight in front (-y) only the wall y = 0 is seen: the seam at its left edge, the first 60 mm of the strip.
    skin = dataclasses.replace(skin, sensors=skin.sensors[1:])
    lines = sensor_points(skin, spacing=0.2)
    picture = object_picture(skin, View(azimuth=-90.0, elevation=0.0), lines, width=132, height=112)
    drawn = ~near(picture.image, (1, 1, 1))
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    assert np.ptp(rows) + 1 == pytest.approx(100, abs=2) and np.ptp(columns) + 1 == pytest.approx(120, abs=2)  # 50 x 60 mm
    red = near(picture.image, SEAM_COLOUR, 0.25)
    assert red.any() and np.flatnonzero(red.any(axis=0)).max() < columns.min() + 6
    assert near(picture.image, SENSOR_COLOUR, 0.3).sum() > 50  # C1 is on this wall
    assert (picture.piece[20:90, 20:110] == 0).all() and picture.piece[0, 0] == -1
    assert picture.drawn[red].all() and not picture.drawn[0].any()
    # C1's name stands on it: where its path lies on the wall, at two pixels a mm.
    ((k, (column, row)),) = picture.sensors.items()
    box = skin.sensors[0].path.bbox
    assert k == 0 and (box[0] < ((column - 6) / 2, (106 - row) / 2)).all() and (((column - 6) / 2, (106 - row) / 2) < box[1]).all()
    # From behind, none of it, though an open wall shows its inside.
    behind = object_picture(skin, View(azimuth=90.0, elevation=0.0), lines, width=132, height=112)
    assert not near(behind.image, SEAM_COLOUR, 0.25).any() and not near(behind.image, SENSOR_COLOUR, 0.3).any()
    assert behind.sensors == {}


@pytest.mark.parametrize("azimuth", [0.0, 40.0, -75.0])
def test_a_sensor_on_the_inner_side_has_no_name(azimuth: float, skin: Skin) -> None:
    # Seen from above through the open top, the far wall shows its inside, on which no sensor faces the eye.
    lines = sensor_points(skin, spacing=0.2)
    for elevation in (60.0, -60.0):
        view = View(azimuth, elevation)
        seen = object_picture(skin, view, lines, width=200, height=160).sensors
        for k in seen:
            towards = lines.normal[lines.sensor == k] @ view.axes()[2]
            assert (towards < 0).mean() >= 0.3


def test_opposite_views_show_every_side_of_an_object(skin: Skin) -> None:
    one, other = View(-60.0, 22.0).axes(), View(120.0, -22.0).axes()
    np.testing.assert_allclose(one[2], -other[2], atol=1e-12)


def test_points_of_the_flat_piece_find_their_place_on_the_object(skin: Skin) -> None:
    flat = np.array([[30.0, 10.0], [90.0, 20.0], [1000.0, 0.0], [150.0, 30.0]])
    at, face, on = on_object(skin, skin.pieces[0], flat)
    np.testing.assert_allclose(at, [[30, 0, 10], [60, 30, 20], [30, 60, 30]], atol=1e-9)
    assert on.tolist() == [True, True, False, True]
    np.testing.assert_allclose(skin.mesh.face_normals[face], [[0, -1, 0], [1, 0, 0], [0, 1, 0]], atol=1e-9)


def test_the_scale_bar_is_as_long_as_it_says(skin: Skin) -> None:
    figure = _figure(6.0, 5.0)
    axes = figure.add_subplot()
    _draw_sheet(axes, skin, shown_pieces(skin))
    (text,) = [t.get_text() for t in axes.texts if t.get_text().endswith(" mm")]
    bars = [np.asarray(line.get_xdata(), dtype=float) for line in axes.lines if line.get_linewidth() == 2.0]
    assert [np.ptp(bar) for bar in bars] == [pytest.approx(float(text.removesuffix(" mm")))]
    assert axes.get_aspect() == 1 and not len(axes.get_xticks()) and not len(axes.get_yticks())


def test_labels_of_the_sheet_cover_neither_lines_nor_each_other(skin: Skin) -> None:
    figure = _figure(6.0, 5.0)
    axes = figure.add_subplot()
    _draw_sheet(axes, skin, shown_pieces(skin))
    figure.canvas.draw()
    boxes = [text.get_window_extent() for text in axes.texts]
    assert {text.get_text() for text in axes.texts} >= {"S1", "C1", "P1  240 x 50"}
    for k, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[:k])
        for sensor in skin.sensors:
            line = axes.transData.transform(sensor.printed_path.to_polyline(tolerance=0.02))
            assert not box.count_contains(dense(line))
        assert not box.count_contains(dense(axes.transData.transform(skin.pieces[0].outline), closed=True))
