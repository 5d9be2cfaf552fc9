"""What a brush covers hangs together."""

import numpy as np
import shapes

from skinfab.mesh.brush import faces_within
from skinfab.mesh.model import Mesh


def test_a_disk_of_a_plane_is_covered_whole():
    V, F = shapes.grid(40, 40)
    mesh = Mesh(100 * V, F)
    middles = mesh.V[mesh.F].mean(axis=1)
    face = int(np.argmin(np.linalg.norm(middles - [50, 50, 0], axis=1)))
    covered = faces_within(mesh, face, [50, 50, 0], 20.0)
    assert np.array_equal(covered, np.flatnonzero(np.linalg.norm(middles - [50, 50, 0], axis=1) <= 20))


def test_the_far_side_of_a_thin_wall_is_left_alone():
    V, F = shapes.grid(40, 4)
    folded = 100 * V
    far = folded[:, 0] > 50
    folded[far] = np.column_stack([100 - folded[far, 0], folded[far, 1], np.full(far.sum(), 1.0)])
    mesh = Mesh(folded, F)
    covered = faces_within(mesh, 0, mesh.V[F[0]].mean(axis=0), 15.0)
    assert len(covered) and mesh.V[F[covered]][..., 2].max() == 0.0


def test_the_face_itself_is_always_covered():
    V, F = shapes.cube(1)
    assert faces_within(Mesh(V, F), 5, [99.0, 0, 0], 0.1).tolist() == [5]
