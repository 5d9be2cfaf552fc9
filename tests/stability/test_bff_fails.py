"""Where BFF's target shapes and cones fail: the plain method is shown to, then what is done instead."""

from pathlib import Path

import numpy as np
import pytest
import shapes

from skinfab.cli.main import main
from skinfab.errors import InputError, RefusedError
from skinfab.flatten.bff import BffSolver, flatten_disk
from skinfab.flatten.bff_curve import scaled_lengths, turning_of
from skinfab.flatten.bff_descent import conformal_energy
from skinfab.flatten.cones import cone_scale, place_cones
from skinfab.flatten.distortion import measure, singular_values
from skinfab.mesh.io import load_mesh
from skinfab.mesh.model import Mesh
from skinfab.seams.cones import cut_through, flatten_with_cones
from skinfab.seams.cut import open_pieces


def along(curve: np.ndarray, length: np.ndarray) -> np.ndarray:
    closed = np.vstack([curve, curve[:1]])
    way = np.r_[0, np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))]
    at = np.r_[0, np.cumsum(length)[:-1]] * (way[-1] / length.sum())
    return np.column_stack([np.interp(at, way, closed[:, k]) for k in (0, 1)])


def plain_rounds(solver: BffSolver, target: np.ndarray, rounds: int = 30) -> tuple[np.ndarray, float]:
    """The iteration as published: the round that moved least, and how far it moved as a fraction of the size."""
    points = best = along(target, solver.lengths_mm)
    least = np.inf
    for _ in range(rounds):
        before, points = points, along(target, scaled_lengths(solver.lengths_mm, solver.scale_of(turning_of(points))))
        moved = np.abs(points - before).max()
        if moved < least:
            best, least = points, moved
    return best, least / np.linalg.norm(np.ptp(target, axis=0))


def egg(rings: int):
    V, F = shapes.cap(rings)
    x, y, z = V.T
    return np.column_stack([1.4 * x + 0.2 * x * y, y, z + 0.15 * np.sin(3 * x + y)]), F


def star(points: int = 720) -> np.ndarray:
    a = 2 * np.pi * np.arange(points) / points
    r = 2 + 0.6 * np.cos(5 * a)
    return np.column_stack([r * np.cos(a), r * np.sin(a)])


RECTANGLE = np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]])
ANGLE = np.array([[0.0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]])


def energy_of(solver: BffSolver, points: np.ndarray) -> float:
    energy, _, area = conformal_energy(points, solver._slope)
    return energy / area


@pytest.mark.parametrize(
    ("mesh", "target", "flips", "better"),
    [
        (shapes.wavy(20), star(), True, 2.0),
        (egg(24), star(), True, 2.0),
        (egg(24), RECTANGLE, False, 1.2),
    ],
    ids=["square in a star", "egg in a star", "egg in a rectangle"],
)
def test_rounds_that_do_not_settle(mesh, target: np.ndarray, flips: bool, better: float) -> None:
    """To and fro for ever; the boundary slid along to the least conformal energy lays every triangle the right way up."""
    V, F = mesh
    solver = BffSolver(V, F)
    plain, moved = plain_rounds(solver, target)
    assert moved > 1e-7
    assert (singular_values(V, F, solver._extended(plain))[:, 1] <= 0).any() == flips
    laid = solver.curve(target)
    uv = laid.UV
    assert (singular_values(laid.V, laid.F, uv)[:, 1] > 0).all()
    assert better * energy_of(solver, uv[solver.boundary]) < energy_of(solver, plain)
    closed = np.vstack([target, target[:1]])
    a, d = closed[:-1], np.diff(closed, axis=0)
    off = uv[solver.boundary][:, None] - a
    t = np.clip((off * d).sum(axis=2) / (d**2).sum(axis=1), 0, 1)
    assert np.linalg.norm(off - t[:, :, None] * d, axis=2).min(axis=1).max() < 1e-9


@pytest.mark.parametrize(("mesh", "target"), [(egg(24), ANGLE), (shapes.cylinder_sheet(48, 20), ANGLE)])
def test_a_corner_that_turns_inwards_is_refused(mesh, target: np.ndarray) -> None:
    V, F = mesh
    solver = BffSolver(V, F)
    assert (singular_values(V, F, solver._extended(plain_rounds(solver, target)[0]))[:, 1] < 0).sum() > 100
    with pytest.raises(RefusedError, match=r"\d+ of \d+ triangles come out upside down inside the target curve; give a rounder shape"):
        solver.curve(target)


