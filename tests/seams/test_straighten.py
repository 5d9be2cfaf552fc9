"""Zigzag seams become straight, and stay where others are not."""

import numpy as np
import shapes

from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces, seam_length
from skinfab.seams.straighten import straightened


def zigzag(mesh: Mesh, row: int, columns: int) -> np.ndarray:
    """Up and down between two rows of a grid."""
    path = [row * columns + 1]
    for k in range(2, columns - 1):
        path += [(row + k % 2) * columns + k - 1, (row + k % 2) * columns + k]
    path = [v for k, v in enumerate(path) if k == 0 or v != path[k - 1]]
    edges = mesh.topology.edge_ids(np.stack([path[:-1], path[1:]], axis=1))
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    cut[edges[edges >= 0]] = True
    return cut


def grid() -> Mesh:
    return Mesh(*shapes.grid(12, 12))


def test_shorter_between_the_same_ends() -> None:
    mesh = grid()
    columns = int(np.sqrt(len(mesh.V)))
    cut = zigzag(mesh, 5, columns)
    after = straightened(mesh, cut, mesh.edge_lengths, reach=0.2)
    degree = [np.bincount(mesh.topology.E[c].ravel(), minlength=len(mesh.V)) for c in (cut, after)]
    np.testing.assert_array_equal(degree[0] == 1, degree[1] == 1)
    assert seam_length(mesh, after) < 0.8 * seam_length(mesh, cut)


def test_no_farther_than_its_reach() -> None:
    mesh = grid()
    cut = zigzag(mesh, 5, int(np.sqrt(len(mesh.V))))
    after = straightened(mesh, cut, mesh.edge_lengths, reach=0.0)
    assert np.isin(mesh.topology.E[after], mesh.topology.E[cut]).all()


def test_fixed_edges_stay_and_others_end_on_them() -> None:
    mesh = grid()
    cut = zigzag(mesh, 5, int(np.sqrt(len(mesh.V))))
    np.testing.assert_array_equal(straightened(mesh, cut, mesh.edge_lengths, reach=1.0, fixed=cut), cut)


def test_a_tree_stays_a_tree() -> None:
    """Runs keep clear of each other: what was one disk is one."""
    V, F = shapes.sphere(3)
    mesh = Mesh(V, F)
    rng = np.random.default_rng(2)
    near: dict[int, list[int]] = {}
    for a, b in mesh.topology.E.tolist():
        near.setdefault(a, []).append(b)
        near.setdefault(b, []).append(a)
    reached, cut = [0], np.zeros(len(mesh.topology.E), dtype=bool)
    while len(reached) < 160:  # a random tree of edges
        a = reached[int(rng.integers(max(len(reached) - 12, 0), len(reached)))]
        b = near[a][int(rng.integers(len(near[a])))]
        if b not in reached:
            reached.append(b)
            cut[mesh.topology.edge_ids(np.array([[a, b]]))] = True
    (before,) = open_pieces(mesh, cut)
    after = straightened(mesh, cut, mesh.edge_lengths, reach=0.3)
    (piece,) = open_pieces(mesh, after)
    assert before.is_disk and piece.is_disk and seam_length(mesh, after) <= seam_length(mesh, cut)
    np.testing.assert_array_equal(straightened(mesh, cut, mesh.edge_lengths, reach=0.3), after)
