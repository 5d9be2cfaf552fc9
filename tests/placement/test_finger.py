"""The strain sensor of a finger: along it, across its middle."""

from collections.abc import Callable

import numpy as np
import pytest

from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.auto import place
from skinfab.placement.check import check_sensor
from skinfab.placement.finger import is_finger, long_axis, strain_sizes

MATERIAL = load_material()


def tube(length: float, radius: float, *, turn: float = 0.0) -> tuple[Mesh, Piece]:
    """A tube opened along one line, its flat piece turned by `turn`."""
    across, along = np.meshgrid(np.linspace(0, 2 * np.pi, 41), np.linspace(0, length, 31))
    a, z = across.ravel(), along.ravel()
    k = (np.arange(30)[:, None] * 41 + np.arange(40)).ravel()
    F = np.concatenate([np.column_stack([k, k + 1, k + 42]), np.column_stack([k, k + 42, k + 41])])
    V = np.column_stack([z, radius * np.cos(a), radius * np.sin(a)])
    flat = np.column_stack([radius * a, z]) @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    return Mesh(V, F, "tube"), Piece("P1", np.arange(len(F)), np.arange(len(V)), F, flat - flat.min(axis=0))


def test_what_a_finger_is() -> None:
    assert is_finger(tube(90, 9)[0]) and is_finger(tube(40, 8)[0])
    assert not is_finger(tube(90, 30)[0])  # too thick
    assert not is_finger(tube(200, 9)[0]) and not is_finger(tube(25, 3)[0])
    axes, extents = long_axis(tube(90, 9)[0])
    np.testing.assert_allclose(np.abs(axes[0]), [1, 0, 0], atol=1e-9)
    np.testing.assert_allclose(extents, [90, 18, 18], atol=0.1)


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_it_runs_along_the_finger_and_spans_the_middle(turn: float) -> None:
    mesh, piece = tube(90, 9, turn=turn)
    sensors, _ = place(mesh, [piece], material=MATERIAL)
    strain, *contacts = sensors
    assert strain.id == "S1" and isinstance(strain.pattern, StrainLines) and strain.pattern.l1 == 60
    assert check_sensor(piece, strain, sensors, material=MATERIAL) == []
    axis = np.array([-np.sin(turn), np.cos(turn)])  # the tube's axis on the flat piece
    heading = np.array([np.cos(strain.angle), np.sin(strain.angle)])
    assert abs(heading @ axis) > np.cos(np.deg2rad(11))
    flat_middle = (piece.UV.min(axis=0) + piece.UV.max(axis=0)) / 2
    loops = strain.path.point_at(np.linspace(0, 1, 2001)) @ axis - flat_middle @ axis
    turns = np.abs(loops[np.abs(np.gradient(loops)) < 1e-3])
    assert loops.min() < 0 < loops.max() and turns.size
    middle = np.array([strain.x, strain.y]) + np.array([[heading[0], -heading[1]], [heading[1], heading[0]]]) @ strain.pattern.middle
    assert abs((middle - flat_middle) @ axis) <= 0.25 * strain.pattern.l2
    assert all(s.id.startswith("C") for s in contacts)


def test_a_short_finger_gets_a_smaller_one_and_a_thin_one_a_warning() -> None:
    mesh, piece = tube(45, 8)
    (strain, *_), _ = place(mesh, [piece], material=MATERIAL)
    assert isinstance(strain.pattern, StrainLines) and strain.pattern.l1 < 45
    sensors, warnings = place(*_one(tube(40, 0.9)), material=MATERIAL)
    assert not sensors and any("looks like a finger, but there is no strain sensor" in w for w in warnings)


def test_sizes_fall_and_begin_with_the_papers() -> None:
    lengths = [p.l1 for p in strain_sizes(MATERIAL)]
    assert lengths[:2] == [60, 53] and lengths == sorted(lengths, reverse=True) and len(lengths) == 8


def _one(made: tuple[Mesh, Piece]) -> tuple[Mesh, list[Piece]]:
    return made[0], [made[1]]


def test_nothing_is_placed_without_a_piece(sheet: Callable) -> None:
    mesh, _ = sheet(90, 20)
    sensors, warnings = place(mesh, [], material=MATERIAL)
    assert sensors == () and len(warnings) == 1
