"""What a dart would gain is told without cutting: held against darts that are cut."""

import numpy as np
import pytest
import shapes

from skinfab.flatten.distortion import measure
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.outlook import dart_ways
from skinfab.seams.release import Way, held_releases, releases, right_of, sides_of
from skinfab.seams.sheet import Sheet, Surface, carried, lay_apart, lay_out, refined, sheet_of
from skinfab.seams.weights import seam_weights


def sheet(V: np.ndarray, F: np.ndarray) -> Sheet:
    mesh = Mesh(V, F)
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    opened = sheet_of(Surface(mesh, seam_weights(mesh), none), none)
    assert opened is not None
    return lay_out(opened)


def dome(angle: float = np.pi / 2) -> tuple[Sheet, list[Way]]:
    """A cap at its least d, and ways for darts."""
    flat = sheet(*shapes.cap(10, angle))
    flat = refined(flat, flat.solver.refine(flat.UV, tolerance=1e-6).UV)
    return flat, dart_ways(flat, count=6, apart=0.3)


def told_of(flat: Sheet, ways: list[Way]) -> list[np.ndarray]:
    return releases(flat.flexibility, sides_of(flat.solver, flat.UV, flat, ways))


def gained(flat: Sheet, way: Way, end: int) -> float:
    """By how much the mean d falls when the dart is really cut."""
    cut = flat.cut.copy()
    cut[way.edges[:end]] = True
    opened = sheet_of(flat.surface, cut)
    assert opened is not None
    energy = opened.solver.refine(carried(flat, opened), tolerance=1e-6).energy
    return energy[0] - energy[-1]


@pytest.mark.parametrize("angle", [0.3, 0.6, 1.2])
def test_as_much_as_is_gained_in_truth(angle: float) -> None:
    """To second order: the flatter the cap, the nearer."""
    flat, ways = dome(angle)
    for way, gains in zip(ways, told_of(flat, ways), strict=True):
        assert len(gains) == len(way.ends)
        for k in {0, len(gains) // 2, len(gains) - 1}:
            assert gains[k] == pytest.approx(gained(flat, way, way.ends[k]), rel=0.4 * angle**2, abs=1e-7)


def test_the_best_dart_is_known_beforehand() -> None:
    flat, ways = dome()
    told = [gains[-1] for gains in told_of(flat, ways)]
    truth = [gained(flat, way, len(way.edges)) for way in ways]
    assert truth[int(np.argmax(told))] >= 0.95 * max(truth)


def test_longer_gains_no_less() -> None:
    flat, ways = dome()
    for gains in told_of(flat, ways):
        assert (np.diff(gains) >= 0).all() and gains[0] >= 0 and gains[-1] > 0


def test_one_factorisation_for_all() -> None:
    flat, ways = dome()
    before = flat.solver.factorisations
    for _ in range(2):
        told_of(flat, ways)
    assert flat.solver.factorisations == before + 1


def test_nothing_to_gain_where_all_is_flat() -> None:
    flat = sheet(*shapes.wavy(8, 0.0))
    ways = dart_ways(flat, count=3, apart=0.1)
    assert len(ways) == 3
    for gains in told_of(flat, ways):
        assert np.abs(gains).max() < 1e-12


def test_contacts_are_held() -> None:
    """A ramp of more than one turn, laid out without overlap: the barrier's forces do not count as gain of a dart far away."""
    flat = lay_apart(sheet(*shapes.helicoid(1.3, 60, 4)))
    told = told_of(flat, dart_ways(flat, count=4, apart=0.3))
    assert all(np.isfinite(gains).all() and (gains >= 0).all() for gains in told)
    assert max(gains[-1] for gains in told) < measure(flat.surface.mesh.V, flat.F, flat.UV).mean - 4


@pytest.mark.parametrize("seed", range(5))
def test_the_right_side(seed: int) -> None:
    """Cut open along the path, faces on its right share no copy of a split vertex with those on its left."""
    V, F = shapes.random_disk(seed)
    mesh = Mesh(V, F)
    flat = sheet(V, F)
    for way in dart_ways(flat, count=4, apart=0.1):
        path, t = way.vertices, mesh.topology
        right = np.zeros(len(F), dtype=bool)
        right[right_of(path, way.edges, flat.F, t.FE, t.EF)] = True
        cut = np.zeros(len(t.E), dtype=bool)
        cut[way.edges] = True
        (opened,) = open_pieces(mesh, cut)
        for v in path[:-1]:
            at = flat.F == v
            one, two = (set(opened.F[at & side[:, None]].tolist()) for side in (right, ~right))
            assert len(one) == len(two) == 1 and one != two
        assert not (right & ~np.isin(flat.F, path[:-1]).any(axis=1)).any()


def test_few_ends_foretell_a_long_dart() -> None:
    """Between the ends of a way one side moves in proportion: by so little less than freely."""
    flat = sheet(*shapes.cap(24))
    (way,) = dart_ways(flat, count=1, apart=0.3)
    assert len(way.ends) < len(way.edges) and way.ends[-1] == len(way.edges)
    (few,) = told_of(flat, [way])
    every = Way(way.vertices, way.edges)
    vars(every)["ends"] = np.arange(1, len(way.edges) + 1)
    (all_of_them,) = told_of(flat, [every])
    part = few / all_of_them[way.ends - 1]
    assert (part <= 1 + 1e-9).all() and part[-1] > 0.9


def test_held_gains_are_less_and_rank_alike() -> None:
    flat, ways = dome()
    before = flat.solver.factorisations
    held = held_releases(sides_of(flat.solver, flat.UV, flat, ways))
    assert flat.solver.factorisations == before
    free = told_of(flat, ways)
    for one, two in zip(held, free, strict=True):
        assert (one <= two * (1 + 1e-9)).all() and (one > 0).any()
    assert free[int(np.argmax([gains[-1] for gains in held]))][-1] > 0.8 * max(gains[-1] for gains in free)
