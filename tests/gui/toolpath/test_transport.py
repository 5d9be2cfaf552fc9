"""Play, scrub and step, by mouse and keys."""

import time

import pytest

from gui.theme import LIGHT, apply
from gui.toolpath.choice import ARCS, ArcsChoice
from gui.toolpath.transport import Transport


@pytest.fixture
def bar(root, marlin):
    apply(root, LIGHT)
    heard = []
    made = Transport(root, on_time=heard.append)
    made.heard = heard
    made.pack(fill="x")
    made.show(marlin)
    root.update()
    return made


def test_it_begins_at_the_end_where_all_is_seen(bar, marlin):
    assert bar.time == marlin.end == pytest.approx(bar.scale.get()) and bar.heard == []
    bar.seek(3.0)
    bar.show(marlin)
    assert bar.time == 3.0
    bar.show(None)
    bar.step(1)
    bar.toggle()
    bar.seek(5.0)
    assert bar.playing is None and bar.heard == [3.0] and bar.play.instate(["disabled"])


def test_steps_go_from_end_to_end(bar, marlin):
    bar.seek(0.0)
    seen = []
    for _ in range(len(marlin)):
        bar.step(1)
        seen.append(bar.time)
    assert seen[-1] == marlin.end and seen == sorted(seen)
    assert set(seen) >= {float(t) for t in marlin.start[1:] if t > 0}
    for _ in range(len(marlin)):
        bar.step(-1)
    assert bar.time == 0.0


@pytest.mark.parametrize(("key", "where"), [("Home", 0.0), ("End", 1.0), ("Next", 0.6), ("Prior", 0.4)])
def test_keys_move_through_it(root, bar, marlin, key, where):
    bar.seek(marlin.end / 2)
    bar.scale.focus_force()
    root.update()
    bar.scale.event_generate(f"<{key}>")
    root.update()
    assert bar.time == pytest.approx(where * marlin.end) == bar.heard[-1]


def test_arrows_and_space(root, bar, marlin):
    bar.seek(0.0)
    bar.scale.focus_force()
    root.update()
    bar.scale.event_generate("<Right>")
    assert bar.time == pytest.approx(marlin.start[marlin.step_at(bar.time)]) and bar.time > 0
    bar.scale.event_generate("<space>")
    assert bar.playing is not None
    bar.scale.event_generate("<space>")
    assert bar.playing is None


def test_it_plays_as_fast_as_it_says_and_stops_at_the_end(root, bar, marlin):
    bar.speed.set("5 x")
    bar.play.invoke()
    begun = time.monotonic()
    assert bar.time < 0.1
    while time.monotonic() < begun + 0.6:
        root.update()
    passed, shown = time.monotonic() - begun, bar.time
    assert 0.5 * 5 * passed < shown < 1.2 * 5 * passed
    bar.speed.set("300 x")
    while bar.playing is not None:
        root.update()
    assert bar.time == marlin.end and bar.play.cget("text") == "▶"
    assert time.monotonic() - begun < 30


def test_the_scale_scrubs(bar, marlin):
    bar.scale.set(2.5)
    assert bar.time == 2.5 == bar.heard[-1]


def test_a_closed_window_plays_no_more(root, bar):
    bar.toggle()
    bar.destroy()
    end = time.monotonic() + 0.1
    while time.monotonic() < end:
        root.update()


def test_arcs_are_chosen_once():
    choice, told = ArcsChoice(), []
    choice.listen(lambda: told.append(choice.arcs))
    for arcs in (None, "lines", "lines", "native"):
        choice.choose(arcs)
    assert told == ["lines", "native"] and set(ARCS) == {None, "lines", "native"}
