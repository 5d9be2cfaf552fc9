"""What a dart would gain is told without cutting: held against darts that are cut."""

import numpy as np
import pytest
import shapes

from skinfab.flatten.bijective import flatten_bijective, keep_apart
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.isometric import IsometricSolver
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.darts import dart_ways
from skinfab.seams.release import Way, held_releases, releases, right_of
from skinfab.seams.weights import seam_weights


def dome(angle: float = np.pi / 2):
    """A cap with its least layout, and ways for darts."""
    mesh = Mesh(*shapes.cap(10, angle))
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    uv = flatten_isometric(mesh.V, piece.F)
    ways = dart_ways(mesh, piece, np.full(len(mesh.F), 5.0), seam_weights(mesh), count=6, apart=0.3)
    return mesh, piece, uv, ways


def gained(mesh: Mesh, piece, uv, way: Way, end: int) -> float:
    """By how much the mean d falls when the dart is really cut."""
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    cut[way.edges[:end]] = True
    (opened,) = open_pieces(mesh, cut)
    start = np.empty((len(opened.vertices), 2))
    start[opened.F.ravel()] = uv[piece.F.ravel()]
    energy = IsometricSolver(mesh.V[opened.vertices], opened.F).refine(start, tolerance=1e-6).energy
    return energy[0] - energy[-1]


@pytest.mark.parametrize("angle", [0.3, 0.6, 1.2])
def test_as_much_as_is_gained_in_truth(angle: float) -> None:
    """To second order: the flatter the cap, the nearer."""
    mesh, piece, uv, ways = dome(angle)
    told = releases(IsometricSolver(mesh.V, piece.F), uv, piece.topology, ways)
    for way, gains in zip(ways, told, strict=True):
        assert len(gains) == len(way.ends)
        for k in {0, len(gains) // 2, len(gains) - 1}:
            assert gains[k] == pytest.approx(gained(mesh, piece, uv, way, way.ends[k]), rel=0.4 * angle**2, abs=1e-7)


def test_the_best_dart_is_known_beforehand() -> None:
    mesh, piece, uv, ways = dome()
    told = [gains[-1] for gains in releases(IsometricSolver(mesh.V, piece.F), uv, piece.topology, ways)]
    truth = [gained(mesh, piece, uv, way, len(way.edges)) for way in ways]
    assert truth[int(np.argmax(told))] >= 0.95 * max(truth)


def test_longer_gains_no_less() -> None:
    mesh, piece, uv, ways = dome()
    for gains in releases(IsometricSolver(mesh.V, piece.F), uv, piece.topology, ways):
        assert (np.diff(gains) >= 0).all() and gains[0] >= 0 and gains[-1] > 0


def test_one_factorisation_for_all() -> None:
    mesh, piece, uv, ways = dome()
    solver = IsometricSolver(mesh.V, piece.F)
    before = solver.factorisations
    releases(solver, uv, piece.topology, ways)
    assert solver.factorisations == before + 1


def test_nothing_to_gain_where_all_is_flat() -> None:
    V, F = shapes.wavy(8, 0.0)
    mesh = Mesh(V, F)
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    ways = dart_ways(mesh, piece, np.full(len(F), 5.0), mesh.edge_lengths, count=3, apart=0.1)
    assert len(ways) == 3
    for gains in releases(IsometricSolver(V, F), V[:, :2], piece.topology, ways):
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
    ways = dart_ways(mesh, piece, np.full(len(F), 5.0), mesh.edge_lengths, count=4, apart=0.3)
    told = releases(solver, uv, piece.topology, ways, apart=apart)
    assert all(np.isfinite(gains).all() and (gains >= 0).all() for gains in told)
    assert max(gains[-1] for gains in told) < solver.refine(uv).energy[0] - 4


@pytest.mark.parametrize("seed", range(5))
def test_the_right_side(seed: int) -> None:
    """Cut open along the path, faces on its right share no copy of a split vertex with those on its left."""
    V, F = shapes.random_disk(seed)
    mesh = Mesh(V, F)
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    for way in dart_ways(mesh, piece, np.random.default_rng(seed).uniform(4, 6, len(F)), mesh.edge_lengths, count=4, apart=0.1):
        path, t = way.vertices, piece.topology
        right = np.zeros(len(F), dtype=bool)
        right[right_of(path, way.edges, t.F, t.FE, t.EF)] = True
        cut = np.zeros(len(t.E), dtype=bool)
        cut[way.edges] = True
        (opened,) = open_pieces(mesh, cut)
        for v in path[:-1]:
            at = piece.F == v
            one, two = (set(opened.F[at & side[:, None]].tolist()) for side in (right, ~right))
            assert len(one) == len(two) == 1 and one != two
        assert not (right & ~np.isin(piece.F, path[:-1]).any(axis=1)).any()


def test_few_ends_foretell_a_long_dart() -> None:
    """Between the ends of a way one side moves in proportion: by so little less than freely."""
    mesh = Mesh(*shapes.cap(24))
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    uv = flatten_isometric(mesh.V, piece.F)
    (way,) = dart_ways(mesh, piece, np.full(len(mesh.F), 5.0), seam_weights(mesh), count=1, apart=0.3)
    assert len(way.ends) < len(way.edges) and way.ends[-1] == len(way.edges)
    solver = IsometricSolver(mesh.V, piece.F)
    (few,) = releases(solver, uv, piece.topology, [way])
    every = Way(way.vertices, way.edges)
    vars(every)["ends"] = np.arange(1, len(way.edges) + 1)
    (all_of_them,) = releases(solver, uv, piece.topology, [every])
    part = few / all_of_them[way.ends - 1]
    assert (part <= 1 + 1e-9).all() and part[-1] > 0.9


def test_held_gains_are_less_and_rank_alike() -> None:
    mesh, piece, uv, ways = dome()
    solver = IsometricSolver(mesh.V, piece.F)
    held, free = held_releases(solver, uv, piece.topology, ways), releases(solver, uv, piece.topology, ways)
    assert solver.factorisations == 1
    for one, two in zip(held, free, strict=True):
        assert (one <= two * (1 + 1e-9)).all() and (one > 0).any()
    assert free[int(np.argmax([gains[-1] for gains in held]))][-1] > 0.8 * max(gains[-1] for gains in free)
