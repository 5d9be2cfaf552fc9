"""Cutting through cones: the study's cube with 8 and dodecahedron with 20 lie flat without distortion."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.flatten.distortion import best_scale, measure
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
        (Mesh(*shapes.sphere()), {"count": 1}, "a closed surface needs at least two cones"),
        (Mesh(np.vstack([shapes.wavy()[0]] * 2), np.vstack([shapes.wavy()[1], shapes.wavy()[1] + 169])), {}, "one connected surface"),
    ],
)
def test_what_cannot_be(mesh: Mesh, more, says: str) -> None:
    with pytest.raises(InputError, match=says):
        flatten_with_cones(mesh, **more)
