"""A port that goes away while a command waits for it: said at once, said when it is back, and told of what came."""

import json
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from interrupts import pressed

from calibration.contact.detector import ContactDetector
from calibration.contact.simulator import simulate
from skinfab.cli import listening
from skinfab.cli.listening import Listening
from skinfab.cli.main import main
from skinfab.fingertip.array.protocols import twirl
from skinfab.fingertip.array.simulator import Device
from skinfab.fingertip.array.watch import ArrayWatch
from skinfab.fingertip.force.motion import MotionWatch
from skinfab.fingertip.force.motion_simulator import grasp_log
from skinfab.fingertip.force.wrench import force_stream
from skinfab.readout.faults import Faults
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.pty_server import PtyServer
from skinfab.readout.serial_port import SerialPort

#: So many frames come when the port is back.
AFTER = 25


def wrenches() -> Recording:
    log, _ = grasp_log(seed=3, episodes=1)
    stream = force_stream("fingertip", 200.0, simulated=True)
    return Recording.of_values(stream, np.column_stack([log.force, log.moment]), device_time=np.arange(len(log)) / 200)


#: With how many frames come before, and how many of all are for a rest before anything is watched.
COMMANDS: tuple[tuple[list[str], type, Callable[[], Recording], int, int], ...] = (
    (["contact"], ContactDetector, lambda: simulate("grip", seed=2).recording, 400, 0),
    (["array", "run", "--port"], ArrayWatch, lambda: twirl(Device(seed=4), seed=4001)[0], 60, 0),
    (["force", "run", "contact", "--port"], MotionWatch, wrenches, 200, 100),
)


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listening, "_SILENT_S", 0.2)
    monkeypatch.setattr(listening, "_SILENT_PERIODS", 0)


@pytest.mark.parametrize(("command", "watch", "made", "before", "rest"), COMMANDS, ids=[" ".join(each[0]) for each in COMMANDS])
def test_a_port_that_goes_away_and_comes_back_is_told(
    command: list[str],
    watch: type,
    made: Callable[[], Recording],
    before: int,
    rest: int,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It comes back once the silence was told, however long a busy machine takes to notice."""
    told, say, plug_in = threading.Event(), listening.steps.say, PtyServer._plug_in

    def saying(notes: list[str], **words: str) -> None:
        say(notes, **words)
        if any("nothing comes" in note for note in notes):
            told.set()

    def plugging_in(device: PtyServer) -> None:
        if device.sent:
            told.wait(20)
        plug_in(device)

    monkeypatch.setattr(listening.steps, "say", saying)
    monkeypatch.setattr(PtyServer, "_plug_in", plugging_in)
    recording = made()
    frames = (recording.frame(k) for k in range(before + AFTER))
    with (
        PtyServer(recording.stream, frames, rate_hz=0, faults=Faults(unplugged={before: 0.0})) as device,
        pressed(watch, after=before + AFTER - rest),
    ):
        assert main([*command, str(device.path), "--seconds", "20", "-o", str(tmp_path / "o")]) == 0
    said = capsys.readouterr().err
    silent, again = f"note: nothing comes from {device.path}; is it plugged in", f"note: {device.path} sends again"
    # Once each time; where the machine is so busy that frames come late, that is a time too.
    assert said.count(silent) == said.count(again) >= 1 and said.index(silent) < said.index(again)
    notes = json.loads((tmp_path / "o/result.json").read_text())["notes"]
    assert sum(f"{device.path} was gone from" in note and " s on, for " in note for note in notes) == 1


@pytest.mark.parametrize("command", [each[0] for each in COMMANDS], ids=" ".join)
def test_a_port_that_was_never_there_is_told_at_once(command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*command, "/dev/ttyNONE", "-o", str(tmp_path / "o")]) == 1
    assert "there is no port /dev/ttyNONE" in capsys.readouterr().err and not (tmp_path / "o").exists()


def listened(quiet: bool, count: int = 3, rate_hz: float = 200.0) -> tuple[list[float], Listening]:
    """Of a port that goes for good after `count` frames, for half a second."""
    stream = Stream("one", (Channel("U"),), rate_hz)
    made = Recording.of_values(stream, np.arange(9.0)[:, None], device_time=np.arange(9) / 200)
    with (
        PtyServer(stream, made, rate_hz=0, faults=Faults(unplugged={count: 30.0})) as device,
        SerialPort(device.path) as source,
    ):
        heard = Listening(source, threading.Event(), seconds=0.5, quiet=quiet)
        return [float(each.values[0]) for each in heard.frames()], heard


def test_what_came_and_why_no_more_did(capsys: pytest.CaptureFixture[str]) -> None:
    came, heard = listened(quiet=True)
    assert came == [0, 1, 2] and capsys.readouterr().err == ""
    assert [each["back"] for each in heard.outages] == [False]
    told = str(heard.too_little("sent too little", "let it send"))
    assert "sent too little; /" in told and "did not come back" in told and "let it send" not in told


def test_a_slow_stream_is_not_silent_between_its_frames(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    listened(quiet=False, rate_hz=1.0)
    assert "nothing comes" in capsys.readouterr().err
    monkeypatch.setattr(listening, "_SILENT_PERIODS", 3)
    listened(quiet=False, rate_hz=1.0)
    assert capsys.readouterr().err == ""


def test_it_ends_at_ctrl_c_and_goes_on_where_it_is_asked_again() -> None:
    stream, stop = Stream("one", (Channel("U"),), 200.0), threading.Event()
    made = Recording.of_values(stream, np.arange(9.0)[:, None], device_time=np.arange(9) / 200)
    with PtyServer(stream, made, rate_hz=0) as device, SerialPort(device.path) as source:
        heard = Listening(source, stop)
        assert float(next(heard.frames()).values[0]) == 0
        assert float(next(heard.frames()).values[0]) == 1
        assert list(heard.frames(for_s=0.0)) == []
        stop.set()
        assert list(heard.frames()) == []
