"""Where flattening fails: each test first shows the plain method fail, then what is done instead."""

import igl
import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.flatten.bff import flatten_disk
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import best_scale, measure, shaped_areas, singular_values
from skinfab.flatten.isometric import IsometricSolver
from skinfab.flatten.laplacian import intrinsic
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology
from skinfab.seams.cones import flatten_with_cones
from skinfab.seams.cut import open_pieces
from skinfab.seams.disk import cut_to_disk


def plain_cotangents(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """The textbook formula: dot over cross at each corner."""
    p = V[F]
    with np.errstate(divide="ignore", invalid="ignore"):
        corners = [((q := np.roll(p, -k, axis=1))[:, 1] - q[:, 0], q[:, 2] - q[:, 0]) for k in range(3)]
        return np.stack([(a * b).sum(axis=1) / np.linalg.norm(np.cross(a, b), axis=1) for a, b in corners], axis=1)


def with_vertex(index: int, place) -> tuple[np.ndarray, np.ndarray]:
    V, F = shapes.wavy()
    V[index] = place(V)
    return V, F


DEGENERATE = {
    "edge without length": with_vertex(60, lambda V: V[61]),
    "vertex on an edge": with_vertex(60, lambda V: (V[61] + V[74]) / 2),
    "boundary edge without length": with_vertex(3, lambda V: V[4]),
    "three vertices in one": (lambda V, F: (np.where(np.isin(np.arange(len(V)), [60, 61, 74])[:, None], V[60], V), F))(*shapes.wavy()),
}


@pytest.mark.parametrize("name", DEGENERATE)
def test_triangles_without_area(name: str) -> None:
    V, F = DEGENERATE[name]
    assert not np.isfinite(plain_cotangents(V, F)).all() or np.abs(plain_cotangents(V, F)).max() > 1e6
    assert np.isfinite(intrinsic(V, F).cotangent).all()
    uv = flatten_isometric(V, F)
    result = measure(V, F, uv)
    assert np.isfinite(uv).all() and result.flipped == 0 and result.mean < 4.002 and result.overlap_mm2 == 0


def test_libigl_says_nothing_of_them() -> None:
    V, F = DEGENERATE["edge without length"]
    loop = Topology(F).boundary_loops[0]
    plain = igl.lscm(V, F, loop[[0, 24]], np.array([[0.0, 0], [1, 0]]))[0]
    assert not np.isfinite(plain).all() or (measure(V, F, plain).mean > 100)


def areas_from_lengths(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    """Heron's rule as it stands in the books."""
    a, b, c = (np.linalg.norm(V[F[:, (k + 1) % 3]] - V[F[:, k]], axis=1) for k in range(3))
    s = (a + b + c) / 2
    return np.sqrt(np.maximum(s * (s - a) * (s - b) * (s - c), 0))


@pytest.mark.parametrize("stretch", [1e5, 1e6])
def test_flat_slivers(stretch: float) -> None:
    """A flat sheet stretched until its edge lengths no longer tell its triangles' areas; their corners still do."""
    V, F = shapes.random_disk(4, 200, 0)
    V = V * [stretch, 1, 0] @ shapes.rotation(1).T
    area, _ = shaped_areas(V, F)
    assert np.abs(areas_from_lengths(V, F) / area - 1).max() > 1e-3
    for method in (flatten_disk, flatten_isometric):
        result = measure(V, F, method(V, F))
        assert result.flipped == 0 and result.max == pytest.approx(4, abs=1e-4)


@pytest.mark.parametrize("height", [1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-11])
def test_needles(height: float) -> None:
    """One triangle ever thinner: no hot spot on it, whether it still has a shape or not."""
    V, F = shapes.wavy()
    middle = (V[61] + V[74]) / 2
    V[60] = middle + (V[60] - middle) / np.linalg.norm(V[60] - middle) * height * np.linalg.norm(V[61] - V[74])
    result = measure(V, F, flatten_isometric(V, F))
    assert result.flipped == 0 and result.mean < 4.0003 and result.max < 20


@pytest.mark.parametrize("noise", [0.3, 1.0, 5.0])
def test_bff_flips_on_spikes(noise: float) -> None:
    V, F = shapes.random_disk(5, 100, noise)
    bff = flatten_disk(V, F)
    bff *= best_scale(V, F, bff)
    assert measure(V, F, bff).flipped > 10
    with pytest.raises(InputError, match="untangle"):  # no descent starts from there
        IsometricSolver(V, F).refine(bff)
    result = measure(V, F, flatten_isometric(V, F))
    assert result.flipped == 0 and result.mean < min(measure(V, F, uv).mean for uv in (tutte_embedding(V, F), bff))


def test_cotangent_weights_flip_where_uniform_ones_do_not() -> None:
    """Tutte's theorem asks for positive weights; obtuse corners make cotangents negative."""
    V, F = shapes.random_disk(5, 100, 1.0)
    loop = Topology(F).boundary_loops[0]
    circle = np.ascontiguousarray(igl.map_vertices_to_circle(np.asfortranarray(V), loop.astype(np.int32)))
    assert (singular_values(V, F, igl.harmonic(V, F, loop, circle, 1))[:, 1] < 0).sum() > 10
    assert (singular_values(V, F, tutte_embedding(V, F))[:, 1] > 0).all()


@pytest.mark.parametrize("angle", [2.8, 3.0, 3.1])
def test_purses(angle: float) -> None:
    """A sphere open by a hole only: conformal scale differs a hundredfold from rim to pole."""
    V, F = shapes.cap(16, angle)
    bff = flatten_disk(V, F)
    result = measure(V, F, flatten_isometric(V, F))
    assert measure(V, F, bff * best_scale(V, F, bff)).mean > 1.8 * result.mean
    assert result.flipped == 0 and result.mean < 12 and result.overlap_mm2 == 0


@pytest.mark.parametrize("method", [flatten_disk, flatten_isometric])
def test_closed_torn_and_scattered_input(method) -> None:
    """Closed meshes and unused vertices end a process inside libigl; here they are one sentence."""
    V, F = shapes.wavy()
    for bad in (
        shapes.sphere(),
        shapes.torus(),
        shapes.holed(),
        (np.vstack([V, V + 9]), np.vstack([F, F + len(V)])),
        (np.vstack([V, V]), F),
    ):
        with pytest.raises(InputError, match=r"only a disk can be flattened: this has \d+ components, .* cut it first"):
            method(*bad)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_coordinates_that_are_no_numbers(value: float) -> None:
    V, F = shapes.wavy()
    V[60, 2] = value
    loop = Topology(F).boundary_loops[0]
    plain = igl.lscm(V, F, loop[[0, 24]], np.array([[0.0, 0], [1, 0]]))[0]
    assert not np.isfinite(plain).all()  # no error, no map
    for method in (flatten_disk, flatten_isometric):
        with pytest.raises(InputError, match="vertex 60 has a coordinate that is not a finite number"):
            method(V, F)


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_the_smallest_and_the_thinnest(unit: float) -> None:
    one = np.array([[0.0, 0, 0], [3, 0, 0], [0, 4, 1]]), np.array([[0, 1, 2]])
    strip = shapes.grid(30, 1, lambda s, t: np.stack([np.cos(9 * s), np.sin(9 * s) + t, s * s], axis=1))
    fan = np.vstack([[0, 0, 0.3], shapes.cap(1)[0][1:]]), shapes.cap(1)[1]
    for V, F in (one, strip, fan):
        result = measure(unit * V, F, flatten_isometric(unit * V, F))
        assert result.flipped == 0 and np.isfinite(result.mean)
        if (V, F) is not fan and len(Topology(F).boundary_loops[0]) == len(V):  # no inner vertex: nothing bends it two ways
            assert result.mean == pytest.approx(4, abs=1e-6)


def test_a_cone_left_inside_a_piece() -> None:
    """A cube slit from corner to corner keeps five corners whole; eight cones open them all."""
    mesh = Mesh(*shapes.cube(4))
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    cut[cut_to_disk(mesh.topology, mesh.edge_lengths, len(mesh.V))] = True
    (slit,) = open_pieces(mesh, cut)
    V = mesh.V[slit.vertices]
    assert measure(V, slit.F, flatten_isometric(V, slit.F)).mean > 4.5
    _, net, UV, cones = flatten_with_cones(mesh, count=8)
    assert np.isin(mesh.V[cones], [0, 1]).all()
    assert measure(mesh.V[net.vertices], net.F, UV).mean == pytest.approx(4, abs=1e-9)
