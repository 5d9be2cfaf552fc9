"""Cutting through cones: the study's cube with 8 and dodecahedron with 20 lie flat without distortion."""

from pathlib import Path

import numpy as np
import pytest
import shapes

from skinfab.cli.main import main
from skinfab.errors import InputError
from skinfab.flatten.cones import cone_scale
from skinfab.flatten.distortion import best_scale, measure
from skinfab.flatten.laplacian import intrinsic
from skinfab.mesh.model import Mesh
from skinfab.seams.cones import cut_through, flatten_with_cones
from skinfab.seams.cut import open_pieces, seam_length


@pytest.mark.parametrize(("name", "count", "edges"), [("cube", 8, 7), ("dodecahedron", 20, 19)])
@pytest.mark.parametrize("automatic", [False, True])
def test_polyhedra_at_d_4(name: str, count: int, edges: int, automatic: bool) -> None:
    mesh = shapes.object_mesh(name)
    cut, piece, UV, cones = flatten_with_cones(mesh, count=None if automatic else count)
    assert len(cones) == count and piece.is_disk
    assert measure(mesh.V[piece.vertices], piece.F, UV).mean == pytest.approx(4, abs=1e-9)
    assert seam_length(mesh, cut) == pytest.approx(edges * 40 if name == "cube" else seam_length(mesh, cut))
    assert np.isin(cones, mesh.topology.E[cut]).all()


def spindle(sides: int = 6, height: float = 1.3):
    """Two pyramids over one regular polygon, base to base: a double cone."""
    a = 2 * np.pi * np.arange(sides) / sides
    V = np.vstack([np.column_stack([np.cos(a), np.sin(a), 0 * a]), [[0, 0, height], [0, 0, -height]]])
    k = np.arange(sides)
    up = np.column_stack([k, (k + 1) % sides, np.full(sides, sides)])
    return V, np.vstack([up, up[:, [1, 0, 2]] + [0, 0, 1]])


def spindle_angles(sides: int = 6, height: float = 1.3) -> np.ndarray:
    """Closed form: the tip angle of a side is 2 arcsin of half a base edge over a slanted one."""
    tip = 2 * np.arcsin(np.sin(np.pi / sides) / np.hypot(1, height))
    return np.r_[np.full(sides, 4 * (np.pi - tip) / 2), sides * tip, sides * tip]


def octahedron():
    V = np.vstack([np.eye(3), -np.eye(3)])
    return V, np.array([[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]])


def tetrahedron():
    return np.array([[0.0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]]), np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])


