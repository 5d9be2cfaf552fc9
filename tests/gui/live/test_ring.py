import numpy as np
import pytest

from gui.live.ring import Ring


@pytest.mark.parametrize("chunk", [1, 3, 7, 10, 23])
def test_it_holds_the_last_rows_in_order_however_they_came(chunk):
    ring, everything = Ring(2, capacity=10), np.arange(200.0)
    for k in range(0, 200, chunk):
        part = everything[k : k + chunk]
        ring.add(part, np.stack([part, -part], axis=1))
        last = everything[: k + len(part)][-10:]
        assert ring.time.tolist() == last.tolist() and ring.rows[:, 1].tolist() == (-last).tolist() and len(ring) == len(last)


def test_since_begins_with_the_row_before():
    ring = Ring(1, capacity=10)
    ring.add(np.arange(5.0), np.arange(5.0)[:, None])
    assert ring.since(2.5)[0].tolist() == [2.0, 3.0, 4.0] and ring.since(-1.0)[0][0] == 0.0 and ring.since(9.0)[0].tolist() == [4.0]


def test_cleared_it_is_as_new():
    ring = Ring(1, capacity=3)
    ring.add(np.arange(5.0), np.arange(5.0)[:, None])
    ring.clear()
    assert len(ring) == 0 and len(ring.since(0.0)[0]) == 0
    ring.add(np.array([1.0]), np.array([[7.0]]))
    assert ring.rows.tolist() == [[7.0]]
