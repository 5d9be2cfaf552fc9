"""Boundary first flattening: exact on developables, conformal in the limit, one factorisation and two solves."""

import numpy as np
import pytest
import shapes

from skinfab.flatten import bff, bff_target
from skinfab.flatten.bff import BffSolver, flatten_disk
from skinfab.flatten.bff_curve import turning_of
from skinfab.flatten.distortion import measure, singular_values
from skinfab.flatten.ears import halve_chords
from skinfab.flatten.laplacian import intrinsic
from skinfab.linalg import Cholesky


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("sheet", [shapes.cylinder_sheet, shapes.cone_sheet, shapes.grid])
def test_developables_come_out_isometric(sheet, unit: float) -> None:
    V, F = sheet(24, 10)
    uv = flatten_disk(unit * V, F)
    np.testing.assert_allclose(singular_values(unit * V, F, uv), 1, atol=1e-9)
    assert measure(unit * V, F, uv).mean == pytest.approx(4, abs=1e-9)


def test_conformal_in_the_limit() -> None:
    """On a hemisphere the quasi-conformal error s1 / s2 - 1 falls with the edge length."""
    error = []
    for rings in (6, 12, 24, 48):
        V, F = shapes.cap(rings)
        s = singular_values(V, F, flatten_disk(V, F))
        assert s.min() > 0
        error.append((s[:, 0] / s[:, 1] - 1).mean())
    rate = np.log2(np.array(error[:-1]) / error[1:])
    assert (rate > 0.9).all() and error[-1] < 0.02


def test_hemisphere_has_the_closed_form_scale() -> None:
    """With u = 0 on the boundary the flat hemisphere is the disk of stereographic projection, of the boundary's radius."""
    V, F = shapes.cap(40)
    uv = flatten_disk(V, F)
    radius = np.linalg.norm(uv - uv[0], axis=1)
    polar = np.arccos(V[:, 2])
    np.testing.assert_allclose(radius, np.tan(polar / 2), atol=2e-3)


def test_prescribed_boundary_scale_gives_the_conformal_map() -> None:
    """u = log |f'| on the boundary of a flat square is the map f itself, here f = exp."""
    error = []
    for n in (8, 16, 32):
        V, F = shapes.grid(n, n)
        z = V[:, 0] + 1j * V[:, 1]
        uv = flatten_disk(V, F, scale=z.real)  # log |exp'(z)| = Re z
        got, want = uv @ [1, 1j], np.exp(z)
        got, want = got - got.mean(), want - want.mean()
        spin = np.vdot(got, want) / abs(np.vdot(got, want))
        error.append(np.abs(got * spin - want).max())
    assert error[-1] < 2e-3 and error[0] / error[1] > 3 and error[1] / error[2] > 3  # second order