def layout_angles(mesh: Mesh, piece, UV: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """The corners about each vertex, added up in the flat layout."""
    corners = intrinsic(np.column_stack([UV, np.zeros(len(UV))]), piece.F).angle
    return np.bincount(piece.vertices[piece.F].ravel(), corners.ravel(), len(mesh.V))[vertices]


@pytest.mark.parametrize(
    ("surface", "degrees"),
    [
        (shapes.cube(3), 270.0),
        (tetrahedron(), 180.0),
        (octahedron(), 240.0),
        (spindle(), np.degrees(spindle_angles())),
    ],
    ids=["cube", "tetrahedron", "octahedron", "double cone"],
)
def test_polyhedra_by_their_corners_angles_at_d_4(surface, degrees) -> None:
    V, F = surface
    corners = np.flatnonzero(np.isin(V, [0, 1]).all(axis=1)) if len(V) == 56 else np.arange(len(V))
    angles = np.radians(np.broadcast_to(degrees, len(corners)))
    mesh = Mesh(V, F)
    _, piece, UV, cones = flatten_with_cones(mesh, cones=corners, angles=angles)
    assert (cones == corners).all() and measure(mesh.V[piece.vertices], piece.F, UV).mean == pytest.approx(4, abs=1e-9)
    np.testing.assert_allclose(layout_angles(mesh, piece, UV, corners), angles, atol=1e-9)


@pytest.mark.parametrize(
    ("surface", "degrees"),
    [
        (shapes.sphere(3), (200.0, 250, 270, 280, 300, 320, 310, 230)),
        (shapes.torus(), (250.0, 350, 400, 440)),
        (shapes.cap(12, 2.0), (300.0, 280)),
    ],
    ids=["sphere", "torus", "open cap"],
)
def test_the_layout_has_the_angles_given(surface, degrees: tuple[float, ...]) -> None:
    """None of them those that cones without angles get."""
    mesh = Mesh(*surface)
    inner = np.setdiff1d(np.arange(len(mesh.V)), mesh.topology.E[mesh.topology.is_boundary])
    cones = inner[np.linspace(0, len(inner) - 1, len(degrees)).astype(int)]
    _, piece, UV, _ = flatten_with_cones(mesh, cones=cones, angles=np.radians(degrees))
    np.testing.assert_allclose(np.degrees(layout_angles(mesh, piece, UV, cones)), degrees, atol=1e-6)
    _, free = cone_scale(mesh.V, mesh.F, cones)
    assert np.abs(np.degrees(2 * np.pi - free) - degrees).max() > 5


def test_a_flat_angle_is_no_cone() -> None:
    V, F = shapes.cylinder_sheet()
    u, curvature = cone_scale(V, F, np.array([60]), np.array([2 * np.pi]))
    assert np.abs(u).max() < 1e-9 and abs(curvature[0]) < 1e-9


@pytest.mark.parametrize("unit", [1e-6, 1e6])
def test_unit_changes_no_prescribed_cone(unit: float) -> None:
    V, F = shapes.sphere()
    cones, angles = np.arange(8), np.full(8, 1.5 * np.pi)
    np.testing.assert_allclose(cone_scale(unit * V, F, cones, angles)[0], cone_scale(V, F, cones, angles)[0], atol=1e-9)


def test_smooth_closed_surfaces_get_better_with_cones() -> None:
    mesh = Mesh(*shapes.sphere(2))
    d = []
    for count in (6, 12, 32):
        _, piece, UV, _ = flatten_with_cones(mesh, count=count)
        assert best_scale(mesh.V[piece.vertices], piece.F, UV) == pytest.approx(1)
        d.append(measure(mesh.V[piece.vertices], piece.F, UV).mean)
    assert d[0] > d[1] > d[2] and d[2] < 4.05


@pytest.mark.parametrize(
    "surface", [shapes.sphere(), shapes.torus(), shapes.holed(), shapes.wavy()], ids=["sphere", "torus", "holes", "disk"]
)
def test_cut_passes_every_point_and_opens_to_a_disk(surface) -> None:
    mesh = Mesh(*surface)
    points = np.random.default_rng(1).choice(len(mesh.V), 6, replace=False)
    (piece,) = open_pieces(mesh, cut_through(mesh, points))
    assert piece.is_disk
    assert np.isin(points, piece.vertices[piece.topology.boundary_loops[0]]).all()


def test_points_are_joined_at_little_cost() -> None:
    """Corners of a flat square grid: no more than the square's own spanning tree."""
    mesh = Mesh(*shapes.grid(10, 10))
    inner = np.array([36, 40, 80, 84])  # (3, 3), (7, 3), (3, 7), (7, 7)
    assert seam_length(mesh, cut_through(mesh, inner)) == pytest.approx(4 * 0.3)  # each to the border, three cells away


def test_the_nearest_point_is_joined_first() -> None:
    """The farther one then has the shorter way, to the nearer one's seam."""
    mesh = Mesh(*shapes.grid(10, 10))
    three_and_four_cells_from_the_border = np.array([61, 58])  # (6, 5) and (3, 5)
    assert seam_length(mesh, cut_through(mesh, three_and_four_cells_from_the_border)) == pytest.approx(0.6)


@pytest.mark.parametrize(
    ("mesh", "more", "says"),
    [
        (Mesh(*shapes.sphere()), {"cones": np.array([3, 999])}, "cone vertex 999 does not exist; the mesh has vertices 0 to 161"),
        (Mesh(*shapes.sphere()), {"cones": np.array([-1, 3])}, "cone vertex -1 does not exist"),
        (Mesh(*shapes.sphere()), {"cones": np.array([3, 7, 11, 7])}, "cone vertex 7 is given 2 times; give every cone once"),
        (Mesh(*shapes.sphere()), {"cones": np.array([1.5, 7.2])}, "an array .* of whole numbers; this is float64"),
        (Mesh(*shapes.sphere()), {"cones": np.array([[1, 2]])}, r"of the shape \(1, 2\)"),
        (Mesh(*shapes.cap(6)), {"cones": np.array([0, 126])}, "cone vertex 126 lies on the boundary"),
        (
            Mesh(*shapes.sphere()),
            {"cones": np.arange(8), "angles": np.radians(np.full(8, 260.0))},
            r"sum to 2080 degrees; 8 cones .* Euler number 2 must sum to 2160 \(Gauss-Bonnet\), so change them by \+80 together",
        ),
        (Mesh(*shapes.torus()), {"cones": np.arange(2), "angles": np.radians([300.0, 300])}, "must sum to 720"),
        (
            Mesh(*shapes.sphere()),
            {"cones": np.arange(2), "angles": np.array([1.0, 1])},
            "2 cones cannot take the curvature .* give 3 or more",
        ),
        (Mesh(*shapes.sphere()), {"cones": np.arange(3), "angles": np.radians([180.0, 0, 180])}, "cone angle 1 is 0 degrees"),
        (Mesh(*shapes.sphere()), {"cones": np.arange(3), "angles": np.array([1.0, 2, np.nan])}, "cone angle 2 is nan degrees"),
        (Mesh(*shapes.sphere()), {"cones": np.arange(3), "angles": np.ones(2)}, r"one number for each of the 3 cones; .* \(2,\)"),
        (Mesh(*shapes.sphere()), {"angles": np.ones(2)}, "say which vertices they belong to"),
        (Mesh(*shapes.sphere()), {"count": 1}, "a closed surface needs at least two cones"),
        (Mesh(np.vstack([shapes.wavy()[0]] * 2), np.vstack([shapes.wavy()[1], shapes.wavy()[1] + 169])), {}, "one connected surface"),
    ],
)
def test_what_cannot_be(mesh: Mesh, more, says: str) -> None:
    with pytest.raises(InputError, match=says):
        flatten_with_cones(mesh, **more)


def written(folder: Path, V: np.ndarray, F: np.ndarray) -> str:
    lines = ["v {:.17g} {:.17g} {:.17g}".format(*v) for v in V.tolist()] + ["f {} {} {}".format(*f) for f in (F + 1).tolist()]
    (folder / "mesh.obj").write_text("\n".join(lines) + "\n")
    return str(folder / "mesh.obj")


@pytest.mark.parametrize(
    ("cones", "status", "says"),
    [
        ("0:240,1:240,2:240,3:240,4:240,5:240", 0, "d mean 4.0000"),
        ("0:240,1:240,2:240,3:240,4:240,5:250", 1, "sum to 1450 degrees; 6 cones on a closed surface of Euler number 2 must sum to 1440"),
        ("0:240,1:240,2,3", 1, "2 of 4 cones have an angle; give all of them one, or none"),
        ("0:x", 2, "such as 0,5,17 or 0:270,5:180"),
        ("0:", 2, "neither auto, nor a number"),
    ],
)
def test_angles_on_the_command_line_are_degrees(
    cones: str, status: int, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    V, F = octahedron()
    words = ["flatten", written(tmp_path, 30 * V, F), "-o", str(tmp_path / "o.obj"), "--method", "bff-cones", "--cones", cones]
    assert main(words) == status
    captured = capsys.readouterr()
    assert says in captured.out + captured.err and (tmp_path / "o.obj").exists() == (status == 0)


def test_a_net_that_covers_itself_is_refused_with_what_cones_are_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    V, F = shapes.torus()
    _, piece, UV, _ = flatten_with_cones(Mesh(V, F), count=40)
    assert measure(V[piece.vertices], piece.F, UV).overlap_mm2 > 0.01
    assert main(["flatten", written(tmp_path, 30 * V, F), "-o", str(tmp_path / "o.obj"), "--method", "bff-cones", "--cones", "40"]) == 3
    says = capsys.readouterr().err
    assert "with 40 cones the surface covers" in says and "near-polyhedra and plain round bodies, so use --method auto" in says
    assert not (tmp_path / "o.obj").exists()
