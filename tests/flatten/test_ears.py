"""Chords halved: the same surface, an inner vertex in every triangle, and room for ears on straight sides."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import shapes

from skinfab.bench.cut import cut_disk
from skinfab.bench.optimum import CUTS
from skinfab.errors import RefusedError
from skinfab.flatten.bff import BffSolver
from skinfab.flatten.distortion import singular_values
from skinfab.flatten.ears import halve_chords
from skinfab.mesh.door import load_usable
from skinfab.mesh.topology import Topology

SHARED = Path(__file__).resolve().parents[2].parent / "shared" / "meshes"


def ragged() -> tuple[np.ndarray, np.ndarray]:
    """A sheet with two rows of teeth on it: an ear on an ear."""
    V, F = shapes.grid(8, 6)
    teeth = np.column_stack([np.arange(8) / 8 + 0.06, np.full(8, -0.1), np.zeros(8)])
    tips = teeth + np.array([0.03, -0.1, 0])
    k = np.arange(8)
    first, second = np.column_stack([k, 63 + k, k + 1]), np.column_stack([k, 71 + k, 63 + k])
    return np.vstack([V, teeth, tips]), np.vstack([F, first, second])


def caltrop() -> tuple[np.ndarray, np.ndarray]:
    """A triangle with an ear on each of its sides: three chords about it, no inner vertex."""
    a = np.pi * np.arange(6) / 3
    V = np.column_stack([np.cos(a), np.sin(a), 0.2 * np.cos(3 * a)])
    return V, np.array([[0, 2, 4], [0, 1, 2], [2, 3, 4], [4, 5, 0]])


def areas(V: np.ndarray, F: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1) / 2


@pytest.mark.parametrize(
    ("mesh", "chords"),
    [(shapes.wavy(), 2), (shapes.cone_sheet(), 2), (ragged(), 18), (caltrop(), 3), (shapes.grid(5, 1), 9)],
    ids=["square", "cone", "teeth on teeth", "caltrop", "strip"],
)
def test_halved_it_is_the_same_surface_with_an_inner_vertex_in_every_triangle(mesh, chords: int) -> None:
    V, F = mesh
    halved = halve_chords(V, F)
    assert len(halved.chords) == chords and len(halved.V) == len(V) + chords and len(halved.F) == len(F) + 2 * chords
    np.testing.assert_array_equal(halved.V[: len(V)], V)
    np.testing.assert_allclose(halved.V[len(V) :], V[halved.chords].mean(axis=1))
    topology, before = Topology(halved.F), Topology(F)
    assert topology.euler == before.euler and topology.is_oriented_manifold
    np.testing.assert_array_equal(np.sort(topology.boundary_loops[0]), np.sort(before.boundary_loops[0]))
    inner = ~np.isin(np.arange(len(halved.V)), topology.boundary_loops[0])
    assert inner[halved.F].any(axis=1).all() and len(halve_chords(halved.V, halved.F).chords) == 0
    np.testing.assert_allclose(np.bincount(halved.face_of, areas(halved.V, halved.F)), areas(V, F), rtol=1e-12)
    normal, own = (np.cross(W[G[:, 1]] - W[G[:, 0]], W[G[:, 2]] - W[G[:, 0]]) for W, G in ((halved.V, halved.F), (V, F)))
    assert ((normal * own[halved.face_of]).sum(axis=1) > 0).all()


def test_without_chords_nothing_changes() -> None:
    V, F = shapes.cap(6)
    halved = halve_chords(V, F)
    assert (halved.V == V).all() and (halved.F == F).all() and (halved.face_of == np.arange(len(F))).all()
    assert len(BffSolver(V, F).disk().chords) == 0


@pytest.mark.parametrize("mesh", [caltrop(), shapes.grid(5, 1)], ids=["caltrop", "strip"])
def test_where_every_triangle_hangs_on_the_border_there_is_room_in_a_square(mesh) -> None:
    solver = BffSolver(*mesh)
    for laid in (solver.disk(), solver.curve(np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]))):
        assert (singular_values(laid.V, laid.F, laid.UV)[:, 1] > 0).all()


def on_circle(uv: np.ndarray) -> float:
    return float(np.abs(np.linalg.norm(uv, axis=1) - 1).max())


def on_square(uv: np.ndarray) -> float:
    return float(np.abs(np.abs(uv - 20).max(axis=1) - 20).max())


def on_ellipse(uv: np.ndarray) -> float:
    return float(np.abs(np.hypot(*(uv / [30, 20]).T) - 1).max())


ANGLE = 2 * np.pi * np.arange(720) / 720
TARGETS = {
    "disk": (lambda s: s.disk(), on_circle, 1e-12),
    "ellipse": (lambda s: s.curve(np.column_stack([30 * np.cos(ANGLE), 20 * np.sin(ANGLE)])), on_ellipse, 2e-5),
    "square": (lambda s: s.curve(np.array([[0.0, 0], [40, 0], [40, 40], [0, 40]])), on_square, 1e-12),
}


@cache
def real_disk(name: str) -> tuple[np.ndarray, np.ndarray]:
    if not (SHARED / CUTS[name][0]).is_file():
        pytest.skip(f"needs ../shared/meshes/{CUTS[name][0]}")
    file, towards, share = CUTS[name]
    return cut_disk(load_usable(SHARED / file).mesh, towards, share)


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", [name for name in CUTS if not name.startswith("robot")])
def test_scans_lie_in_a_target_with_their_ears(name: str, target: str) -> None:
    """Unhalved, ears have no area in square and ellipse (3 to 73 of them), and s1 / s2 up to 1e5 in the disk."""
    V, F = real_disk(name)
    call, off, tolerance = TARGETS[target]
    solver = BffSolver(V, F)
    laid = call(solver)
    assert 10 <= len(laid.chords) <= 73 and off(laid.UV[solver.boundary]) < tolerance
    s = singular_values(laid.V, laid.F, laid.UV)
    assert s.min() > 0 and (s[:, 0] / s[:, 1]).max() < 400
    plain = singular_values(V, F, solver._extended(laid.UV[solver.boundary]))
    with np.errstate(divide="ignore"):
        assert np.abs(plain[:, 0] / plain[:, 1]).max() > 700


@pytest.mark.parametrize("target", TARGETS)
def test_a_border_of_needle_teeth_is_refused_in_words(target: str) -> None:
    """The robot finger's border turns by 175 degrees to and fro: laid straight there, its teeth shrink to e^-60 and less."""
    solver = BffSolver(*real_disk("robot finger, half"))
    assert np.degrees(solver._free_turning).max() > 175
    with pytest.raises(RefusedError, match=r"\d+ of 1355 triangles come out (without area inside .* sharp teeth|upside down inside)"):
        TARGETS[target][0](solver)
