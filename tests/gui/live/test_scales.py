import numpy as np

from gui.live.scales import Scales


def fitted(*pairs):
    scales = Scales(1)
    for low, high in pairs:
        scales.fit(np.array([low]), np.array([high]))
    return scales.low[0], scales.high[0]


def test_it_widens_at_once_and_narrows_only_where_most_lies_idle():
    assert fitted((0.0, 1.0), (0.0, 3.0))[1] > 3.0
    assert fitted((0.0, 1.0), (0.2, 0.8)) == fitted((0.0, 1.0))
    low, high = fitted((0.0, 1.0), (0.4, 0.5))
    assert 0.35 < low < 0.4 and 0.5 < high < 0.55


def test_a_channel_that_stands_still_or_says_nothing():
    low, high = fitted((5.0, 5.0))
    assert low < 5.0 < high
    assert fitted((0.0, 0.0)) == (-0.58, 0.58)
    assert np.isnan(fitted((np.nan, np.nan))).all()
    assert fitted((0.0, 1.0), (np.nan, np.nan)) == fitted((0.0, 1.0))
