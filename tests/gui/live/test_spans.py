import numpy as np

from gui.live.spans import spans


def brute(time, values, start, step, width):
    """Least and most of the polyline in each column, by many points on it."""
    low, high = np.full(width, np.nan), np.full(width, np.nan)
    for k in range(width):
        at = np.linspace(start + k * step, start + (k + 1) * step, 400)
        at = np.sort(np.concatenate([at, time[(time >= at[0]) & (time < at[-1])]]))
        at = at[(at >= time[0]) & (at <= time[-1])]
        if len(at):
            found = np.interp(at, time, values)
            low[k], high[k] = found.min(), found.max()
    return low, high


def test_many_samples_a_column_and_few():
    rng = np.random.default_rng(0)
    for n in (40, 2000):
        time = np.sort(rng.uniform(0, 10, n))
        values = rng.standard_normal(n)
        found = spans(time, values[:, None], start=1.0, step=0.07, width=100, hole=99.0)
        low, high = brute(time, values, 1.0, 0.07, 100)
        assert np.allclose(found.low[:, 0], low, atol=1e-9) and np.allclose(found.high[:, 0], high, atol=1e-9)


def test_a_spike_of_one_sample_among_thousands_is_kept():
    values = np.zeros((10_000, 3))
    values[4321, 1] = 5.0
    found = spans(np.arange(10_000) / 1000, values, start=0.0, step=0.1, width=100, hole=1.0)
    assert found.high[43, 1] == 5.0 and found.high[:, [0, 2]].max() == 0.0 and np.count_nonzero(found.high[:, 1]) == 1


def test_lines_are_broken_at_holes_at_invalid_readings_and_beyond_the_ends():
    time = np.array([0.0, 1.0, 2.0, 6.0, 7.0])
    rows = np.array([[0.0, 0.0], [1, np.nan], [2, 2], [6, 6], [7, 7]])
    found = spans(time, rows, start=-2.0, step=0.5, width=20, hole=2.0)
    drawn = np.isfinite(found.low)
    middle = -2 + 0.5 * np.arange(20) + 0.25
    assert drawn[(middle > 0) & (middle < 2), 0].all() and drawn[(middle > 6) & (middle < 7), 0].all()
    assert not drawn[(middle < 0) | ((middle > 2.5) & (middle < 6)) | (middle > 7.5)].any()
    assert not drawn[(middle > 0.5) & (middle < 2), 1].any()


def test_nothing_gives_nothing():
    found = spans(np.empty(0), np.empty((0, 2)), start=0.0, step=0.1, width=5, hole=1.0)
    assert found.low.shape == (5, 2) and np.isnan(found.low).all()


def test_a_picture_that_scrolls_by_whole_columns_does_not_flicker():
    rng = np.random.default_rng(1)
    time, values = np.arange(3000) / 300, rng.standard_normal((3000, 1))
    one = spans(time, values, start=1.0, step=0.05, width=100, hole=1.0)
    two = spans(time, values, start=1.0 + 0.05 * 7, step=0.05, width=100, hole=1.0)
    assert np.allclose(one.low[7:], two.low[:-7]) and np.allclose(one.high[7:], two.high[:-7])
