"""The tab in a real window beside both views."""

import threading
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from calibration.contact.simulator import simulate
from calibration.finger.logs import ROBOT, calibrated
from calibration.strain.document import save_calibration
from gui.live.choices import LogChoice, PortChoice, SimulatorChoice
from gui.live.tab import LiveTab
from gui.state.derived import Derived
from gui.theme import DARK, LIGHT, apply, rgb
from skinfab.readout.faults import Faults
from skinfab.readout.frame import Channel, Frame, Stream
from skinfab.readout.logs.log import read_log
from skinfab.readout.pty_server import PtyServer

LOGS = Path(__file__).resolve().parents[3] / "calibration" / "logs"


@pytest.fixture
def window(root, session, tmp_path):
    from gui.view2d.view import View2D
    from gui.view3d.view import View3D

    root.geometry("1200x700+0+0")
    apply(root, LIGHT)
    derived = Derived()
    view3d = View3D(root, session, derived, LIGHT, name="view3d")
    view2d = View2D(root, session, derived, LIGHT, name="view2d")
    answers = SimpleNamespace(open=None, save=tmp_path / "a.frames")
    tab = LiveTab(
        root,
        session,
        derived,
        LIGHT,
        view3d=view3d,
        view2d=view2d,
        ask_open=lambda title, kinds: answers.open,
        ask_save=lambda title, suffix, name: answers.save,
    )
    for k, part in enumerate((view3d, view2d, tab)):
        part.place(relx=(0.0, 0.25, 0.5)[k], relwidth=(0.25, 0.25, 0.5)[k], relheight=1.0)
    made = SimpleNamespace(root=root, session=session, view3d=view3d, view2d=view2d, tab=tab, answers=answers)

    def until(true, seconds=15.0):
        end = time.monotonic() + seconds
        while not true():
            assert time.monotonic() < end, f"it never came; {tab.status['text']!r}, {session.problems}"
            root.update()
            time.sleep(0.003)

    def wait(seconds):
        end = time.monotonic() + seconds
        until(lambda: time.monotonic() > end)

    made.until, made.wait = until, wait
    root.update()
    yield made
    tab.close()
    end = time.monotonic() + 8.0  # a port that says nothing is let go after five
    while left := [t for t in threading.enumerate() if t.name.startswith(("live ", "reader of"))]:
        assert time.monotonic() < end, left
        time.sleep(0.01)


def text(window):
    return str(window.tab.status["text"])


def tick_places(window_tab):
    canvas = window_tab.plots.canvas
    return [(canvas.itemcget(i, "text"), canvas.coords(i)) for i in canvas.find_withtag("ticks")]


def hand(*, faults=None, rate_hz=None):
    """A board with a hand on it: channels that do not say whose they are."""
    made = simulate("cube", seed=1).recording
    channels = tuple(replace(c, sensor="") for c in made.stream.channels)
    return PtyServer(Stream("board", channels, 100.0), made, faults=faults, rate_hz=rate_hz)


def _has_colour(picture, colour):
    return bool((np.abs(picture[..., :3].astype(int) - rgb(colour)).sum(axis=2) < 12).any())


def test_a_touch_over_a_pseudo_terminal_lights_its_sensor_in_both_views(window):
    tab = window.tab
    before = np.array(window.view2d.surface.picture)
    with hand(rate_hz=200.0) as device:  # twice as quick as it was; S1 is touched first
        tab.choose(PortChoice(str(device.path)))
        # The line of text is renewed less often than the lights.
        window.until(lambda: set(tab.lights.lit) == {"C1"} and "board: 6 channels" in text(window))
        window.until(lambda: window.view3d.scene.spots is not None)
        assert len(window.view3d.scene.spots.points) and (window.view3d.scene.spots.points[:, 0] < 100).all()  # on the first piece
        assert not _has_colour(before, LIGHT.select)
        # Drawn while it is lit, however short a busy machine makes that: else the next touch is waited for.
        window.until(
            lambda: tab.lights.lit and (window.view2d.surface.refresh_now() or _has_colour(window.view2d.surface.picture, LIGHT.select))
        )
        assert not tab.lights._notes[0].winfo_ismapped()  # real as far as anybody knows
        window.until(lambda: "C1" not in tab.lights.lit)
        tab.choose(None)
        assert window.view3d.scene.spots is None and tab.lights.lit == {}


