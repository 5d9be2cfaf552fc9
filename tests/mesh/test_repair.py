"""Cleaning moves nothing, repair mends the rest, and what is left is refused."""

import runpy
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.mesh.decimate import decimate
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


def waisted() -> Mesh:
    """A triangular column of three rings whose middle one is pressed to an edge, 3-4: two solids that touch there."""
    ring = np.array([[0.0, 0], [20, 0], [0, 20]])
    V = np.vstack([np.column_stack([ring, np.full(3, z)]) for z in (0.0, 10.0, 20.0)])
    F = [[0, 2, 1], [6, 7, 8]]
    for low in (0, 3):
        for k in range(3):
            a, b = low + k, low + (k + 1) % 3
            F += [[a, b, b + 3], [a, b + 3, a + 3]]
    pressed = np.array(F)
    pressed[pressed == 5] = 4
    return Mesh(V, pressed[(np.diff(np.sort(pressed, axis=1), axis=1) > 0).all(axis=1)])


def test_sheets_that_touch_along_an_edge_and_hang_together_at_both_ends_get_a_point_each() -> None:
    """Turned inside out the faces that enclose what lies between go on round both ends of the edge: no doubled vertex parts them."""
    solid = waisted()
    assert solid.topology.edge_count.max() == 4
    parted, done = clean(solid)
    assert inspect(parted.V, parted.F).components == 2 and done[0].startswith("doubled 2 vertices")
    hollow = Mesh(solid.V, np.ascontiguousarray(solid.F[:, ::-1]))
    cleaned, done = clean(hollow)
    assert done[0] == (
        "split 1 edge at which sheets touch that hang together at both ends (first: edge 3-4); turned over 14 faces of closed parts that "
        "faced inward"
    )
    require_usable(cleaned)
    found = inspect(cleaned.V, cleaned.F)
    assert (found.components, found.genus, found.closed) == (1, (0,), True)
    assert cleaned.area == pytest.approx(solid.area, rel=1e-12) and len(hollow.F) == len(solid.F)
    assert clean(cleaned)[1] == []


@pytest.mark.skipif(not REAL.exists(), reason="the real meshes (../shared/meshes) are not here")
def test_a_mesh_that_decimation_folded_is_usable() -> None:
    mesh = load_usable(REAL / "leap_fingertip.obj").mesh
    few = decimate(mesh.V, mesh.F, faces=len(mesh.F) // 8)
    folded = Mesh(few.V, few.F)
    assert folded.topology.is_nonmanifold.any()
    cleaned, done = clean(folded)
    require_usable(cleaned)
    assert any("hang together at both ends" in each for each in done)
    flaps = folded.area - cleaned.area  # pairs of faces back to back, which enclose nothing
    assert 0 <= flaps < 0.01 * folded.area
