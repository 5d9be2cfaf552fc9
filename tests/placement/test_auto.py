"""Automatic placement on small pieces: what it places fits exactly, and the same again with the same seed."""

import dataclasses
import re
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.placement import fill
from skinfab.placement.auto import SEED_SIZES, AutoOptions, place, spiral_of_size
from skinfab.placement.check import validate
from skinfab.placement.distance import Curves, distance
from skinfab.placement.space import crease_lines

MATERIAL = load_material()


def sizes(sensors: tuple) -> list[float]:
    return [s.pattern.s for s in sensors if isinstance(s.pattern, ContactSpiral)]


@pytest.mark.parametrize(("side", "s"), [(22.0, 15.0), (30.0, 22.0)])
def test_a_cube_gets_one_spiral_on_each_face(cube_net: Callable, side: float, s: float) -> None:
    mesh, piece = cube_net(side)
    assert mesh.topology.euler == 2 and mesh.area == pytest.approx(6 * side**2) and piece.topology.euler == 1
    sensors, warnings = place(mesh, [piece], material=MATERIAL)
    validate(SimpleNamespace(pieces=(piece,), sensors=sensors), MATERIAL)
    assert sizes(sensors) == [s] * 6 and not warnings
    faces = {tuple(np.floor(x.path.transformed(angle=0, shift=(0, 0)).bbox.mean(axis=0) / side)) for x in sensors}
    assert len(faces) == 6
    creases = Curves.of_edges(crease_lines(mesh, piece))
    assert len(creases) == 5
    assert min(distance(Curves.of_segments(x.printed_path.segments), creases) for x in sensors) >= MATERIAL.ink.bead_width / 2
    assert [x.channel for x in sensors] == list(range(6)) and [x.id for x in sensors] == [f"C{k}" for k in range(1, 7)]


@pytest.mark.parametrize("number", [1, 2, 5, 6])
def test_fewer_than_there_are_faces_are_placed_where_asked_for(cube_net: Callable, number: int) -> None:
    mesh, piece = cube_net(30.0)
    options = AutoOptions(kinds=("contact-spiral",), sizes=(15,), per_piece=number)
    sensors, warnings = place(mesh, [piece], material=MATERIAL, options=options)
    validate(SimpleNamespace(pieces=(piece,), sensors=sensors), MATERIAL)
    assert sizes(sensors) == [15] * number and not warnings
    assert len({tuple(np.floor(x.path.bbox.mean(axis=0) / 30.0)) for x in sensors}) == number  # one a face


def test_a_face_without_room_leaves_its_sensor_to_another(sheet: Callable) -> None:
    # Two squares and a strip between them, folded up along both: the strip is the largest face, and a little too narrow.
    h = 9.5
    mesh, piece = sheet(24 * h, 4 * h, step=h, without=lambda c: (abs(c[:, 0] - 12 * h) < 8 * h) & (c[:, 1] > 2 * h))
    V = mesh.V.copy()
    V[:, 2] = np.maximum(np.abs(V[:, 0] - 12 * h) - 8 * h, 0)
    folded = Mesh(V, mesh.F)
    assert len(crease_lines(folded, piece)) == 4
    sensors, warnings = place(folded, [piece], material=MATERIAL, options=AutoOptions(("contact-spiral",), (20,), per_piece=2))
    assert sizes(sensors) == [20, 20] and not warnings
    left, right = sorted(s.path.bbox.mean(axis=0)[0] for s in sensors)
    assert left < 4 * h and right > 20 * h


def test_a_rectangle_is_packed_with_the_largest_first(sheet: Callable) -> None:
    mesh, piece = sheet(60, 100)
    sensors, warnings = place(mesh, [piece], material=MATERIAL, options=AutoOptions(kinds=("contact-spiral",)))
    validate(SimpleNamespace(pieces=(piece,), sensors=sensors), MATERIAL)
    assert sizes(sensors)[:2] == [45, 45] and 2 <= len(sensors) <= 4 and not warnings
    again, _ = place(mesh, [piece], material=MATERIAL, options=AutoOptions(kinds=("contact-spiral",)))
    assert again == sensors