def test_a_port_that_is_pulled_out_is_said_and_survived_and_its_lights_go_out(window):
    with hand(faults=Faults(unplugged={430: 1.5})) as device:  # S1 is touched from 4.0 s on
        window.tab.choose(PortChoice(str(device.path)))
        window.until(lambda: window.tab.lights.lit)
        window.until(lambda: "is gone for" in text(window))
        assert window.tab.lights.lit == {} and str(window.tab.status["style"]) == "Error.TLabel"
        window.until(lambda: "and is back" in text(window))
        count = len(window.tab.ring)
        window.until(lambda: len(window.tab.ring) > count + 50)
        holes = np.diff(window.tab.ring.time)
        assert holes.max() > 1.0  # the plots show how long it was gone


def test_a_device_that_falls_silent_is_said_to_be_stale(window):
    stream = Stream("board", (Channel("A", "V"),), 100.0)
    go = threading.Event()

    def frames():
        for k in range(10_000):
            if k == 60:
                go.wait(10.0)
            yield Frame(k / 100, k / 100, k, np.array([1.0]), np.array([True]), np.array([False]))

    with PtyServer(stream, frames()) as device:
        window.tab.choose(PortChoice(str(device.path)))
        window.until(lambda: "stale: no frame for" in text(window))
        go.set()
        window.until(lambda: "stale" not in text(window))


def test_simulated_is_said_wherever_it_shows(window):
    window.tab.choose(SimulatorChoice("hand on a cube"))
    window.until(lambda: "simulated hand on a cube: 6 channels" in text(window))
    window.until(lambda: all(note.winfo_ismapped() for note in window.tab.lights._notes))
    assert {note["text"] for note in window.tab.lights._notes} == {"contacts: simulated"}
    window.tab.choose(None)
    window.root.update()
    assert not any(note.winfo_ismapped() for note in window.tab.lights._notes)


def test_strips_are_called_by_the_sensors_and_a_click_selects_one(window):
    window.tab.choose(SimulatorChoice("hand on a cube"))
    canvas = window.tab.plots.canvas
    window.until(lambda: canvas.itemcget("name1", "text") == "C2 (S2)")
    height = window.tab.plots._rows()[1]
    canvas.event_generate("<Button-1>", x=150, y=height + 3)
    window.root.update()
    assert window.session.selected.sensor == "C2"
    canvas.event_generate("<Button-1>", x=150, y=5 * height + 3)  # no sensor of this skin
    assert window.session.selected.sensor == "C2"
    changed = replace(window.session.skin, sensors=(replace(window.session.skin.sensors[0], channel=1),))
    window.session.do("change", changed)
    window.until(lambda: canvas.itemcget("name1", "text") == "C1 (S2)")
    assert not any("no channel" in p.text for p in window.session.problems)
    far = replace(window.session.skin.sensors[0], id="C9", channel=9)
    window.session.do("one more", replace(window.session.skin, sensors=(*window.session.skin.sensors, far)))
    assert any("C9 (number 9)" in p.text for p in window.session.problems)


def test_a_log_is_scrubbed_and_its_lights_follow(window):
    window.tab.choose(LogChoice(LOGS / "contact_cube_1.csv"))
    row = window.tab.log_row
    window.until(lambda: row.player is not None and row.winfo_ismapped())
    assert window.tab.row.button.instate(["disabled"]) and any(p.kind == "note" for p in window.session.problems)
    row.toggle()
    row.scale.set(4.6)  # as the mouse does: S1 is touched from 4.00 to 5.25 s
    window.until(lambda: set(window.tab.lights.lit) == {"C1"})
    assert row.player.paused
    window.until(lambda: "simulated" in text(window) and "paused" in text(window) and row.play["text"] == "Play")
    assert len(window.tab.ring) == pytest.approx(460, abs=2)
    window.until(lambda: {n["text"] for n in window.tab.lights._notes} == {"contacts: simulated, log contact_cube_1.csv"})
    row.scale.set(2.0)
    window.until(lambda: window.tab.lights.lit == {} and len(window.tab.ring) < 250)
    row.speed.set("20")
    row._speed()
    row.toggle()
    window.until(lambda: row.player.at_end)
    window.until(lambda: "at its end" in text(window))
    row.scale.focus_force()
    row.scale.event_generate("<Left>")
    window.until(lambda: row.player.position_s < row.player.duration_s - 0.5)


