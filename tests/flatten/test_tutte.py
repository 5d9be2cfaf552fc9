"""Tutte's theorem: whatever the disk, no triangle is turned over."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.flatten.distortion import singular_values
from skinfab.flatten.tutte import tutte_embedding
from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(3, 120), st.sampled_from([0.0, 0.5, 50.0]))
def test_no_flips_on_random_disks(seed: int, count: int, noise: float) -> None:
    V, F = shapes.random_disk(seed, count, noise)
    assert (singular_values(V, F, tutte_embedding(V, F)) > 0).all()


@pytest.mark.parametrize("mesh", [shapes.grid(20, 1), shapes.helicoid(), shapes.cap(10, 3.0)], ids=["strip", "helicoid", "purse"])
def test_no_flips_on_hard_disks(mesh) -> None:
    V, F = mesh
    assert (singular_values(V, F, tutte_embedding(V, F)) > 0).all()


def test_inner_vertices_are_means_and_the_boundary_is_a_circle_of_the_disks_area() -> None:
    V, F = shapes.random_disk(1, 60)
    uv, topology = tutte_embedding(V, F), Topology(F)
    loop = topology.boundary_loops[0]
    np.testing.assert_allclose(np.pi * (uv[loop] ** 2).sum(axis=1), Mesh(V, F).area, rtol=1e-12)
    for v in np.setdiff1d(np.arange(len(V)), loop):
        ring = topology.E[(topology.E == v).any(axis=1)]
        np.testing.assert_allclose(uv[v], uv[ring[ring != v]].mean(axis=0), atol=1e-12)
    step = np.linalg.norm(V[np.roll(loop, -1)] - V[loop], axis=1)
    angle = np.unwrap(np.arctan2(*uv[loop].T[::-1]))
    np.testing.assert_allclose(np.diff(angle), 2 * np.pi * step[:-1] / step.sum(), rtol=1e-9)


def test_boundary_edges_without_length_stay_apart() -> None:
    V, F = shapes.wavy(5)
    loop = Topology(F).boundary_loops[0]
    V[loop[3]] = V[loop[4]]
    uv = tutte_embedding(V, F)
    turn = uv[F[:, 1:]] - uv[F[:, :1]]
    assert (np.linalg.det(turn) > 0).all()
