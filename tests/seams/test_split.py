"""The cheapest seam between two places, against trying them all."""

from itertools import product

import numpy as np
import pytest
import shapely
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.flatten.disk import flatten_isometric
from skinfab.mesh.model import Mesh
from skinfab.seams import split as module
from skinfab.seams.cut import open_pieces
from skinfab.seams.split import farthest_faces, overlapping_faces, split


def whole(mesh: Mesh):
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    return piece


def face_distances(mesh: Mesh, face: int) -> np.ndarray:
    """From face centre to face centre, Bellman-Ford."""
    centre, EF = mesh.V[mesh.F].mean(axis=1), mesh.topology.EF
    far = np.full(len(mesh.F), np.inf)
    far[face] = 0
    for _ in mesh.F:
        for f, g in EF[EF[:, 1] >= 0].tolist():
            step = np.linalg.norm(centre[f] - centre[g])
            far[f], far[g] = min(far[f], far[g] + step), min(far[g], far[f] + step)
    return far


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000))
def test_as_cheap_as_the_best_of_all(seed: int) -> None:
    mesh = Mesh(*shapes.grid(6, 2, lambda s, t: np.stack([6 * s, 2 * t, 0 * s], axis=1)))
    weight = np.random.default_rng(seed).uniform(0.1, 1, len(mesh.topology.E))
    ends = 0, len(mesh.F) - 1
    a, b = (face_distances(mesh, f) for f in ends)
    share = a / (a + b)
    free = np.flatnonzero((share >= module._CORE) & (share <= 1 - module._CORE))
    assert 4 <= len(free) <= 14
    EF, inner = mesh.topology.EF, mesh.topology.EF[:, 1] >= 0
    best = np.inf
    for choice in product([False, True], repeat=len(free)):
        side = share > 1 - module._CORE
        side[free] = choice
        best = min(best, weight[inner & (side[EF[:, 0]] != side[EF[:, 1]])].sum())
    got = split(mesh, whole(mesh), ends, weight)
    assert weight[got].sum() == pytest.approx(best, rel=1e-6)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000))
def test_a_strip_is_cut_at_its_cheapest_rung(seed: int) -> None:
    mesh = Mesh(*shapes.grid(12, 1, lambda s, t: np.stack([12 * s, t, 0 * s], axis=1)))
    weight = np.random.default_rng(seed).uniform(0.1, 1, len(mesh.topology.E))
    a, b = face_distances(mesh, 0), face_distances(mesh, len(mesh.F) - 1)
    middle = (a / (a + b) >= module._CORE) & (a / (a + b) <= 1 - module._CORE)
    EF = mesh.topology.EF
    rungs = np.flatnonzero((EF[:, 1] >= 0) & (middle[EF[:, 0]] | middle[EF[:, 1]]))  # not inside either core
    (got,) = split(mesh, whole(mesh), (0, len(mesh.F) - 1), weight)
    assert got == rungs[np.argmin(weight[rungs])]


def test_dumbbells_come_apart_at_the_neck() -> None:
    gone = [(i, j) for i in range(8, 14) for j in (0, 1, 2, 5, 6, 7)]
    V, F = shapes.grid(22, 8)
    cell = [2 * (j * 22 + i) + k for i, j in gone for k in (0, 1)]
    used, F = np.unique(np.delete(F, cell, axis=0), return_inverse=True)
    mesh = Mesh((V * [22, 8, 1])[used], F.reshape(-1, 3))
    piece = whole(mesh)
    seam = split(mesh, piece, farthest_faces(piece, mesh.V[piece.vertices][:, :2]), mesh.edge_lengths)
    x = mesh.V[mesh.topology.E[seam]][:, :, 0]
    assert mesh.edge_lengths[seam].sum() == pytest.approx(2) and x.min() >= 8 and x.max() <= 14


@pytest.mark.parametrize("mesh", [Mesh(*shapes.wavy()), Mesh(*shapes.cap()), Mesh(*shapes.helicoid())], ids=["wavy", "cap", "helicoid"])
def test_two_parts_with_an_end_in_each(mesh: Mesh) -> None:
    piece = whole(mesh)
    ends = farthest_faces(piece, flatten_isometric(mesh.V[piece.vertices], piece.F))
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    cut[split(mesh, piece, ends, mesh.edge_lengths)] = True
    parts = [set(p.faces.tolist()) for p in open_pieces(mesh, cut)]
    assert len(parts) == 2 and sum(ends[0] in p for p in parts) == 1 and (ends[0] in parts[0]) != (ends[1] in parts[0])


def test_farthest_faces_are_two() -> None:
    """Two faces whose centres lie above each other are told apart all the same."""
    mesh = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [2, 0.5, 0], [1, 1, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
    centres = mesh.V[mesh.F].mean(axis=1)
    assert centres[0, 0] == centres[1, 0]
    piece = whole(mesh)
    assert set(farthest_faces(piece, mesh.V[piece.vertices][:, :2])) == {0, 1}


def test_overlapping_faces_lie_on_each_other() -> None:
    mesh = Mesh(*shapes.helicoid())
    piece = whole(mesh)
    UV = flatten_isometric(mesh.V[piece.vertices], piece.F)
    one, two = (shapely.Polygon(UV[piece.F[f]]) for f in overlapping_faces(mesh, piece, UV))
    assert one.intersection(two).area > 0.01 * min(one.area, two.area)
    flat = Mesh(*shapes.grid(6, 6))
    piece = whole(flat)
    UV = flat.V[piece.vertices][:, :2]
    assert overlapping_faces(flat, piece, UV) == farthest_faces(piece, UV)