def test_the_calibrated_angle_is_a_number_a_needle_and_a_curve(window, tmp_path):
    save_calibration(calibrated(ROBOT, "play"), tmp_path / "calibration.json")
    window.answers.open = tmp_path / "calibration.json"
    tab = window.tab
    tab.angle._choose()  # before anything is connected
    tab.choose(LogChoice(LOGS / "robot_finger.csv"))
    window.until(lambda: tab.log_row.player is not None)
    assert tab.angle.channel.get() == "robot_V"
    tab.log_row.toggle()
    tab.log_row.scale.set(4.5)
    window.until(lambda: len(tab.ring) == 450 and np.isfinite(tab.ring.rows[-1, -1]))
    true = read_log(LOGS / "robot_finger.csv").recording.column("PIP_deg")[:450]
    assert np.sqrt(np.mean((tab.ring.rows[50:450, -1] - true[50:]) ** 2)) < 12.0  # causal, so late, on a fast finger
    window.until(lambda: not np.isnan(tab.angle.dial._shown[0]))
    window.until(lambda: tab.plots.canvas.itemcget("value-1", "text").endswith("deg"))
    tab.angle.drop()
    window.until(lambda: tab.plots.canvas.itemcget("name-1", "text") == "")
    assert "no joint angle" in tab.angle._words["text"]


def test_a_calibration_that_does_not_go_with_the_source_is_said(window, tmp_path):
    save_calibration(calibrated(ROBOT, "play"), tmp_path / "calibration.json")
    window.tab.choose(SimulatorChoice("hand on a cube"))
    window.until(lambda: "100 Hz of 100" in text(window) or "channels" in text(window))
    window.tab.angle.load(tmp_path / "calibration.json")
    (problem,) = window.session.problems
    assert "no channel 'robot_V'" in problem.text
    window.tab.angle.channel.set("S1")
    window.tab.angle.apply()
    assert window.session.problems == ()
    (tmp_path / "bad.json").write_text("{}")
    window.tab.angle.load(tmp_path / "bad.json")
    assert "is no calibration" in window.session.problems[0].text


def test_what_comes_is_recorded_and_never_over_a_file_that_is_there(window):
    tab = window.tab
    tab.choose(SimulatorChoice("strain channels"))
    window.until(lambda: not tab.row.button.instate(["disabled"]))
    tab.row.button.invoke()
    window.until(lambda: "frames," in tab.row.words["text"] and tab.feed.recorded > 50)
    assert tab.row.button["text"] == "End"
    tab.row.button.invoke()
    window.until(lambda: tab.row.words["text"].endswith("frames recorded"))
    recording = read_log(window.answers.save).recording
    assert len(recording) > 50 and recording.stream.simulated and len(recording.stream.channels) == 32
    tab.row.button.invoke()
    assert "never overwritten" in window.session.problems[0].text
    window.answers.save = window.answers.save.with_suffix(".txt")
    tab.row.button.invoke()
    assert "call a recording .frames" in window.session.problems[0].text


def test_a_recording_ends_whole_with_its_source(window):
    window.tab.choose(SimulatorChoice("strain channels"))
    window.until(lambda: not window.tab.row.button.instate(["disabled"]))
    window.tab.row.button.invoke()
    feed = window.tab.feed
    window.until(lambda: feed.recorded > 20)
    window.tab.choose(None)
    assert "a.frames: " in window.tab.row.words["text"] and window.tab.row.words["text"].endswith("frames recorded")
    assert feed.join(2.0) and len(read_log(window.answers.save).recording) == feed.recorded > 20


