import itertools

from hypothesis import given
from hypothesis import strategies as st

from skinfab.readout.sequence import LATE_FRAMES, InOrder


@given(st.integers(0, 2**32 - 1), st.lists(st.integers(1, 1000), max_size=60))
def test_gaps_are_counted_and_the_counter_may_wrap(start: int, steps: list[int]) -> None:
    order, counter, placed = InOrder(), start, [start]
    assert order.place(start) == start
    for step in steps:
        counter += step
        found = order.place(counter % 2**32)
        assert found is not None
        placed.append(found)
    assert placed[-1] - placed[0] == sum(steps)
    assert order.lost == sum(steps) - len(steps) and order.late == order.restarts == 0


def test_late_and_second_frames_are_dropped() -> None:
    order = InOrder()
    assert [order.place(k) for k in (10, 12, 11, 12, 13)] == [10, 12, None, None, 13]
    assert (order.lost, order.late) == (1, 2)


def test_a_device_that_starts_anew_is_no_late_one() -> None:
    order = InOrder()
    order.place(5000)
    assert [order.place(k) for k in (0, 1, 2)] == [5001, 5002, 5003]
    assert (order.lost, order.late, order.restarts) == (0, 0, 1)
    # and however near its count was to the new one, after the port was gone
    order.reopened()
    assert [order.place(k) for k in (0, 1)] == [5004, 5005]
    assert (order.lost, order.late, order.restarts) == (0, 0, 2)


def test_a_cable_that_was_out_for_a_while_costs_what_was_sent_meanwhile() -> None:
    order = InOrder()
    order.place(100)
    order.reopened()
    assert order.place(150) == 150 and order.lost == 49 and order.restarts == 0


@given(st.lists(st.integers(0, 2**32 - 1), max_size=100))
def test_numbers_only_grow(counters: list[int]) -> None:
    order = InOrder()
    placed = [p for p in map(order.place, counters) if p is not None]
    assert all(b > a for a, b in itertools.pairwise(placed))
    assert len(placed) + order.late == len(counters)
    if placed:
        assert placed[-1] - placed[0] + 1 == len(placed) + order.lost


def test_just_within_the_limit_is_late() -> None:
    order = InOrder()
    order.place(1000)
    assert order.place(1000 - LATE_FRAMES + 1) is None and order.place(1000 - LATE_FRAMES) == 1001
