import numpy as np

from gui.live.picture import Ink, strips
from gui.live.spans import Spans

WHITE, BLUE, RED, GREY = (255, 255, 255), (0, 0, 255), (255, 0, 0), (128, 128, 128)


def drawn(low, high, **options):
    low, high = np.array(low, dtype=float), np.array(high, dtype=float)
    c = low.shape[1]
    inks = [Ink("#ffffff", "#0000ff"), Ink("#ffffff", "#ff0000")][:c]
    given = {"height": 21, "grid": [], "grid_colour": "#808080", "width_px": 1.0} | options
    picture = strips(Spans(low, high), np.zeros(c), np.full(c, 1.0), inks, **given)
    return picture.view(np.uint8).reshape(*picture.shape, 4)


def test_a_value_is_a_line_at_its_height_in_its_own_strip_and_colour():
    picture = drawn([[0.0, 1.0]] * 4, [[0.0, 1.0]] * 4)
    assert picture.shape == (42, 4, 4) and (picture[..., 3] == 255).all()
    blue, red = np.all(picture[:, 0, :3] == BLUE, axis=-1), np.all(picture[:, 0, :3] == RED, axis=-1)
    assert np.flatnonzero(~blue & np.any(picture[:, 0, :3] != WHITE, axis=-1) & (picture[:, 0, 2] == 255)).tolist() == [18, 19]
    assert not red[:21].any() and np.any(picture[21:24, 0, :3] != WHITE, axis=-1).any()


def test_a_span_fills_from_its_least_to_its_most():
    picture = drawn([[0.25]], [[0.75]])
    rows = np.flatnonzero(np.all(picture[:, 0, :3] == BLUE, axis=-1))
    assert len(rows) >= 9 and abs(rows.mean() - 9.5) < 1.0


def test_nothing_is_ground_and_grid_lies_behind():
    picture = drawn([[np.nan], [0.5]], [[np.nan], [0.5]], grid=[0, 1])
    assert (picture[:, 0, :3] == GREY).all()
    assert np.any(picture[:, 1, :3] != GREY, axis=-1).sum() in (1, 2)


def test_what_lies_beyond_a_strip_stays_in_it():
    picture = drawn([[-50.0, 0.5]], [[-40.0, 0.5]])
    assert not np.any(picture[21:, 0, :3] == BLUE, axis=-1).all()
    assert (picture[:18, 0, :3] == WHITE).all()
