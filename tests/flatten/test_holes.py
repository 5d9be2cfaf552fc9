"""Holes: filled for the solve only, so that a flat annulus stays as it is and every bent one lies flat without a flip."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import best_scale, measure, shaped_areas, singular_values
from skinfab.flatten.holes import border_of, fill_holes, flatten_filled, flatten_least
from skinfab.flatten.isometric import IsometricSolver
from skinfab.mesh.door import load_usable
from skinfab.mesh.topology import Topology


def annulus(columns: int = 48, rows: int = 8, height: float = 0.0):
    """Radii 1 to 2, closed round; the inner border, with fewer mm but as many vertices, is lifted by `height`."""
    i, j = np.meshgrid(np.arange(columns), np.arange(rows + 1))
    a, r = 2 * np.pi * i.ravel() / columns, 1 + j.ravel() / rows
    V = np.stack([r * np.cos(a), r * np.sin(a), height * (2 - r)], axis=1)
    i, j = i[:-1].ravel(), j[:-1].ravel()
    here, right = j * columns + i, j * columns + (i + 1) % columns
    F = np.stack([np.stack([here, right + columns, right], axis=-1), np.stack([here, here + columns, right + columns], axis=-1)], axis=1)
    return V, F.reshape(-1, 3)


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("mesh", [shapes.holed(), annulus()], ids=["two holes", "annulus"])
def test_what_is_flat_stays_as_it_is(mesh, unit: float) -> None:
    V, F = unit * mesh[0], mesh[1]
    uv = flatten_filled(V, F)
    assert uv.shape == (len(V), 2)
    np.testing.assert_allclose(singular_values(V, F, uv), 1, atol=1e-9)
    assert measure(V, F, uv).mean == pytest.approx(4, abs=1e-9)


def without(V: np.ndarray, F: np.ndarray, gone: np.ndarray):
    """The largest part left without the faces `gone`."""
    G = F[~gone]
    _, label = Topology(G).face_components()
    used, local = np.unique(G[label == np.bincount(label).argmax()], return_inverse=True)
    return V[used], local.reshape(-1, 3)


def slit_by_a_c(n: int = 30):
    """A bumpy sheet with a jagged hole in the shape of a C, longer than the border; its island hangs on by a neck."""
    V, F = shapes.grid(n, n, lambda s, t: np.stack([s, t, 0.2 * np.sin(5 * s) * np.cos(4 * t)], axis=1))
    x, y = (V[F].mean(axis=1)[:, :2] - 0.5).T
    r = np.hypot(x, y)
    return without(V, F, (r > 0.2) & (r < 0.3) & (np.abs(np.arctan2(y, x)) < 2.8))


def hollowed_purse():
    """Nine tenths of a sphere with a hole in its side, near the opening."""
    V, F = shapes.cap(20, 2.6)
    return without(V, F, np.linalg.norm(V[F].mean(axis=1) - [np.sin(1.95), 0, np.cos(1.95)], axis=1) < 0.5)


def test_the_border_is_the_widest_loop_though_a_hole_be_longer() -> None:
    V, F = slit_by_a_c()
    topology = Topology(F)
    length = [np.linalg.norm(V[np.roll(loop, -1)] - V[loop], axis=1).sum() for loop in topology.boundary_loops]
    border = border_of(V, topology)
    assert len(length) == 2 and length[border] < max(length)
    assert np.isin(V[topology.boundary_loops[border], :2].round(9), [0, 1]).any(axis=1).all()
    for seed in range(4):
        W, G, place = shapes.relabelled(V @ shapes.rotation(seed).T, F, seed)
        other = Topology(G)
        assert set(other.boundary_loops[border_of(W, other)]) == set(place[topology.boundary_loops[border]])


def test_a_hole_that_bends_in_is_filled_between_its_own_vertices() -> None:
    V, F = slit_by_a_c()
    W, G = fill_holes(V, F)
    hole = np.setdiff1d(np.unique(G[len(F) :]), [])
    assert W is V and len(G) == len(F) + len(hole) - 2 and Topology(G).euler == 1 and Topology(G).is_oriented_manifold
    p = V[G[len(F) :]]
    assert (np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])[:, 2] > -1e-12).all()


def test_a_fan_in_such_a_hole_would_flip_the_sheet(monkeypatch: pytest.MonkeyPatch) -> None:
    V, F = slit_by_a_c()
    assert measure(V, F, flatten_filled(V, F)).mean < 4.05
    monkeypatch.setattr("skinfab.flatten.holes._folds", lambda *_: False)
    assert measure(V, F, flatten_filled(V, F)).mean > 50


@pytest.mark.parametrize("mesh", [annulus(height=1.0), slit_by_a_c(), shapes.wavy()], ids=["annulus", "C", "no hole"])
def test_holes_left_to_themselves_take_less(mesh) -> None:
    V, F = mesh
    W, G = fill_holes(V, F)
    filled = flatten_isometric(W, G)[: len(V)]
    freed, held = measure(V, F, flatten_least(V, F)), measure(V, F, filled * best_scale(V, F, filled))
    assert freed.flipped == 0 and freed.overlap_mm2 == 0
    assert freed.mean == pytest.approx(held.mean, rel=1e-9) if G is F else freed.mean < 4 + 0.8 * (held.mean - 4)


def test_a_hole_whose_rim_would_cover_itself_stays_filled() -> None:
    V, F = hollowed_purse()
    W, G = fill_holes(V, F)
    filled = flatten_isometric(W, G)[: len(V)]
    freed = IsometricSolver(V, F).refine(filled * best_scale(V, F, filled)).UV
    assert measure(V, F, freed).overlap_mm2 > 0.01 * shaped_areas(V, F)[0].sum()
    figures = measure(V, F, flatten_least(V, F))
    assert figures.overlap_mm2 == 0 and figures.flipped == 0 and figures.mean < 5.6


def test_the_middle_of_a_hole_takes_a_fan() -> None:
    V, F = annulus()
    W, G = fill_holes(V, F)
    np.testing.assert_allclose(W[len(V) :], [[0, 0, 0]], atol=1e-12)
    filled = Topology(G)
    assert filled.euler == 1 and set(filled.boundary_loops[0]) == set(range(8 * 48, 9 * 48))
    np.testing.assert_array_equal(W[: len(V)], V)
    np.testing.assert_array_equal(G[: len(F)], F)


def test_the_fans_run_as_their_neighbours_do() -> None:
    """No edge is run through twice in the same direction."""
    _, G = fill_holes(*shapes.holed())
    ways = np.concatenate([G[:, [0, 1]], G[:, [1, 2]], G[:, [2, 0]]])
    assert len(np.unique(ways, axis=0)) == len(ways)


@pytest.mark.parametrize("height", [0.3, 1.0])
def test_a_bent_annulus_has_no_flip_and_keeps_its_symmetry(height: float) -> None:
    V, F = annulus(height=height)
    uv = flatten_filled(V, F)
    figures = measure(V, F, uv)
    assert figures.flipped == 0 and figures.overlap_mm2 == 0
    radius = np.linalg.norm(uv - uv[:48].mean(axis=0), axis=1).reshape(9, 48)
    np.testing.assert_allclose(radius, radius.mean(axis=1, keepdims=True) * np.ones(48), rtol=1e-9)
    assert (np.diff(radius.mean(axis=1)) > 0).all()


@pytest.mark.parametrize("seed", range(3))
def test_order_and_motion_change_nothing(seed: int) -> None:
    V, F = slit_by_a_c(15)
    W, G, _ = shapes.relabelled(V, F, seed)
    here, there = measure(V, F, flatten_filled(V, F)), measure(W, G, flatten_filled(2.5 * W @ shapes.rotation(seed).T - 4, G) / 2.5)
    assert there.mean == pytest.approx(here.mean, abs=1e-3)


def test_a_disk_is_left_alone() -> None:
    V, F = shapes.wavy()
    W, G = fill_holes(V, F)
    assert W is V and G is F


@pytest.mark.parametrize("mesh", [shapes.sphere(), shapes.torus()], ids=["sphere", "torus"])
def test_what_stays_no_disk_is_named(mesh) -> None:
    with pytest.raises(InputError, match="only a disk can be flattened"):
        flatten_filled(*mesh)


def pinched() -> tuple[np.ndarray, np.ndarray]:
    """Two holes that meet in a corner: one vertex with two fans of faces."""
    return shapes.holed(holes=((4, 4), (5, 5)))


def test_a_hole_pinched_to_a_vertex_is_named_and_a_files_is_taken_apart(tmp_path) -> None:
    V, F = pinched()
    vertex = 5 * 13 + 5
    assert [len(loop) for loop in Topology(F).boundary_loops][1:] == [8]
    with pytest.raises(InputError, match=f"a hole meets itself at vertex {vertex}; .* as reading from a file does"):
        fill_holes(V, F)
    path = tmp_path / "pinched.obj"
    path.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in V.tolist()) + "".join(f"f {a} {b} {c}\n" for a, b, c in (F + 1).tolist()))
    mesh = load_usable(path).mesh
    assert len(mesh.V) == len(V) + 1
    figures = measure(mesh.V, mesh.F, flatten_filled(mesh.V, mesh.F))
    assert figures.flipped == 0 and figures.mean == pytest.approx(4, abs=1e-9)
