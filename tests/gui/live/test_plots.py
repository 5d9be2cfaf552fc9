import math

import numpy as np
import pytest

from gui.live.plots import Now, Plots
from gui.live.ring import Ring
from gui.theme import DARK, LIGHT, apply, rgb
from skinfab.readout.frame import Channel, Frame, Stream

STREAM = Stream("s", (Channel("A", "V"), Channel("B", "kohm"), Channel("C")), 100.0)


def frame(values, valid=True, saturated=False):
    n = len(values)
    return Frame(0.0, 0.0, 0, np.array(values, dtype=float), np.full(n, valid), np.full(n, saturated))


@pytest.fixture
def plots(root):
    root.geometry("600x400+0+0")
    apply(root, LIGHT)
    chosen = []
    made = Plots(root, LIGHT, chosen=chosen.append)
    made.told = chosen
    made.pack(fill="both", expand=True)
    root.update()
    made.begin(STREAM, ("C1 (A)", "B", "C"), angle=True)
    made.ring = Ring(4, capacity=2000)
    time = np.arange(1000) / 100
    made.ring.add(time, np.stack([np.sin(time), 5 + 0 * time, np.where(time > 5, np.nan, time), 40 + time], axis=1))
    return made


def draw(plots, **given):
    now = {"time": 9.99, "range_s": 10.0, "newest": frame([0.5, 5.0, 1.0]), "touched": {}, "angle": 49.9, "silent": False} | given
    plots.draw(plots.ring, Now(**now))
    plots.update()


def words(plots, tag):
    return plots.canvas.itemcget(tag, "text")


def picture(plots):
    from PIL import ImageTk

    image = ImageTk.getimage(plots._photo)
    return np.asarray(image)[..., :3].astype(int)


def painted(plots, colour, near=170):
    """Rows and columns of a colour, or next to it: a thin line may lie between two rows of pixels."""
    return np.nonzero(np.abs(picture(plots) - rgb(colour)).sum(axis=2) < near)


def test_a_channel_a_strip_and_the_angle_below_with_its_value(plots):
    draw(plots)
    assert [words(plots, f"name{k}") for k in (0, 1, 2, -1)] == ["C1 (A)", "B", "C", "angle"]
    assert words(plots, "value0") == "0.5 V" and words(plots, "value-1") == "49.9 deg"
    rows, columns = painted(plots, LIGHT.accent)
    height = plots._rows()[1]
    rows, columns = rows[rows < 3 * height], columns[rows < 3 * height]
    assert set(rows // height) == {0, 1, 2} and columns.max() >= picture(plots).shape[1] - 2
    last = columns[rows // height == 2]
    assert last.max() < 0.55 * picture(plots).shape[1]  # C says nothing after 5 s
    assert len(painted(plots, LIGHT.good, 12)[0])


def test_a_sine_is_drawn_where_it_is(plots):
    draw(plots)
    _, height, _ = plots._rows()
    part = np.abs(picture(plots)[:height] - rgb(LIGHT.accent)).sum(axis=2) < 200
    width = part.shape[1]
    for column in range(10, width - 10, 25):
        t = (column + 0.5) / width * 10.0
        middle = np.flatnonzero(part[:, column]).mean()
        assert middle == pytest.approx((1.16 / 2.32 - math.sin(t) / 2.32) * (height - 4) + 1.5, abs=4)


def test_touched_invalid_saturated_and_silent_are_told_apart(plots):
    draw(plots, touched={"B": -0.16})
    assert words(plots, "value1") == "touched, -16 %" and len(painted(plots, LIGHT.select)[0])
    draws = [
        ({"newest": frame([0.5, 5, 1], valid=False)}, "no reading", LIGHT.error),
        ({"newest": frame([0.5, 5, 1], saturated=True)}, "at its end", LIGHT.error),
        ({"silent": True}, "0.5 V", LIGHT.faint),
    ]
    for given, says, colour in draws:
        plots._words_at = 0.0
        draw(plots, **given)
        assert words(plots, "value0") == says and plots.canvas.itemcget("value0", "fill") == colour


def test_a_lost_reading_does_not_look_like_a_touch(plots):
    draw(plots, touched={"B": -0.16}, newest=frame([0.5, 5, 1], valid=False))
    assert words(plots, "value1") == "no reading" and not len(painted(plots, LIGHT.select, 60)[0])
    assert not len(painted(plots, LIGHT.accent, 12)[0]), "nor like one that is well"


def test_a_click_chooses_and_a_double_click_shows_alone_and_all_again(plots):
    draw(plots)
    y = plots._rows()[1] + 5
    plots.canvas.event_generate("<Button-1>", x=200, y=y)
    plots.update()
    assert plots.told == [1]
    for alone in (1, None):
        for after in (0, 100):
            clock = (9000 if alone is None else 1000) + after
            plots.canvas.event_generate("<Button-1>", x=200, y=y, time=clock)
            plots.canvas.event_generate("<ButtonRelease-1>", x=200, y=y, time=clock + 20)
        plots.update()
        draw(plots)
        assert plots.alone == alone
    assert plots.channel_at(10_000) is None


def test_more_channels_than_fit_are_moved_through(plots):
    many = Stream("m", tuple(Channel(f"S{k}") for k in range(100)), 100.0)
    plots.begin(many, many.names, angle=False)
    plots.ring = Ring(101, capacity=10)
    plots.ring.add(np.arange(10) / 100, np.zeros((10, 101)))
    draw(plots, newest=frame([0.0] * 100))
    shown, height, _ = plots._rows()
    assert shown[0] == 0 and len(shown) < 100 and height >= 11
    for _ in range(5):
        plots.canvas.event_generate("<Button-5>")
    draw(plots, newest=frame([0.0] * 100))
    assert plots._rows()[0][0] == 5 and words(plots, "name5") == "S5" and words(plots, "name4") == ""
    plots.first = 999
    assert plots._rows()[0][-1] == 99


def test_times_stand_below_and_go_with_the_curves(plots):
    draw(plots)
    first = {plots.canvas.itemcget(i, "text"): plots.canvas.coords(i)[0] for i in plots.canvas.find_withtag("ticks")}
    draw(plots, time=10.99)
    second = {plots.canvas.itemcget(i, "text"): plots.canvas.coords(i)[0] for i in plots.canvas.find_withtag("ticks")}
    assert "4 s" in first and second["4 s"] < first["4 s"]


def test_both_themes_and_nothing_to_show(plots):
    draw(plots)
    plots.restyle(DARK)
    draw(plots)
    assert len(painted(plots, DARK.accent, 12)[0]) and not len(painted(plots, LIGHT.accent, 12)[0])
    plots.clear("nothing here")
    draw(plots)
    assert [plots.canvas.itemcget(i, "text") for i in plots.canvas.find_withtag("words")] == ["nothing here"]


def test_a_picture_of_32_channels_of_which_little_moves_takes_no_longer_for_a_long_past(plots):
    """Counted, not timed: what is painted does not grow with the number of samples."""
    stream = Stream("m", tuple(Channel(f"S{k}") for k in range(32)), 100.0)
    plots.begin(stream, stream.names, angle=False)
    plots.ring = Ring(33, capacity=13_000)
    plots.ring.add(np.arange(13_000) / 100, np.random.default_rng(0).standard_normal((13_000, 33)))
    draw(plots, time=129.99, newest=frame([0.0] * 32))
    before, items = picture(plots).shape, len(plots.canvas.find_all())
    draw(plots, time=129.99, range_s=120.0, newest=frame([0.0] * 32))
    assert picture(plots).shape == before and len(plots.canvas.find_all()) <= items + 6
