"""The Laplacian held by its edges against the same matrix written out."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.flatten.graph_laplacian import GraphLaplacian
from skinfab.linalg import Cholesky, LowerTriangle


def random_graph(seed: int, n: int) -> tuple[GraphLaplacian, np.ndarray]:
    """A graph with some edges, and its matrix summed entry by entry."""
    rng = np.random.default_rng(seed)
    E = np.argwhere(np.triu(rng.random((n, n)) < 0.4, 1))
    L = GraphLaplacian(E, rng.standard_normal(len(E)), n)
    dense = np.zeros((n, n))
    for (i, j), w in zip(E, L.weight, strict=True):
        dense[i, i] += w
        dense[j, j] += w
        dense[i, j] -= w
        dense[j, i] -= w
    return L, dense


@given(st.integers(0, 10_000), st.integers(1, 12))
def test_products_and_blocks_are_those_of_the_matrix(seed: int, n: int) -> None:
    L, dense = random_graph(seed, n)
    rng = np.random.default_rng(seed + 1)
    x, keep = rng.standard_normal((n, 2)), rng.random(n) < 0.6
    np.testing.assert_allclose(L @ x, dense @ x, atol=1e-12)
    np.testing.assert_allclose(L @ x[:, 0], dense @ x[:, 0], atol=1e-12)
    np.testing.assert_allclose(L.to_sparse().toarray(), dense, atol=1e-12)
    block = L.block(keep)
    lower = np.zeros((block.n, block.n))
    lower[block.rows, block.columns] = block.data
    np.testing.assert_allclose(lower, np.tril(dense[np.ix_(keep, keep)]), atol=1e-12)


@given(st.integers(0, 10_000), st.integers(2, 12))
def test_edges_about_vertices_do_for_what_begins_or_ends_there(seed: int, n: int) -> None:
    L, dense = random_graph(seed, n)
    some = np.arange(n // 2)
    near = L.about(some)
    x = np.random.default_rng(seed).standard_normal(n)
    np.testing.assert_allclose((near @ x)[some], (dense @ x)[some], atol=1e-12)
    x[n // 2 :] = 0
    np.testing.assert_allclose(near @ x, dense @ x, atol=1e-12)


@pytest.mark.parametrize("n", [2, 3, 30])
def test_a_block_is_what_the_factor_takes(n: int) -> None:
    path = GraphLaplacian(np.column_stack([np.arange(n - 1), np.arange(1, n)]), np.ones(n - 1), n)
    keep = np.arange(n) > 0
    solver = Cholesky(path.block(keep))
    np.testing.assert_allclose(solver.solve(np.eye(n - 1)[0]), np.ones(n - 1))
    scipys = LowerTriangle.of(path.to_sparse()[keep][:, keep])
    ours = path.block(keep)
    for one, other in ((ours.data, scipys.data), (ours.rows, scipys.rows), (ours.columns, scipys.columns)):
        np.testing.assert_array_equal(one, other)