def test_constant_scale_is_a_similarity() -> None:
    V, F = shapes.wavy()
    plain, larger = flatten_disk(V, F), flatten_disk(V, F, scale=np.full(len(V), np.log(3)))
    np.testing.assert_allclose(larger - larger[0], 3 * (plain - plain[0]), atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_motion_and_order_change_nothing(seed: int) -> None:
    V, F = shapes.wavy()
    s = singular_values(V, F, flatten_disk(V, F))
    W, G, _ = shapes.relabelled(V, F, seed)
    order = np.random.default_rng(seed)
    order.permutation(len(V))
    faces = order.permutation(len(F))
    W = 2.5 * W @ shapes.rotation(seed).T - 4
    np.testing.assert_allclose(singular_values(W, G, flatten_disk(W, G)), s[faces], atol=1e-9)


def test_one_factorisation_two_solves(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Cholesky] = []

    class Watched(Cholesky):
        def __init__(self, lower) -> None:
            super().__init__(lower)
            made.append(self)

    monkeypatch.setattr(bff, "Cholesky", Watched)
    flatten_disk(*shapes.wavy())
    assert [(c.factorisations, c.solves) for c in made] == [(1, 2)]
    flatten_disk(*shapes.grid(5, 1))  # no inner vertex: nothing to solve
    assert len(made) == 1


def corners_turn(solver: BffSolver, *corners: int) -> np.ndarray:
    """A rectangle's turning angles: a right angle at each of the four vertices, straight on elsewhere."""
    return np.where(np.isin(solver.boundary, corners), np.pi / 2, 0.0)


def shape_of(uv: np.ndarray) -> np.ndarray:
    """What no rotation, shift or size changes."""
    z = uv @ [1, 1j]
    z = z - z.mean()
    return z / np.linalg.norm(z)


def distance(uv: np.ndarray, other: np.ndarray) -> float:
    a, b = shape_of(uv), shape_of(other)
    return float(np.abs(a * np.exp(-1j * np.angle(np.vdot(b, a))) - b).max())


def test_the_objects_own_lengths_open_a_cylinder_into_its_rectangle() -> None:
    V, F = shapes.cylinder_sheet(48, 10, radius=2.0, height=3.0)
    solver = BffSolver(V, F)
    uv = solver.lengths(solver.lengths_mm)
    assert measure(V, F, uv).mean == pytest.approx(4, abs=1e-9)
    sides = np.sort(np.linalg.norm(uv[[48, 490]] - uv[0], axis=1))
    np.testing.assert_allclose(sides, [3, 48 * 4 * np.sin(np.pi / 48)], atol=1e-9)


def test_prescribed_lengths_are_met_and_are_the_scale_they_imply() -> None:
    """Edges of exp's boundary on the unit square: the lengths give the map back, as its scale does."""
    error = []
    for n in (8, 16, 32):
        V, F = shapes.grid(n, n)
        image = np.exp(V[:, 0] + 1j * V[:, 1])
        solver = BffSolver(V, F)
        target = np.abs(np.roll(image[solver.boundary], -1) - image[solver.boundary])
        uv = solver.lengths(target)
        got = np.linalg.norm(np.roll(uv[solver.boundary], -1, axis=0) - uv[solver.boundary], axis=1)
        error.append((np.abs(got / target - 1).max(), distance(uv, np.column_stack([image.real, image.imag]))))
    close, shape = np.array(error).T
    assert close[-1] < 2e-3 and shape[-1] < 2e-3
    assert (close[:-1] / close[1:] > 1.8).all() and (shape[:-1] / shape[1:] > 1.8).all()


def test_four_right_angles_lay_a_bent_sheet_out_to_its_rectangle() -> None:
    V, F = shapes.cylinder_sheet(24, 10)
    solver = BffSolver(V, F)
    assert measure(V, F, solver.angles(corners_turn(solver, 0, 24, 250, 274))).mean == pytest.approx(4, abs=1e-9)


def test_four_right_angles_make_a_rectangle_of_what_is_not_developable() -> None:
    """A quarter of an annulus between radii 1 and e is conformal to a rectangle of sides 1 and pi / 2 (the logarithm)."""
    error = []
    for n in (8, 16, 32):

        def sector(s, t):
            r, a = np.exp(s), np.pi / 2 * t
            return np.stack([r * np.cos(a), r * np.sin(a), 0 * s], axis=1)

        V, F = shapes.grid(n, n, sector)
        solver = BffSolver(V, F)
        uv = solver.angles(corners_turn(solver, 0, n, n * (n + 1), (n + 1) ** 2 - 1))
        turned = turning_of(uv[solver.boundary])
        np.testing.assert_allclose(turned, corners_turn(solver, 0, n, n * (n + 1), (n + 1) ** 2 - 1), atol=1e-9)
        z = np.log(V[:, 0] + 1j * V[:, 1])
        error.append(distance(uv, np.column_stack([z.real, z.imag])))
    assert error[-1] < 1e-3 and error[0] / error[1] > 3 and error[1] / error[2] > 3


def test_angles_undo_scale() -> None:
    """Neumann to Dirichlet is the inverse of Dirichlet to Neumann, up to the constant: to rounding."""
    V, F = shapes.wavy(20)
    solver = BffSolver(V, F)
    u = 0.3 * np.sin(np.arange(len(solver.boundary)))
    np.testing.assert_allclose(solver.scale_of(solver._turning(u)), u - u.mean(), atol=1e-12)
    assert distance(solver.angles(solver._turning(u)), solver.scale(u)) < 1e-12


def dense_neumann_to_dirichlet(L: np.ndarray, boundary: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """By the textbook: the Schur complement of the inner block, inverted in the sense of Moore and Penrose."""
    inner = np.setdiff1d(np.arange(len(L)), boundary)
    coupling = L[np.ix_(inner, boundary)]
    S = L[np.ix_(boundary, boundary)] - coupling.T @ np.linalg.solve(L[np.ix_(inner, inner)], coupling)
    return np.linalg.pinv(S, hermitian=True) @ slope


@pytest.mark.parametrize("mesh", [shapes.wavy(20), shapes.cap(12, 2.5), shapes.random_disk(5, 300), shapes.cylinder_sheet(120, 4)])
def test_the_boundarys_inverse_is_the_dense_one(mesh) -> None:
    V, F = mesh
    solver = BffSolver(V, F)
    slope = np.random.default_rng(0).standard_normal(len(solver.boundary))
    dense = dense_neumann_to_dirichlet(intrinsic(V, F).stiffness().toarray(), solver.boundary, slope)
    sparse = solver.scale_of(solver._turning(np.zeros(len(slope))) + slope)
    np.testing.assert_allclose(sparse, dense, atol=1e-12 * np.abs(dense).max() * len(V))


def test_hemisphere_becomes_the_disk_of_stereographic_projection() -> None:
    error = []
    for rings in (6, 12, 24, 48):
        V, F = shapes.cap(rings)
        solver = BffSolver(V, F)
        uv = solver.disk().UV
        np.testing.assert_allclose(np.linalg.norm(uv[solver.boundary], axis=1), 1, atol=1e-12)
        error.append(np.abs(np.linalg.norm(uv, axis=1) - np.tan(np.arccos(V[:, 2]) / 2)).max())
    assert error[-1] < 5e-5 and (np.array(error[:-1]) / error[1:] > 3).all()  # second order


def egg(rings: int):
    """Half an egg with a dent: smooth round its border, without any symmetry of the circle."""
    V, F = shapes.cap(rings)
    x, y, z = V.T
    return np.column_stack([1.4 * x + 0.2 * x * y, y, z + 0.15 * np.sin(3 * x + y)]), F


def test_disk_is_conformal_in_the_limit_whatever_vertex_comes_first() -> None:
    error = []
    for rings in (6, 12, 24, 48):
        V, F = egg(rings)
        uv = BffSolver(V, F).disk().UV
        s = singular_values(V, F, uv)
        assert s.min() > 0
        error.append((s[:, 0] / s[:, 1] - 1).mean())
        W, G, place = shapes.relabelled(V, F, 3)
        assert distance(BffSolver(W, G).disk().UV[place], uv) < 1e-8
    assert (np.log2(np.array(error[:-1]) / error[1:]) > 0.8).all() and error[-1] < 0.03


def test_the_curve_of_the_free_boundary_gives_its_map_back() -> None:
    error = []
    for n in (12, 24, 48):
        halved = halve_chords(*shapes.wavy(n))  # beforehand, so that both maps are of the same triangles
        solver = BffSolver(halved.V, halved.F)
        free = solver.free()
        error.append(np.abs(solver.curve(free[solver.boundary]).UV - free).max())
    assert max(error) < 1e-6
    for V, F in (shapes.cap(12), shapes.cylinder_sheet()):
        solver = BffSolver(V, F)
        free = solver.free()
        np.testing.assert_allclose(solver.curve(free[solver.boundary]).UV[: len(V)], free, atol=1e-9)


def test_a_curve_is_met_and_the_map_to_it_conformal_in_the_limit() -> None:
    """A hemisphere laid in an ellipse of 3 : 2."""
    a = 2 * np.pi * np.arange(720) / 720
    ellipse = np.column_stack([30 * np.cos(a), 20 * np.sin(a)])
    error = []
    for rings in (6, 12, 24, 48):
        V, F = shapes.cap(rings)
        solver = BffSolver(V, F)
        uv = solver.curve(ellipse).UV
        np.testing.assert_allclose(np.hypot(*(uv[solver.boundary] / [30, 20]).T), 1, atol=2e-5)
        s = singular_values(V, F, uv)
        assert s.min() > 0
        error.append((s[:, 0] / s[:, 1] - 1).mean())
    rate = np.log2(np.array(error[:-1]) / error[1:])
    assert (rate > 0.8).all() and error[-1] < 0.03


def cushion(points: int = 360) -> np.ndarray:
    """A rounded rectangle of 2 by 1 (Lame's curve of the fourth degree): round enough not to lay a corner's triangle flat."""
    a = 2 * np.pi * np.arange(points) / points
    c, s = np.cos(a), np.sin(a)
    return np.column_stack([c, s / 2]) / (c**4 + s**4)[:, None] ** 0.25


CUSHION = cushion()

METHODS = {
    "free": (lambda s, unit: s.free(), 1),
    "scale": (lambda s, unit: s.scale(0.2 * np.cos(np.arange(len(s.boundary)))), 1),
    "lengths": (lambda s, unit: s.lengths(s.lengths_mm * (1.2 + 0.2 * np.cos(np.arange(len(s.boundary))))), 1),
    "angles": (lambda s, unit: s.angles(np.full(len(s.boundary), 2 * np.pi / len(s.boundary))), 1),
    "curve": (lambda s, unit: s.curve(unit * CUSHION).UV, 1),
    "disk": (lambda s, unit: s.disk().UV, 0),
}


@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1e3, 1e6])
@pytest.mark.parametrize("method", METHODS)
def test_unit_changes_nothing(method: str, unit: float) -> None:
    V, F = shapes.wavy()
    call, power = METHODS[method]
    there, here = call(BffSolver(unit * V, F), unit), call(BffSolver(V, F), 1.0)
    np.testing.assert_allclose(there / unit**power, here, atol=1e-9 * np.abs(here).max())


