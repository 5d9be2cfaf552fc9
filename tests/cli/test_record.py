"""skinfab record as it is called: a simulator, a port, Ctrl-C, and what cannot be."""

import io
import itertools
import json
import os
import pty
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from skinfab.cli.listening import outage_notes
from skinfab.cli.main import main
from skinfab.readout.faults import Faults
from skinfab.readout.logs.log import read_log
from skinfab.readout.pty_server import PtyServer
from skinfab.readout.strain_simulator import strain_frames, strain_stream

STREAM = strain_stream(channels=3, rate_hz=200.0)


@pytest.mark.parametrize("suffix", [".frames", ".csv"])
def test_the_simulator_is_recorded_and_labelled(tmp_path: Path, capsys: pytest.CaptureFixture[str], suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    began = time.monotonic()
    assert main(["record", "simulator", "-o", str(path), "--seconds", "1.2", "--channels", "4", "--rate", "50"]) == 0
    took = time.monotonic() - began
    out = capsys.readouterr()
    found = read_log(path).recording
    assert found.stream.simulated and len(found.stream.channels) == 4
    # A busy machine ends it a few frames short, or goes on for some; never are there more than come in the time it took.
    assert 40 <= len(found) <= 50 * took + 1 and found.host_time[-1] - found.host_time[0] == pytest.approx((len(found) - 1) / 50, abs=1e-3)
    assert out.out == f"{path}: {len(found)} frames of simulated data, 4 channels, {path.stat().st_size / 1e6:.2f} MB, lost 0\n"


def test_a_port_is_recorded_and_what_went_wrong_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    faults = Faults(garbage=0.1, twice=0.1, unplugged={100: 0.2})
    with PtyServer(STREAM, strain_frames(STREAM), faults=faults) as device:
        assert main(["record", str(device.path), "-o", str(tmp_path / "a.frames"), "--seconds", "2", "--json"]) == 0
    out = capsys.readouterr()
    result = json.loads(out.out)
    assert out.err == "" and result["frames"] == len(read_log(tmp_path / "a.frames").recording) > 200
    assert result["counts"]["reopened"] == 1 and result["counts"]["bad"] > 10 and result["counts"]["lost"] > 5
    for words in ("pieces were no frame", "frames came late or a second time"):
        assert any(words in note for note in result["notes"])
    (gone,) = result["outages"]
    assert gone["back"] and 0.3 < gone["after_s"] < 0.8 and 0.1 < gone["lasted_s"] < 0.6
    assert any(f"was gone from {gone['after_s']:.1f} s on, for {gone['lasted_s']:.1f} s" in note for note in result["notes"])


def test_a_port_that_vanished_for_good_is_said_with_when_and_how_long(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with PtyServer(STREAM, itertools.islice(strain_frames(STREAM), 100)) as device:
        assert main(["record", str(device.path), "-o", str(tmp_path / "a.frames"), "--seconds", "2", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    (gone,) = result["outages"]
    assert result["frames"] == 100 and result["counts"]["lost"] == 0  # by the device's count nothing is missing: only this tells
    assert not gone["back"] and gone["after_s"] + gone["lasted_s"] == pytest.approx(2.0, abs=0.2) and gone["lasted_s"] > 1
    (note,) = result["notes"]
    assert f"did not come back: the last {gone['lasted_s']:.1f} s are missing" in note


def test_many_outages_are_a_few_sentences() -> None:
    gone = [{"after_s": float(k), "lasted_s": 0.5, "back": k < 9} for k in range(10)]
    notes = outage_notes("P", gone)
    assert len(notes) == 4 and notes[2] == "P was gone 7 more times, for 3.5 s" and "did not come back" in notes[3]


def test_lines_without_a_checksum_are_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with PtyServer(STREAM, strain_frames(STREAM), ascii_lines=True) as device:
        assert main(["record", str(device.path), "-o", str(tmp_path / "a.csv"), "--seconds", "0.5"]) == 0
    assert "without a checksum" in capsys.readouterr().err


@contextmanager
def talking(lines: Iterable[bytes]) -> Iterator[str]:
    """A port on which a board says one of these every 20 ms."""
    ours, theirs = pty.openpty()
    stop = threading.Event()

    def talk() -> None:
        for line in lines:
            if stop.wait(0.02):
                return
            os.write(ours, line)

    board = threading.Thread(target=talk)
    board.start()
    try:
        yield os.ttyname(theirs)
    finally:
        stop.set()
        board.join()
        os.close(ours)
        os.close(theirs)


def test_where_nothing_was_recorded_what_comes_next_does_not_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Names parted by spaces are one name, over two numbers parted by a tab."""
    with talking(itertools.repeat(b"time_s A B\n0.5\t1.25\n")) as port:
        assert main(["record", port, "-o", str(tmp_path / "a.csv"), "--seconds", "0.5"]) == 1
    out = capsys.readouterr()
    assert out.out == "" and not (tmp_path / "a.csv").exists() and "no frame came; no file was left" in out.err
    assert r"the line '0.5\t1.25' has 2 numbers where 1 is named ('time_s A B'); part the names as the numbers" in out.err


@pytest.mark.parametrize(("heading", "doubted"), [(b"", True), (b"A,B\n", False)])
def test_one_number_with_a_decimal_comma_may_be_two_channels(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], heading: bytes, doubted: bool
) -> None:
    with talking(heading + b"1,%03d\n" % (50 + k % 200) for k in itertools.count()) as port:
        assert main(["record", port, "-o", str(tmp_path / "a.csv"), "--seconds", "0.5", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    told = [note for note in result["notes"] if "may be one number with a decimal comma; let the board print points" in note]
    assert len(result["channels"]) == 2 and len(told) == doubted


def test_a_board_whose_numbers_cannot_be_told_apart_is_told_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Decimal commas between commas: two numbers look like four."""
    with talking(itertools.repeat(b"S1,S2\n0,871,1,25\n")) as port:
        assert main(["record", port, "-o", str(tmp_path / "a.csv"), "--seconds", "0.5", "--json"]) == 1
    result = json.loads(capsys.readouterr().out)
    assert result["frames"] == 0 and not (tmp_path / "a.csv").exists()
    bad, none, why = result["notes"]
    assert "pieces were no frame" in bad and none == "no frame came; no file was left"
    assert "'0,871,1,25' has 4 numbers where 2 are named; are these decimal commas? Print points, or part" in why


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_on_a_terminal_it_is_said_how_it_goes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    assert main(["record", "simulator", "-o", str(tmp_path / "a.frames"), "--seconds", "1.3"]) == 0
    first, *_, last = terminal.getvalue().split("\r\x1b[K")[1:]
    assert re.fullmatch(
        r"0:01  \d+ frames  \d+\.\d Hz  0\.\d MB  lost 0  bad 0  late 0  disk [\d.]+ GB left, (\d+ days|for ever|[\d:]+)  \(Ctrl-C ends\)",
        first,
    )
    assert last == ""  # the line is gone when it is over
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    assert main(["record", "simulator", "-o", str(tmp_path / "b.frames"), "--seconds", "0.1", "--json"]) == 0
    assert terminal.getvalue() == ""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_ends_a_recording_that_is_whole(tmp_path: Path, number: int) -> None:
    path = tmp_path / "a.frames"
    command = [sys.executable, "-m", "skinfab", "record", "simulator", "-o", str(path), "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            for _ in range(300):
                if path.exists() and path.stat().st_size > 5000:
                    break
                time.sleep(0.05)
            process.send_signal(number)
            out, err = process.communicate(timeout=30)
        finally:
            process.kill()  # does nothing to one that has ended
    assert process.returncode == 0 and err == ""
    assert json.loads(out)["frames"] == len(read_log(path).recording) > 5


def test_no_room_is_one_line_status_1_and_what_was_recorded_stays(tmp_path: Path) -> None:
    path = tmp_path / "a.frames"
    # A limit on the size of files is what a test can have of a full disk.
    code = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000)); from skinfab.cli.main import main; "
    code += f"raise SystemExit(main(['record', 'simulator', '-o', {str(path)!r}]))"
    done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert "cannot write" in done.stderr and "frames recorded before are in it" in done.stderr
    found = read_log(path)
    assert len(found.recording) > 20 and found.notes == ()


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        (["record", "/dev/none", "-o", "a.frames"], 1, "there is no port /dev/none"),
        (["record", "simulator", "-o", "a.bin"], 1, "call a recording .frames"),
        (["record", "simulator", "-o", "there.frames"], 1, "never overwritten"),
        (["record", "simulator"], 2, "-o"),
        (["record", "simulator", "-o", "a.frames", "--baud", "9600"], 2, "--baud is of a port"),
        (["record", "/dev/none", "-o", "a.frames", "--channels", "3"], 2, "are of the simulator"),
        (["record", "simulator", "-o", "a.frames", "--channels", "0"], 2, "from 1 to 256"),
        (["record", "simulator", "-o", "a.frames", "--seconds", "0"], 2, "not a positive number"),
        (["record", "/dev/none", "-o", "a.frames", "--baud", "fast"], 2, "no baud rate"),
    ],
)
def test_what_cannot_be_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, words: list[str], status: int, says: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("there.frames").write_text("mine")
    assert main(words) == status
    assert says in capsys.readouterr().err.splitlines()[-1]
    assert [p.name for p in tmp_path.iterdir()] == ["there.frames"]
