"""`skinfab nail run --port`: decisions on what a port sends, as it comes."""

import itertools
import json
import math
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from interrupts import pressed, pressed_twice

from skinfab.cli.main import main
from skinfab.cli.nail_port import _Speaker
from skinfab.fingertip.nail.live import NailWatch, Told
from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.reader import Decision
from skinfab.fingertip.nail.regress import Continuous
from skinfab.fingertip.nail.simulator import nail_frames, nail_stream, participant
from skinfab.fingertip.nail.units import units_note
from skinfab.readout.faults import Faults
from skinfab.readout.frame import Frame, Stream
from skinfab.readout.pty_server import PtyServer

FILES = ["decisions.csv", "nail.png", "result.json"]


@pytest.fixture(scope="module")
def model(nail_model: Path) -> Path:
    return nail_model


@contextmanager
def served(stream: Stream, frames: list[Frame], faults: Faults | None = None) -> Iterator[PtyServer]:
    """At the sensor's pace, or slower where the machine is busy, but all of them; none comes before it is watched."""
    ready = threading.Event()
    opened = NailWatch.__init__

    def opening(*args: Any, **options: Any) -> None:
        opened(*args, **options)
        ready.set()

    def sent() -> Iterator[Frame]:
        for k, frame in enumerate(frames):
            yield frame  # the first one brings the description, which is waited for
            if k == 0:
                ready.wait(30)
            if k % 14 == 0:
                time.sleep(0.01)

    with pytest.MonkeyPatch.context() as patch, PtyServer(stream, sent(), rate_hz=0, faults=faults) as device:
        patch.setattr(NailWatch, "__init__", opening)
        yield device


