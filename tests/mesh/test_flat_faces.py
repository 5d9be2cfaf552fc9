"""Faces without area go, the surface stays where it was."""

import runpy
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from skinfab.mesh.fans import relative_heights
from skinfab.mesh.flat_faces import merge_flat_faces
from skinfab.mesh.model import Mesh
from skinfab.tolerances import DEGENERATE_HEIGHT

SHAPES = runpy.run_path(str(Path(__file__).parents[1] / "stability" / "broken_meshes.py"))


@given(st.lists(st.integers(0, 199), max_size=6, unique=True), st.booleans())
def test_flat_faces_put_into_a_sheet_are_taken_out(where: list[int], on_border: bool) -> None:
    """Split an edge in its middle on one side only: the other side keeps a flat face between."""
    V, F = (list(x) for x in SHAPES["grid"]())
    V = [[x, y, 0.0] for x, y, _ in V]
    top = Mesh(np.array(V), np.array(F)).topology
    used: set[int] = set()
    for f in where:
        across = int(top.EF[top.FE[f, 0]][top.EF[top.FE[f, 0]] != f][0])
        if used & {f, across} or (across < 0 and not on_border):
            continue
        used |= {f, across}
        a, b, c = F[f]
        m = len(V)
        V.append(((np.array(V[a]) + V[b]) / 2).tolist())
        F[f] = [a, m, c]
        F += [[m, b, c], [a, b, m]]
    before = Mesh(np.array(V), np.array(F))
    F2, merged = merge_flat_faces(before.V, before.F)
    after = Mesh(before.V, F2)
    assert merged == sum(1 for f in range(len(F)) if relative_heights(before.V, before.F[f : f + 1])[0] <= DEGENERATE_HEIGHT)
    assert relative_heights(after.V, after.F).min() > DEGENERATE_HEIGHT
    np.testing.assert_allclose(after.area, 2500.0, rtol=1e-12)
    assert after.topology.euler == 1 and after.topology.edge_count.max() == 2


def test_a_side_of_no_length_is_contracted() -> None:
    V, F = SHAPES["sphere"]()
    V[40] = V[41]
    mesh = Mesh(np.array(V), np.array(F))
    F2, merged = merge_flat_faces(mesh.V, mesh.F)
    after = Mesh(mesh.V, F2)
    assert merged == 1 and len(F2) == len(F) - 2
    assert after.topology.euler == 2 and (after.topology.edge_count == 2).all()
    np.testing.assert_allclose(after.area, mesh.area, rtol=1e-12)
    assert relative_heights(after.V, F2).min() > DEGENERATE_HEIGHT


def test_a_mesh_of_flat_faces_is_left_alone() -> None:
    V = np.column_stack([np.arange(5.0), np.zeros(5), np.zeros(5)])
    F = np.array([[0, 1, 2], [1, 2, 3], [2, 3, 4]])
    out, merged = merge_flat_faces(V, F)
    assert merged == 0 and out is F
