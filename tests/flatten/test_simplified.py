"""Flattening by way of a simplified mesh: where it is taken, what it costs in d, and why it is left."""

import numpy as np
import pytest
import shapes

from skinfab.bench.disks import bumpy_cap
from skinfab.errors import InputError
from skinfab.flatten import simplified
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import measure
from skinfab.flatten.simplified import flatten_simplified
from skinfab.mesh.decimate import Decimated
from skinfab.mesh.topology import Topology
from skinfab.tolerances import SIMPLIFY_EFFECT

BUMPS = bumpy_cap(18_000)


def test_as_good_as_flattening_all_and_says_so() -> None:
    V, F = BUMPS
    flat, all_of_it = flatten_simplified(V, F), measure(V, F, flatten_isometric(V, F))
    carried = measure(V, F, flat.UV)
    assert 0 < flat.n_coarse <= len(F) // simplified.SHARE and flat.why == ""
    assert carried.flipped == 0 and carried.mean - all_of_it.mean <= flat.effect < SIMPLIFY_EFFECT
    assert flat.sentence == f"flattened on {flat.n_coarse} of {len(F)} triangles; that costs at most {flat.effect:.1g} of the mean d"


@pytest.mark.parametrize("unit", [1e-6, 1e6])
def test_the_unit_does_not_matter(unit: float) -> None:
    V, F = BUMPS
    one, other = flatten_simplified(V, F), flatten_simplified(V * unit, F)
    assert other.n_coarse == one.n_coarse
    assert measure(V * unit, F, other.UV).mean == pytest.approx(measure(V, F, one.UV).mean, abs=1e-6)


def test_vertices_may_come_in_any_order() -> None:
    V, F = BUMPS
    order = np.random.default_rng(0).permutation(len(V))
    W, G = np.empty_like(V), order[F]
    W[order] = V
    flat = flatten_simplified(W, G)
    assert flat.n_coarse and measure(W, G, flat.UV).mean - measure(V, F, flatten_isometric(V, F)).mean <= flat.effect


@pytest.mark.parametrize("shape", [shapes.cap(1), shapes.wavy(40), (np.eye(3), np.array([[0, 1, 2]]))], ids=["fan", "sheet", "triangle"])
def test_small_meshes_stay_as_they_are(shape: tuple[np.ndarray, np.ndarray]) -> None:
    V, F = shape
    flat = flatten_simplified(V, F)
    assert np.array_equal(flat.UV, flatten_isometric(V, F)) and (flat.n_coarse, flat.effect) == (0, 0.0)
    assert flat.sentence == f"flattened on all {len(F)} triangles: so few need no simplifying"


def test_a_simplified_mesh_that_is_too_coarse_is_only_the_start() -> None:
    V, F = bumpy_cap(4000)
    flat = flatten_simplified(V, F, share=200, least_coarse=10)
    assert flat.n_coarse == 0 and flat.effect == 0 and "of the mean d to gain" in flat.sentence
    assert measure(V, F, flat.UV).mean == pytest.approx(measure(V, F, flatten_isometric(V, F)).mean, abs=1e-5)


def test_where_nothing_can_be_spared_all_are_solved_for() -> None:
    """A flat strip: every vertex is on the boundary."""
    V, F = shapes.grid(10_000, 1)
    assert flatten_simplified(V, F).sentence == "flattened on all 20000 triangles: next to none of them can be spared"


def test_a_tear_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """The decimation does not promise a disk; a coarse mesh that is none is not used."""

    def torn(V: np.ndarray, F: np.ndarray, *, faces: int) -> Decimated:
        W, G = shapes.holed()
        return Decimated(W, G, np.zeros(len(V), dtype=np.int64))

    monkeypatch.setattr(simplified, "decimate", torn)
    V, F = BUMPS
    flat = flatten_simplified(V, F)
    assert flat.why == "simplifying would tear it or close it" and np.array_equal(flat.UV, flatten_isometric(V, F))


def test_needles_keep_the_promise() -> None:
    """A sheet whose triangles are a thousand times as long as wide: the vertices' own blocks see little of it."""
    V, F = shapes.grid(600, 15, lambda s, t: np.stack([s, 25 * t, 0.1 * np.sin(6 * s) * np.cos(4 * t)], axis=1))
    flat, all_of_it = flatten_simplified(V, F), measure(V, F, flatten_isometric(V, F))
    found = measure(V, F, flat.UV)
    assert found.flipped == 0 and found.mean - all_of_it.mean <= max(flat.effect, 1e-5)


def test_a_boundary_of_three_vertices() -> None:
    """A ball with one triangle missing: d is high and the start turned over; the answer is no worse than that of all triangles."""
    V, F = shapes.cap(54, 3.0)
    rim = Topology(F).boundary_loops[0]
    lid = np.stack([rim, np.roll(rim, 1), np.full(len(rim), len(V))], axis=1)
    W, G = np.vstack([V, V[rim].mean(axis=0)]), np.vstack([F, lid[1:]])
    assert [len(rim) for rim in Topology(G).boundary_loops] == [3]
    flat = flatten_simplified(W, G)
    found, all_of_it = measure(W, G, flat.UV), measure(W, G, flatten_isometric(W, G))
    assert found.flipped == 0 and found.mean - all_of_it.mean <= max(flat.effect, 1e-3)


def test_a_disk_with_a_hole_is_flattened_on_all_its_triangles() -> None:
    V, F = shapes.holed(120)
    flat = flatten_simplified(V, F)
    assert flat.sentence == f"flattened on all {len(F)} triangles: only a disk without holes is simplified"
    assert measure(V, F, flat.UV).mean == pytest.approx(4, abs=1e-9)


@pytest.mark.parametrize(("shape", "says"), [(shapes.sphere(5), "closed"), ((BUMPS[0] * np.nan, BUMPS[1]), "not a finite number")])
def test_what_is_no_disk_is_refused_as_without(shape: tuple[np.ndarray, np.ndarray], says: str) -> None:
    with pytest.raises(InputError, match=says):
        flatten_simplified(*shape)