def test_run_on_a_port(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    finger, stream = participant(np.random.default_rng([0, 1])), nail_stream()
    frames = list(itertools.islice(nail_frames(finger, [None, TESTS["pins6"][0], TESTS["pins6"][5]], hold_s=0.4), 1680))
    with served(stream, frames) as device, pressed(NailWatch, after=1600):
        assert main(["nail", "run", str(model), "--port", str(device.path), "--seconds", "60", "-o", str(tmp_path / "o")]) == 0
    said = capsys.readouterr().out
    assert "none" in said.splitlines()[0] and "confidence" in said and "to the decision:" in said
    found = json.loads((tmp_path / "o/result.json").read_text())
    latency = found["latency_ms"]
    assert found["simulated"] and found["frames"] == 1600 and found["lost"] == 0
    assert 0 < latency["median"] <= latency["p99"] <= latency["worst"] and sum(latency["histogram"]["counts"]) == found["windows"]
    assert found["touched"]["none"] > 0.2 * found["windows"]


def test_a_port_that_goes_away_is_told(
    model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pulled out after 0.2 s, for longer than is waited: said while nothing comes, and of what came."""
    from skinfab.cli import listening

    monkeypatch.setattr(listening, "_SILENT_S", 0.3)
    frames = list(itertools.islice(nail_frames(participant(np.random.default_rng([0, 1])), [None], hold_s=0.4), 1120))
    with served(nail_stream(), frames, Faults(unplugged={280: 30.0})) as device:
        assert main(["nail", "run", str(model), "--port", str(device.path), "--seconds", "2", "-o", str(tmp_path / "o")]) == 0
    said = capsys.readouterr()
    assert said.err.count(f"nothing comes from {device.path}") == 1
    found = json.loads((tmp_path / "o/result.json").read_text())
    (gone,) = found["outages"]
    assert not gone["back"] and "did not come back" in said.err and any("look at its cable" in note for note in found["notes"])


def test_what_gathers_before_the_first_reading_is_passed_over_and_makes_nothing_late(
    model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from skinfab.fingertip.nail import live
    from skinfab.readout.source import HostClock

    ready: list[float] = []
    seen: list[float] = []

    class Awaited(live.NailWatch):
        def __init__(self, *args, **options):  # type: ignore[no-untyped-def]
            super().__init__(*args, **options)
            while device.sent < 250:
                time.sleep(0.01)
            ready.append(HostClock().now())

        def step(self, frame):  # type: ignore[no-untyped-def]
            seen.append(frame.host_time)
            return super().step(frame)

    frames = list(itertools.islice(nail_frames(participant(np.random.default_rng([0, 1])), [None], hold_s=0.4), 1120))
    with pytest.MonkeyPatch.context() as patched, PtyServer(nail_stream(), frames) as device:
        patched.setattr(live, "NailWatch", Awaited)
        assert main(["nail", "run", str(model), "--port", str(device.path), "--seconds", "1", "-o", str(tmp_path / "o"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert seen and min(seen) >= ready[0] - 0.001
    assert found["passed_over"] > 100 and found["frames"] == len(seen) and found["latency_ms"]["histogram"]["edges"][-1] is None


def test_a_machine_that_cannot_keep_up_is_told(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from skinfab.fingertip.nail import live

    class Slow(live.NailWatch):
        def step(self, frame):  # type: ignore[no-untyped-def]
            begun = time.thread_time()
            while time.thread_time() < begun + 0.002:  # where one frame comes every 0.7 ms
                pass
            return super().step(frame)

    frames = list(itertools.islice(nail_frames(participant(np.random.default_rng([0, 1])), [None], hold_s=0.4), 1680))
    with pytest.MonkeyPatch.context() as patched, PtyServer(nail_stream(), frames) as device:
        patched.setattr(live, "NailWatch", Slow)
        assert main(["nail", "run", str(model), "--port", str(device.path), "--seconds", "2", "-o", str(tmp_path / "o"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    # It is the deciding: a machine on which something else runs beside it gives less of the time to it, and says so.
    assert any("behind in the median" in note and ("--every" in note) == (found["deciding"] > 0.5) for note in found["notes"])


def test_what_a_port_says_aloud(capsys: pytest.CaptureFixture[str]) -> None:
    """No confidence where none is known, a window of the published method at once, and a force at the end of what was learned as such."""
    unsure = Decision("pin 1", math.nan, True, False, Continuous())
    _Speaker(False, agree=1).hear(Told(1.0, unsure, 169.0, 0.0))
    assert capsys.readouterr().out == "    1.000 s  pin 1\n"
    hard = Decision("pin 1", 0.9, True, False, Continuous(force_n=2.9, force_end="high"))
    speaker = _Speaker(False, agree=2)
    speaker.hear(Told(1.0, hard, 169.0, 0.0))
    assert capsys.readouterr().out == ""
    speaker.hear(Told(1.1, hard, 169.0, 0.0))
    assert capsys.readouterr().out == "    1.100 s  pin 1  confidence 0.90  2.90 N or more\n"


@pytest.mark.parametrize("learned", [None, True, False])
def test_units_of_a_port(learned: bool | None) -> None:
    bare = replace(nail_stream(), channels=tuple(replace(each, unit="") for each in nail_stream().channels))
    assert [len(units_note(learned, stream, "stream")) for stream in (nail_stream(), bare)] == [int(learned is False), int(learned is True)]


def test_a_second_ctrl_c_loses_nothing(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    capsys.readouterr()
    frames = list(itertools.islice(nail_frames(participant(np.random.default_rng([0, 1])), [None], hold_s=0.4), 560))
    with (
        served(nail_stream(), frames) as device,
        pressed_twice(NailWatch, "skinfab.fingertip.nail.figure.draw_run", after=200),
    ):
        assert main(["nail", "run", str(model), "--port", str(device.path), "--seconds", "60", "-o", str(tmp_path / "o"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert json.loads((tmp_path / "o/result.json").read_text()) == found and found["frames"] == 200
    assert sorted(each.name for each in (tmp_path / "o").iterdir()) == FILES
    assert len((tmp_path / "o/decisions.csv").read_text().splitlines()) == 2 + found["windows"] > 15
