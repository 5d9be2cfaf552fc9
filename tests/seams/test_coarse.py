"""Seams found on a small mesh and taken to the fine one."""

import numpy as np
import shapes

from skinfab.mesh.model import Mesh
from skinfab.seams.coarse import coarsen, transfer
from skinfab.seams.creases import crease_seams
from skinfab.seams.cut import open_pieces, seam_length
from skinfab.seams.weights import dihedral_angles


def test_coarse_meshes_keep_the_topology() -> None:
    for V, F in (shapes.sphere(4), shapes.torus(columns=90, rows=40), shapes.wavy(50)):
        fine = Mesh(V, F)
        small = coarsen(fine, 600)
        assert abs(len(small.F) - 600) < 20
        assert small.topology.euler == fine.topology.euler
        assert len(small.topology.boundary_loops) == len(fine.topology.boundary_loops)
        assert len(small.topology.used_vertices) == len(small.V) and not small.topology.is_nonmanifold.any()
        assert abs(small.area / fine.area - 1) < 0.02


def test_small_meshes_are_left_alone() -> None:
    mesh = Mesh(*shapes.wavy())
    assert coarsen(mesh, len(mesh.F)) is mesh


def test_cylinder_keeps_its_three_pieces() -> None:
    fine = shapes.object_mesh("cylinder")
    small = coarsen(fine, 1000)
    seams = crease_seams(small)
    assert len(open_pieces(small, seams)) == 3
    moved = transfer(small, seams, fine)
    pieces = open_pieces(fine, moved)
    assert len(pieces) == 3
    assert abs(seam_length(fine, moved) / seam_length(small, seams) - 1) < 0.02
    # The rims themselves: nothing cheaper lies beside a crease.
    assert (moved <= crease_seams(fine)).all()


def test_onto_itself_nothing_moves_where_edges_are_shortest() -> None:
    mesh = Mesh(*shapes.grid(10, 10))
    cut = np.random.default_rng(0).random(len(mesh.topology.E)) < 0.1
    np.testing.assert_array_equal(transfer(mesh, cut, mesh), cut & ~mesh.topology.is_boundary)


def test_seams_beside_creases_snap_to_them() -> None:
    """A coarse edge across a cube's side becomes the cheaper way along its edges."""
    small, fine = Mesh(*shapes.cube(1)), Mesh(*shapes.cube(4))
    diagonal = np.flatnonzero(small.edge_lengths > 1.4)[:1]
    moved = transfer(small, np.isin(np.arange(len(small.topology.E)), diagonal), fine)
    np.testing.assert_allclose(dihedral_angles(fine)[moved], np.pi / 2)
    assert fine.edge_lengths[moved].sum() == 2