@pytest.mark.parametrize(("mesh", "of_shapes"), [(egg(16), 2), (shapes.wavy(20), 4)], ids=["no chords", "chords"])
def test_counters(mesh, of_shapes: int) -> None:
    """Free, scale and lengths take two solves of one factorisation; a second one serves every angle, disk and curve after the first.

    Where chords are halved, disks and curves have two of their own.
    """
    solver = BffSolver(*mesh)
    b = len(solver.boundary)
    assert (solver.factorisations, solver.solves) == (1, 0)
    solver.free()
    solver.scale(np.ones(b))
    solver.lengths(solver.lengths_mm)
    assert (solver.factorisations, solver.solves) == (1, 6)
    solver.angles(np.full(b, 2 * np.pi / b))  # the free turning angles, once and for all; the inverse; the extension
    assert (solver.factorisations, solver.solves) == (2, 9)
    solver.angles(np.full(b, 2 * np.pi / b))
    assert (solver.factorisations, solver.solves) == (2, 11)
    solver.disk()  # a round one solve
    assert solver.factorisations == of_shapes and solver.solves - 11 <= 21
    before = solver.solves
    a = 2 * np.pi * np.arange(4000) / 4000
    solver.curve(np.column_stack([3 * np.cos(a), 2 * np.sin(a)]))  # at most 30 rounds of two; then at most 60 steps of two
    assert solver.factorisations == of_shapes and solver.solves - before <= 180


