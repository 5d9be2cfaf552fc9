"""What a port sends is watched as a log is: the same motions, and each decision within the sample's own time."""

import time
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from interrupts import pressed

from skinfab.cli.force_port import Watched, watch_port
from skinfab.errors import InputError
from skinfab.fingertip.force.motion import Limits, Motion, MotionWatch, find_motions
from skinfab.fingertip.force.motion_simulator import grasp_log
from skinfab.fingertip.force.touch_model import TouchModel
from skinfab.fingertip.force.wrench import SensorNoise, force_stream
from skinfab.readout.frame import Channel, Frame, Recording, Stream
from skinfab.readout.packets import FRAME_64
from skinfab.readout.pty_server import PtyServer

LIMITS = Limits(friction_deg=31)


def recording(seconds: float = 12.0) -> Recording:
    log, _ = grasp_log(seed=3, episodes=4)
    n = min(round(seconds * 200), len(log))
    values = np.column_stack([log.force, log.moment])[:n]
    return Recording.of_values(force_stream("fingertip", 200.0, simulated=True), values, device_time=np.arange(n) / 200)


def watching(device: PtyServer, **options: Any) -> Watched:
    with ExitStack() as until_written:
        return watch_port(str(device.path), limits=LIMITS, until_written=until_written, **options)


def watching_all(device: PtyServer, samples: int, **options: Any) -> Watched:
    """Until so many samples were decided on, however long that takes."""
    with pressed(MotionWatch, after=samples):
        return watching(device, seconds=60, **options)


def slowly(made: Recording) -> Iterator[Frame]:
    """As often as a sensor sends them, or less often where the machine is busy, but all of them."""
    for frame in made:
        time.sleep(0.005)
        yield frame


def test_a_port_and_a_log_give_the_same_motions(capsys: pytest.CaptureFixture[str]) -> None:
    made = recording()
    with PtyServer(made.stream, made, rate_hz=0, kind=FRAME_64) as device:
        watched = watching_all(device, len(made))
    n = len(watched.log)
    assert n == len(made) and watched.simulated and watched.log.simulated
    found = find_motions(made.device_time, made.values[:, :3], made.values[:, 3:], MotionWatch(LIMITS, rate_hz=200))
    assert found and [(e.kind, round(e.start, 3)) for e in watched.motions] == [(e.kind, round(e.start, 3)) for e in found]
    said = capsys.readouterr().err
    assert "contact: " in said and f"motion: {found[0].told:.2f} s, {found[0].kind} began" in said


def test_latency_is_of_every_sample_and_less_than_its_time() -> None:
    made = recording(1.0)
    with PtyServer(made.stream, slowly(made), rate_hz=0) as device:
        watched = watching_all(device, 200, quiet=True)
    assert 0 < len(watched.latency_s) <= len(watched.log) == 200 and (watched.latency_s > 0).all()
    assert 0 < watched.latency["median_ms"] <= watched.latency["p99_ms"] <= watched.latency["worst_ms"]


