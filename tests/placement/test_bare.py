"""Pieces without a sensor are named, with whether there is room for one."""

import re
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest

from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.auto import place
from skinfab.placement.bare import bare_pieces
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source

MATERIAL = load_material()


@pytest.fixture
def skin_of(sheet: Callable) -> Callable:
    def make(sides: Sequence[float], on: Sequence[str] = ()) -> Skin:
        """Squares of these sides, with a sensor on those named."""
        meshes, pieces, first = [], [], np.zeros(2, dtype=np.int64)
        for k, side in enumerate(sides):
            mesh, piece = sheet(side, side, step=side)
            meshes.append((mesh.V + np.array([0, 0, 10.0 * k]), mesh.F + first[0]))
            pieces.append(Piece(f"P{k + 1}", piece.faces + first[1], piece.vertices + first[0], piece.F, piece.UV))
            first += (len(mesh.V), len(mesh.F))
        V, F = (np.concatenate(each) for each in zip(*meshes, strict=True))
        spiral = make_pattern("contact-spiral", {"s": 10})
        sensors = tuple(Sensor(f"C{k + 1}", id, spiral, 15.0, 15.0, 0.0, k) for k, id in enumerate(on))
        return Skin(Mesh(V, F), Source("plates.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), tuple(pieces), sensors)

    return make


def test_nothing_is_said_where_every_piece_has_one(skin_of: Callable) -> None:
    assert bare_pieces(skin_of([30, 30], on=["P1", "P2"]), MATERIAL) == []


def test_of_a_small_piece_it_says_what_placing_says(skin_of: Callable) -> None:
    skin = skin_of([30, 8], on=["P1"])
    (said,) = bare_pieces(skin, MATERIAL)
    _, warnings = place(skin.object, skin.pieces, material=MATERIAL)
    assert [said] == warnings
    across, needed = map(float, re.findall(r"(\d+\.\d) mm", said.replace("smallest sensor (s = 10 mm)", "smallest sensor")))
    assert said.startswith("piece P2 has no sensor: ") and across == pytest.approx(8, abs=0.5) and needed > 10


@pytest.mark.parametrize(
    ("on", "said"),
    [
        (["P1", "P3"], "piece P2 has no sensor, though there seems to be room: place one there, or leave it as it is"),
        (["P2"], "pieces P1 and P3 have no sensor, though there seems to be room: place some there, or leave them as they are"),
    ],
)
def test_one_that_has_room_was_left_out(skin_of: Callable, on: list[str], said: str) -> None:
    assert bare_pieces(skin_of([30, 30, 30], on=on), MATERIAL) == [said]


def test_a_printer_that_needs_more_room_has_less(skin_of: Callable) -> None:
    skin = skin_of([24])
    assert "there seems to be room" in bare_pieces(skin, MATERIAL)[0]
    assert "largest inscribed circle" in bare_pieces(skin, replace(MATERIAL, margin=MATERIAL.margin + 3))[0]
