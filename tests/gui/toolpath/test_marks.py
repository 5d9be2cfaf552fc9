"""Which step each pixel shows, against every pixel's own distance."""

import numpy as np
import pytest

from gui.toolpath.marks import mark, warm


def marked(parts, reach, layer, step, shape=(30, 40)):
    marks, layers = np.full(shape, 7, dtype=np.int32), np.full(shape, 7, dtype=np.int8)
    mark(np.array(parts, dtype=float), np.array(reach, dtype=float), np.array(layer), np.array(step), marks, layers)
    return marks


def near(part, reach, shape=(30, 40)):
    a, b = np.array(part, dtype=float)
    y, x = np.mgrid[: shape[0], : shape[1]] + 0.5
    p = np.stack([x, y], axis=-1)
    t = np.clip(((p - a) @ (b - a)) / max((b - a) @ (b - a), 1e-300), 0, 1)
    return np.hypot(*np.moveaxis(p - a - t[..., None] * (b - a), -1, 0)) <= reach


@pytest.mark.parametrize("seed", range(30))
def test_it_is_the_earliest_step_of_the_highest_layer(seed):
    rng = np.random.default_rng(seed)
    count = 12
    parts = rng.uniform(-10, 50, (count, 2, 2))
    parts[0, 1] = parts[0, 0]  # a dot
    parts[1, 1, 1] = parts[1, 0, 1]  # level
    parts[2, 1, 0] = parts[2, 0, 0]  # upright
    reach, layer, step = rng.uniform(0.5, 4, count), rng.integers(0, 3, count), np.sort(rng.integers(0, 8, count))
    found = marked(parts, reach, layer, step)
    expected = np.full(found.shape, -1)
    for k in sorted(range(count), key=lambda k: (layer[k], -step[k])):
        expected[near(parts[k], reach[k])] = step[k]
    assert np.array_equal(found, expected)


def test_nothing_is_marked_where_there_is_nothing():
    assert (marked(np.zeros((0, 2, 2)), [], np.zeros(0, dtype=int), np.zeros(0, dtype=int)) == -1).all()
    assert (marked([[[100, 100], [200, 100]]], [2], [0], [0]) == -1).all()


def test_it_is_compiled_once_for_what_the_picture_gives_it(marlin):
    warm()
    known = len(mark.signatures)
    px = np.ascontiguousarray(marlin.parts)
    marks, layers = np.empty((5, 5), dtype=np.int32), np.empty((5, 5), dtype=np.int8)
    mark(px, np.ones(len(px)), marlin.role[marlin.part_step], marlin.part_step, marks, layers)
    assert len(mark.signatures) == known