def test_a_triangle_with_three_boundary_vertices_on_a_straight_side_is_halved_inwards() -> None:
    V, F = shapes.wavy(20)
    solver = BffSolver(V, F)
    laid = solver.curve(RECTANGLE)
    flat = solver._extended(laid.UV[solver.boundary])
    assert (np.abs(singular_values(V, F, flat)[:, 1]) < 1e-9).any()
    assert len(laid.chords) == 2 and (singular_values(laid.V, laid.F, laid.UV)[:, 1] > 1e-3).all()


def test_a_boundary_vertex_that_hangs_on_nothing_is_named() -> None:
    """Across from it its only triangle has an edge without length, with right angles at both ends: their cotangents are zero."""
    V, F = shapes.grid(4, 4)
    V[9] = V[3]  # the corner 4 has the one triangle 3, 4, 9
    solver = BffSolver(V, F)
    assert np.isfinite(solver.free()).all()
    for call in (solver.disk, lambda: solver.curve(star())):
        with pytest.raises(InputError, match="boundary vertex 4 hangs on triangles without area"):
            call()


def test_negative_cotangents_turn_triangles_of_the_disk_over() -> None:
    V, F = shapes.random_disk(5, 100, 1.0)
    solver = BffSolver(V, F)
    with pytest.raises(RefusedError, match="upside down inside the disk"):
        solver.disk()


def crumpled(noise: float = 0.3) -> Mesh:
    """A closed ball whose vertices are off by up to a few edge lengths: obtuse triangles and spikes all over."""
    V, F = shapes.sphere(3)
    return Mesh(V * (1 + noise * np.random.default_rng(0).standard_normal((len(V), 1))), F)


def test_cones_on_a_crumpled_ball_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What the reference tool writes as a success: 8 cones, and triangles upside down."""
    mesh = crumpled()
    cones = place_cones(mesh.V, mesh.F, count=8)
    (piece,) = open_pieces(mesh, cut_through(mesh, cones))
    u, _ = cone_scale(mesh.V, mesh.F, cones)
    plain = flatten_disk(mesh.V[piece.vertices], piece.F, scale=u[piece.vertices])
    assert np.isfinite(plain).all() and measure(mesh.V[piece.vertices], piece.F, plain).flipped > 10
    with pytest.raises(RefusedError, match=r"\d+ of 1280 triangles come out upside down or without area with 8 cones"):
        flatten_with_cones(mesh, count=8)
    lines = ["v {:.17g} {:.17g} {:.17g}".format(*v) for v in (30 * mesh.V).tolist()] + [
        "f {} {} {}".format(*f) for f in (mesh.F + 1).tolist()
    ]
    (tmp_path / "ball.obj").write_text("\n".join(lines) + "\n")
    words = ["flatten", str(tmp_path / "ball.obj"), "-o", str(tmp_path / "o.obj"), "--method", "bff-cones", "--cones", "8"]
    assert main(words) == 3
    assert "triangles come out upside down or without area with 8 cones; cones suit near-polyhedra and plain" in capsys.readouterr().err
    assert not (tmp_path / "o.obj").exists()


def test_a_vertex_that_is_no_number_ends_no_cone_in_a_hang() -> None:
    """No path leads to it, so joining it to the seam never ended."""
    V, F = shapes.sphere(3)
    V[5] = np.nan
    mesh = Mesh(V, F)
    calls = [
        lambda: place_cones(V, F, count=8),
        lambda: cone_scale(V, F, np.array([0, 1])),
        lambda: flatten_with_cones(mesh, count=8),
        lambda: flatten_with_cones(mesh, cones=np.array([5, 9, 70])),
    ]
    for call in calls:
        with pytest.raises(InputError, match="vertex 5 has a coordinate that is not a finite number"):
            call()
    with pytest.raises(InputError, match="no seam leads to vertex 5 along edges of finite length"):
        cut_through(mesh, np.array([9, 5, 70]))


SHARED = Path(__file__).resolve().parents[2].parent / "shared" / "meshes"


@pytest.mark.parametrize("name", ["softhand_fingertip.stl", "webxr_hand_left.stl"])
def test_eight_cones_that_flip_real_objects_are_refused_and_more_do_not_flip(name: str) -> None:
    if not (SHARED / name).exists():
        pytest.skip(f"needs ../shared/meshes/{name}")
    mesh = load_mesh(SHARED / name, units="mm").mesh
    with pytest.raises(RefusedError, match="come out upside down or without area with 8 cones"):
        flatten_with_cones(mesh, count=8)
    _, piece, uv, _ = flatten_with_cones(mesh)
    assert measure(mesh.V[piece.vertices], piece.F, uv).flipped == 0
