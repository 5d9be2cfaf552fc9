"""Automatic seams: the seven objects within the study's own distortion, the same result every time."""

import numpy as np
import pytest
import shapes

from skinfab.errors import RefusedError
from skinfab.mesh.decimate import decimate
from skinfab.mesh.model import Mesh
from skinfab.seams import auto
from skinfab.seams.auto import Seams, find_seams
from skinfab.seams.cut import open_pieces, seam_length
from skinfab.seams.judge import Limits
from skinfab.tolerances import OVERLAP_FRACTION

#: Mean d of "Soft Sensing Skins for Arbitrary Objects", section IV, which cut by hand; and the pieces we may take.
STUDY = {
    "cube": (4.0, 1),
    "dodecahedron": (4.0, 1),
    "cylinder": (4.0002, 3),
    "cup": (4.039, 2),
    "grip": (4.037, 2),
    "human_finger": (4.042, 1),
    "robot_finger": (4.005, 2),
}


@pytest.mark.parametrize("name", STUDY)
def test_seven_objects_at_the_studys_distortion(name: str) -> None:
    """The grip with a quarter of its triangles: all of them are cut as well in tests/cli/test_make.py."""
    d, most = STUDY[name]
    mesh = shapes.object_mesh(name)
    if name == "grip":
        few = decimate(mesh.V, mesh.F, faces=len(mesh.F) // 4)
        mesh = Mesh(few.V, few.F)
    seams = find_seams(mesh, Limits(mean=d + 1e-9))
    areas = [mesh.face_areas[piece.faces].sum() for piece, _ in seams.pieces]
    assert sum(areas) == pytest.approx(mesh.area)
    assert np.average([v.distortion.mean for _, v in seams.pieces], weights=areas) <= d + 1e-9
    assert len(seams.pieces) <= most
    for (piece, verdict), area, again in zip(seams.pieces, areas, open_pieces(mesh, seams.cut), strict=True):
        assert piece.is_disk and verdict.distortion.flipped == 0
        assert verdict.distortion.overlap_mm2 <= OVERLAP_FRACTION * area
        np.testing.assert_array_equal(piece.F, again.F)


def test_exact_nets_of_polyhedra() -> None:
    """Seam over root of area at d = 4: 7 of 12 edges of a cube, 19 of 30 of a dodecahedron."""
    cube, dodecahedron = shapes.object_mesh("cube"), shapes.object_mesh("dodecahedron")
    assert seam_length(cube, find_seams(cube, Limits()).cut) == pytest.approx(7 * 40, rel=1e-9)
    edge = np.sqrt(dodecahedron.area / (3 * np.sqrt(25 + 10 * np.sqrt(5))))
    assert seam_length(dodecahedron, find_seams(dodecahedron, Limits()).cut) == pytest.approx(19 * edge, rel=1e-6)


@pytest.mark.parametrize("name", ["dodecahedron", "human_finger"])
def test_the_same_every_time(name: str) -> None:
    one, two = (find_seams(shapes.object_mesh(name), Limits()) for _ in range(2))
    np.testing.assert_array_equal(one.cut, two.cut)
    for (_, a), (_, b) in zip(one.pieces, two.pieces, strict=True):
        np.testing.assert_array_equal(a.UV, b.UV)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
def test_unit_changes_nothing(unit: float) -> None:
    V, F = shapes.sphere(3)
    V = V * (1 + 0.1 * np.random.default_rng(0).random(len(V)))[:, None]  # no two ways equally long
    here, there = find_seams(Mesh(V, F), Limits(), neck=0.1), find_seams(Mesh(unit * V, F), Limits(), neck=0.1 * unit)
    np.testing.assert_array_equal(here.cut, there.cut)


def test_components_are_kept_apart() -> None:
    V, F = shapes.sphere(2)
    W, G = shapes.torus()
    seams = find_seams(Mesh(np.vstack([V, W + 9]), np.vstack([F, G + len(V)])), Limits(), neck=0.1)
    assert all((piece.faces < len(F)).all() or (piece.faces >= len(F)).all() for piece, _ in seams.pieces)
    assert all(v.accepted for _, v in seams.pieces)


def test_a_large_strip_is_cut_to_the_bed() -> None:
    V, F = shapes.grid(60, 3, lambda s, t: np.stack([600 * s, 30 * t, 0 * s], axis=1))
    seams = find_seams(Mesh(V, F), Limits(size=(200, 150)))
    assert len(seams.pieces) >= 4
    for _, verdict in seams.pieces:
        assert verdict.UV.max() <= 200


def test_more_room_for_d_gives_less_seam() -> None:
    """With a price of d that did not know the bound, the cup's six regions between creases beat its one piece at 4.1 and 4.2."""
    cup = shapes.object_mesh("cup")
    few = decimate(cup.V, cup.F, faces=1500)
    mesh = Mesh(few.V, few.F)
    found = [find_seams(mesh, Limits(mean=bound)) for bound in (4.05, 4.1, 4.2)]
    assert [len(seams.pieces) for seams in found] == [1, 1, 1]
    lengths = [seam_length(mesh, seams.cut) for seams in found]
    assert lengths[0] > lengths[1] > lengths[2]


@pytest.mark.parametrize(
    ("gives", "bound", "asked", "pieces"),
    [
        ({4.2: 3, 4.05: 2, 4.1: 4}, 4.2, [4.2, 4.05, 4.1], 2),
        ({4.2: 3, 4.05: 0, 4.1: 2}, 4.2, [4.2, 4.05, 4.1], 2),  # 0: refused
        ({4.2: 1, 4.05: 1, 4.1: 1}, 4.2, [4.2], 1),
        ({4.1: 3, 4.05: 3}, 4.1, [4.1, 4.05], 3),
        ({4.05: 3}, 4.05, [4.05], 3),
    ],
)
def test_pieces_of_a_tighter_bound_are_pieces_of_a_looser(monkeypatch, gives, bound: float, asked: list[float], pieces: int) -> None:
    mesh = shapes.object_mesh("cube")
    seen: list[float] = []
    told: list[float] = []

    def fake(mesh, limits, neck, rules, report) -> Seams:
        seen.append(limits.mean)
        report(0.5)
        report(1.0)
        if not gives[limits.mean]:
            raise RefusedError("no")
        return Seams(np.zeros(0, dtype=bool), [None] * gives[limits.mean])  # type: ignore[list-item]

    monkeypatch.setattr(auto, "_usual", fake)
    assert len(find_seams(mesh, Limits(mean=bound), progress=told.append).pieces) == pieces
    assert seen == asked and told == sorted(told) and told[-1] <= 1
