"""What a dart would gain is told without cutting: held against darts that are cut."""

import numpy as np
import pytest
import shapes

from skinfab.flatten.bijective import flatten_bijective, keep_apart
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.isometric import IsometricSolver
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.darts import dart_paths
from skinfab.seams.release import path_edges, releases, right_of
from skinfab.seams.weights import seam_weights


def dome(angle: float = np.pi / 2):
    """A cap with its least layout, and ways for darts."""
    mesh = Mesh(*shapes.cap(10, angle))
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    uv = flatten_isometric(mesh.V, piece.F)
    paths = dart_paths(mesh, piece, np.full(len(mesh.F), 5.0), seam_weights(mesh), count=6, apart=0.3)
    return mesh, piece, uv, paths


def gained(mesh: Mesh, piece, uv, path) -> float:
    """By how much the mean d falls when the dart is really cut."""
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    cut[path_edges(piece.topology, path)] = True
    (opened,) = open_pieces(mesh, cut)
    start = np.empty((len(opened.vertices), 2))
    start[opened.F.ravel()] = uv[piece.F.ravel()]
    energy = IsometricSolver(mesh.V[opened.vertices], opened.F).refine(start, tolerance=1e-6).energy
    return energy[0] - energy[-1]


@pytest.mark.parametrize("angle", [0.3, 0.6, 1.2])
def test_as_much_as_is_gained_in_truth(angle: float) -> None:
    """To second order: the flatter the cap, the nearer."""
    mesh, piece, uv, paths = dome(angle)
    told = releases(IsometricSolver(mesh.V, piece.F), uv, piece.topology, paths)
    for path, gains in zip(paths, told, strict=True):
        assert len(gains) == len(path) - 1
        for k in {1, len(path) // 2, len(path) - 1}:
            assert gains[k - 1] == pytest.approx(gained(mesh, piece, uv, path[: k + 1]), rel=0.4 * angle**2, abs=1e-7)


def test_the_best_dart_is_known_beforehand() -> None:
    mesh, piece, uv, paths = dome()
    told = [gains[-1] for gains in releases(IsometricSolver(mesh.V, piece.F), uv, piece.topology, paths)]
    truth = [gained(mesh, piece, uv, path) for path in paths]
    assert truth[int(np.argmax(told))] >= 0.95 * max(truth)


def test_longer_gains_no_less() -> None:
    mesh, piece, uv, paths = dome()
    for gains in releases(IsometricSolver(mesh.V, piece.F), uv, piece.topology, paths):
        assert (np.diff(gains) >= 0).all() and gains[0] >= 0 and gains[-1] > 0


def test_one_factorisation_for_all() -> None:
    mesh, piece, uv, paths = dome()
    solver = IsometricSolver(mesh.V, piece.F)
    before = solver.factorisations
    releases(solver, uv, piece.topology, paths)
    assert solver.factorisations == before + 1


def test_nothing_to_gain_where_all_is_flat() -> None:
    V, F = shapes.wavy(8, 0.0)
    mesh = Mesh(V, F)
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    paths = dart_paths(mesh, piece, np.full(len(F), 5.0), mesh.edge_lengths, count=3, apart=0.1)
    assert len(paths) == 3
    for gains in releases(IsometricSolver(V, F), V[:, :2], piece.topology, paths):
        assert np.abs(gains).max() < 1e-15


def test_contacts_are_held() -> None:
    """A ramp of more than one turn, laid out without overlap: the barrier's forces do not count as gain of a dart far away."""
    V, F = shapes.helicoid(1.3, 60, 4)
    mesh = Mesh(V, F)
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    uv = flatten_bijective(V, F)
    apart = keep_apart(V, piece.topology)
    solver = IsometricSolver(V, F)
    uv = solver.refine(uv, tolerance=1e-6, apart=apart).UV
    paths = dart_paths(mesh, piece, np.full(len(F), 5.0), mesh.edge_lengths, count=4, apart=0.3)
    told = releases(solver, uv, piece.topology, paths, apart=apart)
    assert all(np.isfinite(gains).all() and (gains >= 0).all() for gains in told)
    assert max(gains[-1] for gains in told) < solver.refine(uv).energy[0] - 4


@pytest.mark.parametrize("seed", range(5))
def test_the_right_side(seed: int) -> None:
    """Cut open along the path, faces on its right share no copy of a split vertex with those on its left."""
    V, F = shapes.random_disk(seed)
    mesh = Mesh(V, F)
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    for path in dart_paths(mesh, piece, np.random.default_rng(seed).uniform(4, 6, len(F)), mesh.edge_lengths, count=4, apart=0.1):
        edges = path_edges(piece.topology, path)
        t = piece.topology
        right = np.zeros(len(F), dtype=bool)
        right[right_of(path, edges, t.F, t.FE, t.EF)] = True
        cut = np.zeros(len(t.E), dtype=bool)
        cut[edges] = True
        (opened,) = open_pieces(mesh, cut)
        for v in path[:-1]:
            at = piece.F == v
            one, two = (set(opened.F[at & side[:, None]].tolist()) for side in (right, ~right))
            assert len(one) == len(two) == 1 and one != two
        assert not (right & (piece.F == path[-1]).any(axis=1) & ~np.isin(piece.F, path[:-1]).any(axis=1)).any()