def test_a_tight_fit_is_found_off_the_raster(sheet: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    # The square in which s = 20 just fits, along the diagonal: the raster alone asks for 0.4 mm more.
    mesh, piece = sheet(26.5, 26.5, step=26.5)
    with_nudging, _ = place(mesh, [piece], material=MATERIAL)
    assert sizes(with_nudging) == [20]
    validate(SimpleNamespace(pieces=(piece,), sensors=with_nudging), MATERIAL)
    monkeypatch.setattr(fill, "nudged_fit", lambda *_, **__: None)
    without, _ = place(mesh, [piece], material=MATERIAL)
    assert sizes(without) == [15]


def test_sensors_spread_over_a_piece_with_room_to_spare(sheet: Callable) -> None:
    mesh, piece = sheet(300, 80, step=10)
    sensors, _ = place(mesh, [piece], material=MATERIAL)
    assert sizes(sensors) == [45] * 6  # 240 cm^2
    along = np.sort([s.path.bbox.mean(axis=0)[0] for s in sensors])
    assert along[0] < 100 and along[-1] > 200  # packed from one end they would all lie on 4 x 60 mm or less


def test_options_narrow_it_down(sheet: Callable) -> None:
    mesh, piece = sheet(60, 100)
    options = AutoOptions(kinds=("contact-spiral",), sizes=(15, 20), per_piece=3)
    sensors, _ = place(mesh, [piece], material=MATERIAL, options=options)
    assert sizes(sensors) == [20, 20, 20]
    for bad, says in (({"kinds": ("spiral",)}, "no kind 'spiral'"), ({"sizes": ()}, "sizes"), ({"per_piece": 0}, "per_piece is 0")):
        with pytest.raises(InputError, match=says):
            AutoOptions(**bad)


def test_creases_are_ignored_where_nothing_fits_between_them(sheet: Callable) -> None:
    mesh, piece = sheet(40, 40, step=10)
    V = mesh.V.copy()
    V[:, 2] = 10 * (np.round(V[:, 0] / 10) % 2)  # folded every 10 mm
    folded = Mesh(V, mesh.F)
    assert len(crease_lines(folded, piece)) == 12
    sensors, warnings = place(folded, [piece], material=MATERIAL)
    assert sizes(sensors) and not warnings


def test_noise_is_no_crease(sheet: Callable) -> None:
    mesh, piece = sheet(40, 40, step=2)
    V = mesh.V.copy()
    V[len(V) // 2, 2] = 2.0  # one spike: six sharp edges in a star, 14 mm of them, and around
    assert len(crease_lines(Mesh(V, mesh.F), piece)) > 0
    V[len(V) // 2, 2] = 1.0
    assert len(crease_lines(Mesh(V, mesh.F), piece)) == 0


def test_too_small_a_piece_is_named_with_what_would_fit(sheet: Callable) -> None:
    mesh, piece = sheet(60, 8, step=2)
    sensors, warnings = place(mesh, [piece], material=MATERIAL, options=AutoOptions(kinds=("contact-spiral",)))
    assert sensors == ()
    (text,) = warnings
    said = re.fullmatch(
        r"piece P1 has no sensor: its largest inscribed circle is (\S+) mm across, "
        r"and the smallest sensor \(s = 10 mm\) needs (\S+) mm",
        text,
    )
    assert said and float(said[1]) == pytest.approx(8, abs=0.5) and 15 < float(said[2]) < 25


def test_more_sensors_than_channels_is_said(sheet: Callable) -> None:
    mesh, one = sheet(40, 40)
    pieces = [dataclasses.replace(one, id=f"P{k}") for k in range(33)]
    sensors, warnings = place(mesh, pieces, material=MATERIAL, options=AutoOptions(kinds=("contact-spiral",), sizes=(20,), per_piece=1))
    assert len(sensors) == 33 and len(warnings) == 1 and "33 sensors need more than the 32 channels" in warnings[0]


def test_small_pieces_share_one_warning(sheet: Callable) -> None:
    mesh, first = sheet(60, 8, step=2)
    second = dataclasses.replace(first, id="P2", UV=first.UV * [1, 9 / 8])
    third = dataclasses.replace(first, id="P3")
    _, (text,) = place(mesh, [first, second, third], material=MATERIAL, options=AutoOptions(kinds=("contact-spiral",)))
    said = re.fullmatch(
        r"pieces P1, P2 and P3 have no sensor: their largest inscribed circles are (\S+) to (\S+) mm across, "
        r"and the smallest sensor \(s = 10 mm\) needs \S+ mm",
        text,
    )
    assert said and float(said[1]) == pytest.approx(8, abs=0.5) and float(said[2]) == pytest.approx(9, abs=0.5)
    assert place(mesh, [first, second, third], material=MATERIAL, options=AutoOptions(kinds=("contact-spiral",)))[1] == [text]


def test_a_large_piece_is_filled(sheet: Callable) -> None:
    mesh, piece = sheet(240, 200, step=20)
    sensors, warnings = place(mesh, [piece], material=MATERIAL)
    validate(SimpleNamespace(pieces=(piece,), sensors=sensors), MATERIAL)
    assert sizes(sensors) == [45] * 12 and not warnings  # 480 cm^2
    middles = np.array([s.path.bbox.mean(axis=0) for s in sensors])
    for quarter in ((0, 0), (0, 1), (1, 0), (1, 1)):
        assert (np.floor(middles / [120, 100]) == quarter).all(axis=1).sum() >= 2
    assert place(mesh, [piece], material=MATERIAL) == (sensors, warnings)


def test_sensors_reach_into_an_arm(sheet: Callable) -> None:
    # A broad part with room for all four and a narrow arm: by room alone, the arm stays empty.
    mesh, piece = sheet(320, 160, step=20, without=lambda c: (c[:, 0] > 160) & (c[:, 1] > 60))
    options = AutoOptions(kinds=("contact-spiral",), sizes=(32,), per_piece=4)
    sensors, warnings = place(mesh, [piece], material=MATERIAL, options=options)
    middles = np.array([s.path.bbox.mean(axis=0) for s in sensors])
    assert len(sensors) == 4 and not warnings
    assert middles[:, 0].max() > 260 and (middles[:, 0] < 160).sum() >= 2


def test_no_more_than_the_channels_without_being_asked(sheet: Callable) -> None:
    mesh, piece = sheet(500, 400, step=50)
    sensors, warnings = place(mesh, [piece], material=MATERIAL)
    assert len(sensors) == 32 and not warnings
    small_mesh, one = sheet(30, 30)
    pieces = [dataclasses.replace(one, id=f"P{k}") for k in range(1, 35)]
    sensors, warnings = place(small_mesh, pieces, material=MATERIAL)
    assert len(sensors) == 32 == len({s.piece for s in sensors})
    (text,) = warnings
    assert text.startswith("pieces P33 and P34 have no sensor: all 32 channels") and "per_piece" in text


def test_fewer_than_asked_for_is_said(sheet: Callable) -> None:
    mesh, piece = sheet(60, 100)
    options = AutoOptions(kinds=("contact-spiral",), sizes=(38,), per_piece=9)
    sensors, warnings = place(mesh, [piece], material=MATERIAL, options=options)
    assert 0 < len(sensors) < 9
    assert warnings == [f"fewer contact sensors fit than the 9 that per_piece asks for: {len(sensors)} on P1"]
    # Sizes that are asked for are placed beside one another however small.
    small, warnings = place(mesh, [piece], material=MATERIAL, options=AutoOptions(kinds=("contact-spiral",), sizes=(10,), per_piece=3))
    assert sizes(small) == [10] * 3 and not warnings


@pytest.mark.parametrize("s", SEED_SIZES)
def test_spirals_of_the_papers_sizes_exist(s: float) -> None:
    p = spiral_of_size(s, MATERIAL)
    assert p.s == s and 1.7 <= p.x <= 3.2 and 1.5 <= p.b <= 8 and 3 <= p.l <= 8


def test_whatever_is_placed_on_pieces_with_holes_is_valid(sheet: Callable) -> None:
    # Two ways of judging: places are found on a raster and by moves, verdicts come from exact distances.
    rng, placed = np.random.default_rng(7), 0
    for _ in range(12):
        width, height = rng.integers(20, 90, size=2)
        middle, radius = rng.uniform((5, 5), (width - 5, height - 5)), rng.uniform(1, 8)
        mesh, piece = sheet(
            width,
            height,
            step=2.5,
            without=lambda c, middle=middle, radius=radius: np.hypot(*(c - middle).T) < radius,
            scale=rng.uniform(0.9, 1.1),
        )
        if len(piece.topology.boundary_loops) > 2:
            continue  # the hole parts the piece
        material = dataclasses.replace(MATERIAL, margin=float(rng.choice([0.0, 0.5, 2.0])))
        sensors, _ = place(mesh, [piece], material=material, seed=3, options=AutoOptions(per_piece=int(rng.integers(1, 9))))
        validate(SimpleNamespace(pieces=(piece,), sensors=sensors), material)
        placed += len(sensors)
    assert placed > 20
