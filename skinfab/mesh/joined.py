"""Groups of things that hang together, directly or through others."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

IntArray = NDArray[np.int64]


def joined(a: IntArray, b: IntArray, count: int) -> tuple[int, IntArray]:
    """How many groups the pairs make of `count` things, and the group of each.

    Each group's smallest label is hooked below a smaller neighbour's and all chains are cut short, in rounds that at
    least halve the groups every second time (Shiloach and Vishkin 1982). As fast as scipy's search where the mesh is
    large, and there is no scipy to import where it is small.

    Parameters
    ----------
    a, b : (k,) int64
        Pairs of things, 0 .. count - 1.
    count : int

    Returns
    -------
    int
    (count,) int64
        Groups are numbered by their first member.

    Examples
    --------
    >>> joined(np.array([0, 4]), np.array([2, 3]), 5)
    (3, array([0, 1, 0, 2, 2]))
    """
    label = np.arange(count)
    while True:
        a, b = label[a], label[b]
        apart = a != b
        if not apart.any():
            break
        a, b = a[apart], b[apart]
        np.minimum.at(label, np.maximum(a, b), np.minimum(a, b))
        while (label != (above := label[label])).any():
            label = above
    first = label == np.arange(count)
    return int(first.sum()), (np.cumsum(first) - 1)[label]
