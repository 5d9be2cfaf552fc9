"""The committed objects are what their script makes, and sound.

Remeshing libraries differ in the last bits between versions, so the meshes that went through one are
compared by what matters: counts within 2 %, size, area, genus; the others byte for byte.
"""

import runpy
from pathlib import Path

import numpy as np
import pytest

from skinfab.mesh.fans import relative_heights
from skinfab.mesh.inspect import inspect
from skinfab.mesh.io import load_mesh

FOLDER = Path(__file__).parents[2] / "meshes"
EXPECTED = {  # faces, genus, closed
    "cube": (12, 0, True),
    "dodecahedron": (36, 0, True),
    "cylinder": (5712, 0, True),
    "cup": (14858, 1, True),
    "grip": (84982, 0, True),
    "human_finger": (11513, 0, False),
    "robot_finger": (11070, 0, False),
}


@pytest.fixture(scope="module")
def script() -> dict:
    return runpy.run_path(str(FOLDER / "make_meshes.py"))


def _volume(V: np.ndarray, F: np.ndarray) -> float:
    p = V[F] - V.mean(axis=0)
    return float(np.einsum("ij,ij->", p[:, 0], np.cross(p[:, 1], p[:, 2])) / 6)


def test_all_seven_are_there() -> None:
    assert {path.stem for path in FOLDER.glob("*.obj")} == set(EXPECTED)


@pytest.mark.parametrize("name", EXPECTED)
def test_committed_object_is_sound(name: str) -> None:
    path = FOLDER / f"{name}.obj"
    mesh = load_mesh(path).mesh
    found = inspect(mesh.V, mesh.F)
    faces, genus, closed = EXPECTED[name]
    assert (found.faces, found.components, found.genus, found.closed) == (faces, 1, (genus,), closed)
    assert found.boundary_loops == (0 if closed else 1)
    assert {fault.kind for fault in found.faults} <= {"open edge"}
    assert _volume(mesh.V, mesh.F) > 0
    assert relative_heights(mesh.V, mesh.F).min() > 0.15  # no needles
    assert path.stat().st_size < 9_000_000


@pytest.mark.parametrize("name", EXPECTED)
def test_committed_object_is_what_the_script_makes(name: str, script: dict) -> None:
    # Half of the time of all would go by making the grip as fine as it is: here it has a quarter of the triangles.
    coarser = 4 if name == "grip" else 1
    made = script["grip"](faces=script["GRIP_FACES"] // coarser) if name == "grip" else script["OBJECTS"][name]()
    committed = load_mesh(FOLDER / f"{name}.obj").mesh
    if name in ("cube", "dodecahedron", "cylinder", "robot_finger"):
        np.testing.assert_array_equal(committed.F, made.F)
        np.testing.assert_allclose(committed.V, made.V, atol=1e-7)
        return
    one, two = inspect(committed.V, committed.F), inspect(made.V, made.F)
    assert (one.genus, one.closed, one.components) == (two.genus, two.closed, two.components)
    np.testing.assert_allclose(one.faces, coarser * two.faces, rtol=0.02)
    np.testing.assert_allclose(committed.bbox, made.bbox, atol=0.1)
    np.testing.assert_allclose(one.area_mm2, two.area_mm2, rtol=0.002)
    np.testing.assert_allclose(_volume(committed.V, committed.F), _volume(made.V, made.F), rtol=0.002)


def test_every_point_of_the_grip_is_where_the_script_has_it(script: dict) -> None:
    assert np.abs(script["_grip_distance"](load_mesh(FOLDER / "grip.obj").mesh.V)).max() < 1e-4


def test_grip_has_the_studys_count(script: dict) -> None:
    assert script["GRIP_FACES"] == EXPECTED["grip"][0] == 84_982


def test_side_of_the_cylinder_bends_flat_without_stretch() -> None:
    """Angles about a vertex of a developable surface sum to a full turn."""
    mesh = load_mesh(FOLDER / "cylinder.obj").mesh
    p = mesh.V[mesh.F]
    angle = np.zeros(len(mesh.V))
    for k in range(3):
        a, b = p[:, (k + 1) % 3] - p[:, k], p[:, (k + 2) % 3] - p[:, k]
        cosine = (a * b).sum(axis=1) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
        np.add.at(angle, mesh.F[:, k], np.arccos(cosine))
    side = (mesh.V[:, 2] > 0.1) & (mesh.V[:, 2] < 99.9)
    assert side.sum() == 96 * 23
    np.testing.assert_allclose(angle[side], 2 * np.pi, atol=1e-6)
