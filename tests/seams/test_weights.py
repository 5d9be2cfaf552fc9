"""What a seam costs: folds of known angle."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.mesh.model import Mesh
from skinfab.seams.weights import dihedral_angles, seam_weights


def folded(angle: float):
    """A square folded along its middle by `angle`."""

    def place(s, t):
        out = np.maximum(s - 0.5, 0)
        return np.stack([np.minimum(s, 0.5) + out * np.cos(angle), t, out * np.sin(angle)], axis=1)

    return Mesh(*shapes.grid(2, 2, place))


@settings(max_examples=40, deadline=None)
@given(st.floats(-3.1, 3.1))
def test_folds_have_their_angle_and_only_they(angle: float) -> None:
    mesh = folded(angle)
    fold = (np.abs(mesh.V[mesh.topology.E][:, :, 0] - 0.5) < 1e-12).all(axis=1) & (mesh.V[mesh.topology.E][:, :, 2] == 0).all(axis=1)
    fold &= ~mesh.topology.is_boundary
    np.testing.assert_allclose(dihedral_angles(mesh)[fold], abs(angle), atol=1e-12)
    np.testing.assert_allclose(dihedral_angles(mesh)[~fold], 0, atol=1e-12)


def test_creases_cost_less_down_to_four_tenths() -> None:
    for angle, share in ((0.0, 1.0), (np.pi / 8, 0.7), (np.pi / 4, 0.4), (2.0, 0.4)):
        mesh = folded(angle)
        weight, length = seam_weights(mesh), mesh.edge_lengths
        assert (weight / length).min() == pytest.approx(share, rel=1e-6)
        assert (weight / length).max() == pytest.approx(1, rel=1e-6)


def test_edges_without_length_still_cost_something() -> None:
    V, F = shapes.wavy(4)
    V[12] = V[13]
    assert (seam_weights(Mesh(V, F)) > 0).all()