@pytest.mark.parametrize("mesh", [shapes.cap(24), egg(24), shapes.wavy(24), shapes.cylinder_sheet(48, 10)])
def test_acceleration_halves_the_rounds_to_the_same_circle(mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    quick, plain = BffSolver(*mesh), BffSolver(*mesh)
    uv = quick.disk().UV
    monkeypatch.setattr(bff_target, "_LOOK_BACK", 0)
    np.testing.assert_allclose(plain.disk().UV, uv, atol=1e-9)
    assert quick.solves < 20 and (quick.solves < 0.65 * plain.solves or plain.solves < 8)


@pytest.mark.parametrize("mesh", [shapes.grid(5, 1), shapes.grid(1, 1)], ids=["strip", "two triangles"])
def test_without_inner_vertices_only_the_boundary_is_solved_for(mesh) -> None:
    solver = BffSolver(*mesh)
    assert np.isfinite(solver.free()).all() and (solver.factorisations, solver.solves) == (0, 0)
    factorisations = (1, 3)[len(solver.disk().chords) > 0]
    maps = [solver.disk().UV, solver.angles(np.full(len(solver.boundary), 2 * np.pi / len(solver.boundary)))]
    assert all(np.isfinite(uv).all() for uv in maps) and solver.factorisations == factorisations
