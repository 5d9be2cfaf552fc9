"""Cleaning moves nothing, repair mends the rest, and what is left is refused."""

import runpy
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.mesh.door import load_usable
from skinfab.mesh.inspect import inspect
from skinfab.mesh.io import load_mesh
from skinfab.mesh.model import Mesh
from skinfab.mesh.repair import clean, repair, require_usable

ROOT = Path(__file__).parents[2]
REAL = ROOT.parent / "shared" / "meshes"
SHAPES = runpy.run_path(str(ROOT / "tests" / "stability" / "broken_meshes.py"))


def made(shape: str, *args: object) -> Mesh:
    V, F = SHAPES[shape](*args)
    return Mesh(np.array(V, dtype=float), np.array(F), shape)


@pytest.mark.parametrize("path", sorted((ROOT / "meshes").glob("*.obj")), ids=lambda p: p.stem)
def test_the_projects_own_objects_need_nothing(path: Path) -> None:
    mesh = load_mesh(path).mesh
    cleaned, done = clean(mesh)
    assert cleaned is mesh and done == []
    require_usable(mesh)


@pytest.mark.skipif(not REAL.exists(), reason="the real meshes (../shared/meshes) are not here")
@pytest.mark.parametrize("name", ["leap_fingertip.obj", "allegro_fingertip.obj", "blue_cup.ply", "ycb_pitcher.ply"])
def test_real_meshes_with_cracks_close_without_being_asked(name: str) -> None:
    before = load_mesh(REAL / name).mesh
    loaded = load_usable(REAL / name)
    after = inspect(loaded.mesh.V, loaded.mesh.F)
    assert after.closed and after.components == 1 and None not in after.genus and after.degenerate_faces == 0
    assert any("coincident" in note for note in loaded.notes)
    np.testing.assert_allclose(loaded.mesh.area, before.area, rtol=1e-12)  # the surface has not moved
    np.testing.assert_array_equal(loaded.mesh.bbox, before.bbox)


def test_touching_cubes_are_parted_into_the_two_solids() -> None:
    V, F = SHAPES["box"]((0, 0, 0))
    W, G = SHAPES["box"]((20, 20, 0))
    points, index = np.unique(np.array(V + W), axis=0, return_inverse=True)
    mesh = Mesh(points, index.ravel()[np.vstack([F, np.array(G) + 8])])
    assert mesh.topology.is_nonmanifold.sum() == 1
    cleaned, done = clean(mesh)
    found = inspect(cleaned.V, cleaned.F)
    assert len(done) == 1 and done[0].startswith("doubled 2 vertices where sheets touch")
    assert (found.components, found.genus, found.closed) == (2, (0, 0), True)
    p = cleaned.V[cleaned.F]
    volume = np.einsum("ij,ij->i", p[:, 0], np.cross(p[:, 1], p[:, 2])) / 6
    _, label = cleaned.topology.face_components()
    np.testing.assert_allclose(np.bincount(label, weights=volume), [8000, 8000])


def test_repair_takes_a_fin_off() -> None:
    mesh = made("sphere")
    tip = len(mesh.V)
    finned = Mesh(np.vstack([mesh.V, [[40.0, 0, 0]]]), np.vstack([mesh.F, [[33, 34, tip]]]), "finned")
    with pytest.raises(InputError, match=r"finned has non-manifold edge \(first: edge 33-34\); run again with --repair"):
        require_usable(finned)
    mended, done = repair(finned)
    require_usable(mended)
    assert any("non-manifold edge" in line for line in done)
    assert abs(mended.area / mesh.area - 1) < 0.02


def test_repair_closes_small_holes_and_keeps_the_opening() -> None:
    path = ROOT / "meshes" / "human_finger.obj"
    mesh = load_mesh(path).mesh
    holed = Mesh(mesh.V, np.delete(mesh.F, 5000, axis=0), "holed")
    assert inspect(holed.V, holed.F).boundary_loops == 2
    mended, done = repair(holed)
    found = inspect(mended.V, mended.F)
    assert any(line.startswith("closed holes") for line in done)
    assert (found.boundary_loops, found.genus) == (1, (0,))
    np.testing.assert_allclose(mended.area, mesh.area, rtol=1e-6)


def test_repair_of_an_intact_mesh_does_nothing() -> None:
    mesh = made("sphere")
    mended, done = repair(mesh)
    assert mended is mesh and done == []


def test_a_cavity_keeps_its_winding_but_a_solid_faces_outward() -> None:
    shell = made("sphere")
    inner = Mesh(shell.V * 0.5, shell.F[:, ::-1])
    hollow = Mesh(np.vstack([shell.V, inner.V]), np.vstack([shell.F, inner.F + len(shell.V)]))
    assert clean(hollow)[1] == []
    turned, done = clean(Mesh(shell.V, shell.F[:, ::-1]))
    assert done == [f"turned over {len(shell.F)} faces of closed parts that faced inward"]
    np.testing.assert_array_equal(turned.F, shell.F)


@pytest.mark.parametrize("bad", ["moebius", "nothing"])
def test_what_cannot_be_mended_is_refused(bad: str) -> None:
    mesh = made("moebius") if bad == "moebius" else Mesh(np.zeros((3, 3)), np.array([[0, 1, 2]]), "nothing")
    with pytest.raises(InputError, match=rf"^{bad}: .*(one-sided|no area)"):
        require_usable(repair(mesh)[0])
