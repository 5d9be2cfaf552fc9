"""Places along a target curve: no edge pinched to nothing between two that are not."""

import numpy as np

from skinfab.flatten.bff_target import _unpinched


def test_a_pinched_edge_is_opened_and_the_rest_keeps_its_proportions() -> None:
    length = np.ones(6)
    gap = np.array([1.0, 1, 1e-8, 2, 1, 1])
    gap *= 12 / gap.sum()
    at = np.concatenate([[0.0], np.cumsum(gap)[:-1]])
    opened = np.diff(np.append(_unpinched(at, length, 12.0), 12.0))
    np.testing.assert_allclose(opened / opened[0], [1, 1, 0.05, 2, 1, 1])


def test_edges_that_are_short_together_or_on_the_object_stay() -> None:
    """So it is about a corner of the border that the target has straight: conformal maps crowd there."""
    for length, gap in (
        (np.ones(6), np.array([1.0, 1, 1e-3, 1e-3, 1, 1])),
        (np.array([1, 1, 1e-3, 1, 1, 1]), np.array([1, 1, 1e-3, 1, 1, 1])),
    ):
        at = np.concatenate([[0.0], np.cumsum(gap)[:-1]])
        np.testing.assert_allclose(_unpinched(at, length, gap.sum()), at, rtol=1e-12)