def test_what_gathered_before_it_was_read_is_no_latency(monkeypatch: pytest.MonkeyPatch) -> None:
    made = recording(2.0)
    opened = MotionWatch.__init__

    def slow(*args: object, **options: object) -> None:
        while device.sent < 250:
            time.sleep(0.01)
        opened(*args, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(MotionWatch, "__init__", slow)
    with PtyServer(made.stream, slowly(made), rate_hz=0) as device:
        watched = watching_all(device, 400, quiet=True)
    assert len(watched.log) == 400 and 0 < len(watched.latency_s) < 300
    assert watched.latency["median_ms"] < 300  # those that waited did so for more than a second


def test_decisions_that_fall_behind_are_told_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    made = recording(3.0)
    step = MotionWatch.step

    def slow(*args: object) -> list[Motion]:
        time.sleep(0.02)  # four samples' time
        return step(*args)  # type: ignore[arg-type]

    monkeypatch.setattr(MotionWatch, "step", slow)
    with PtyServer(made.stream, made) as device:
        watched = watching(device, seconds=1.5, quiet=True)
    (said,) = watched.notes
    assert said.startswith("at the end decisions were ") and "was not read: this computer is too busy" in said


def test_units_of_the_stream_are_converted() -> None:
    made = recording(0.5)
    channels = tuple(replace(each, unit="N m") if each.name[0] == "M" else each for each in made.stream.channels)
    with PtyServer(replace(made.stream, channels=channels), made, rate_hz=0, kind=FRAME_64) as device:
        watched = watching_all(device, 100, quiet=True)
    assert watched.log.moment == pytest.approx(1000 * made.values[:, 3:])


def test_a_sample_without_a_component_is_passed_over_and_counted() -> None:
    made = recording(0.5)
    made.valid[10:13, 4] = False
    with PtyServer(made.stream, made, rate_hz=0) as device:
        watched = watching_all(device, 97, quiet=True)
    assert len(watched.log) == 97 and "3 samples lacked a component" in watched.notes[0]


@pytest.mark.parametrize(
    ("stream", "says"),
    [
        (Stream("skin", (Channel("S1"),), 100.0), "has no column Fx, Fy"),
        (Stream("tip", tuple(Channel(name) for name in ("Fx", "Fy", "Fz", "Mx", "My", "Mz")), 0.0), "how many samples come a second"),
    ],
)
def test_a_port_of_something_else_is_refused(stream: Stream, says: str) -> None:
    values = np.ones((20, len(stream.channels)))
    made = Recording.of_values(stream, values, device_time=np.arange(20) / 100)
    with PtyServer(stream, made, rate_hz=100) as device, pytest.raises(InputError, match=says):
        watching(device, seconds=1)


def test_a_silent_port_is_told() -> None:
    made = recording(0.1)
    made.valid[:] = False
    with PtyServer(made.stream, made) as device, pytest.raises(InputError, match="no whole sample"):
        watching(device, seconds=0.5)


def test_an_offset_is_taken_off_after_a_rest() -> None:
    made = recording(3.0)
    log, _ = grasp_log(seed=3, episodes=4)
    with PtyServer(made.stream, made, rate_hz=0, kind=FRAME_64) as device:
        watched = watching_all(device, 500, tare=0.5, quiet=True)
    offset = log.force[:100].mean(axis=0)
    assert len(watched.log) == 500 and np.abs(offset).max() > 0.01
    assert watched.log.force == pytest.approx(made.values[100:, :3] - offset)


def test_a_touch_while_it_is_to_rest_is_refused() -> None:
    made = recording(3.0)
    with PtyServer(made.stream, made, rate_hz=0) as device, pytest.raises(InputError, match="something touches"):
        watching(device, seconds=60, tare=2.0, quiet=True)


def test_moments_in_n_m_whose_unit_no_device_names_are_refused() -> None:
    made = recording(4.0)
    channels = tuple(replace(each, unit="") for each in made.stream.channels)
    values = made.values * np.array([1, 1, 1, 1e-3, 1e-3, 1e-3])
    with (
        PtyServer(replace(made.stream, channels=channels), replace(made, values=values), rate_hz=0, kind=FRAME_64) as device,
        pytest.raises(InputError, match="so the moments are in N m"),
    ):
        watching(device, seconds=60, quiet=True)


def test_a_model_straightens_what_a_port_sends() -> None:
    made = recording(1.0)
    twice = TouchModel(2 * np.eye(6), SensorNoise(), "a dome of 20 mm", np.zeros((36, 36)))
    with PtyServer(made.stream, made, rate_hz=0, kind=FRAME_64) as device:
        watched = watching_all(device, 200, model=twice, quiet=True)
    assert watched.log.moment == pytest.approx(2 * made.values[:, 3:])