def test_paused_the_plots_stand_still_and_reading_goes_on(window):
    tab = window.tab
    tab.choose(SimulatorChoice("strain channels"))
    window.until(lambda: len(tab.ring) > 50)
    tab.plots.canvas.focus_force()
    tab.plots.canvas.event_generate("<space>")
    pressed = len(tab.ring)
    window.until(lambda: len(tab.ring) > pressed + 2)
    window.wait(0.3)  # values are written five times a second
    ticks, count = tick_places(tab), len(tab.ring)
    held, values = tab._held.now, [tab.plots.canvas.itemcget(f"value{k}", "text") for k in range(2)]
    window.until(lambda: len(tab.ring) > count + 20)
    window.wait(0.3)
    assert tick_places(tab) == ticks
    assert (
        values == [tab.plots.canvas.itemcget(f"value{k}", "text") for k in range(2)]
        and tab._last.now.newest.sequence > held.newest.sequence
    )
    tab.row.hold.invoke()
    window.until(lambda: tick_places(tab) != ticks)


def test_paused_the_lights_stand_still_and_say_so(window):
    tab = window.tab
    with hand(rate_hz=400.0) as device:
        tab.choose(PortChoice(str(device.path)))
        window.until(lambda: set(tab.lights.lit) == {"C1"})
        tab.row.hold.invoke()
        held = dict(tab.lights.lit)
        window.until(lambda: tab._last.now.touched == {})
        assert tab.lights.lit == held and set(held) == {"C1"}
        window.until(lambda: {n["text"] for n in tab.lights._notes if n.winfo_ismapped()} == {"contacts: paused"})
        tab.row.hold.invoke()
        window.until(lambda: "C1" not in tab.lights.lit)
        window.until(lambda: not tab.lights._notes[0].winfo_ismapped())


def test_what_cannot_be_opened_is_a_sentence_and_the_window_lives(window, tmp_path):
    for choice, says in (
        (PortChoice("/dev/nowhere"), "there is no port /dev/nowhere"),
        (LogChoice(tmp_path / "no.csv"), "no.csv"),
    ):
        window.tab.choose(choice)
        window.until(lambda says=says: any(says in p.text for p in window.session.problems))
        assert window.tab.connect.button["text"] == "Connect" and window.tab.feed is None and says in text(window)
    window.tab.choose(SimulatorChoice("hand on a cup"))
    window.until(lambda: len(window.tab.ring) > 20)
    assert window.session.problems == ()


def test_no_source_blocks_the_window(window, tmp_path):
    """A port that says nothing is waited for, for five seconds, beside the window."""
    import os
    import tty

    ours, theirs = os.openpty()
    tty.setraw(theirs)
    window.tab.choose(PortChoice(os.ttyname(theirs)))
    first, said = window.tab.feed, []
    window.until(lambda: said.append(text(window)) or (len(said) > 50 and "waiting for" in text(window)))
    assert first.status().state == "opening"  # the window has come round fifty times meanwhile
    window.tab.choose(SimulatorChoice("hand on a cup"))
    assert first.alive
    window.until(lambda: len(window.tab.ring) > 20)
    os.close(ours)
    os.close(theirs)


def test_both_themes(window):
    window.tab.choose(SimulatorChoice("strain channels"))
    window.until(lambda: window.tab.plots.pictures > 3)
    apply(window.root, DARK)
    window.tab.restyle(DARK)
    drawn = window.tab.plots.pictures
    window.until(lambda: window.tab.plots.pictures > drawn + 3)
    assert window.tab.plots.canvas["background"] == DARK.view and window.tab.angle.dial["background"] == DARK.panel


def test_the_tab_goes_and_its_threads_go_with_it(window):
    window.tab.choose(SimulatorChoice("strain channels"))
    window.until(lambda: len(window.tab.ring) > 5)
    feed = window.tab.feed
    window.tab.destroy()
    assert feed.join(2.0)
    window.wait(0.2)
