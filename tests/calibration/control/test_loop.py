"""The loop in real time: through a pseudo-terminal, closed over the simulated finger, and with frames that stay away."""

import time

import numpy as np
import pytest

from calibration.control.controller import RESUME_DEG_S2, Input, JointController
from calibration.control.loop import FingerBoard, Loop, run_loop
from calibration.control.protocols import Motion, uniform
from calibration.finger.logs import calibrated
from calibration.finger.simulated import HUMAN, ROBOT, Plant
from skinfab.errors import InputError
from skinfab.readout.paced import PacedFrames
from skinfab.readout.pty_server import PtyServer
from skinfab.readout.serial_port import SerialPort

pytestmark = pytest.mark.usefixtures("tidied")


@pytest.fixture(scope="module")
def inputs() -> tuple[Input, Input]:
    return Input(calibrated(HUMAN, "branches"), 0), Input(calibrated(ROBOT, "branches"), 1)


def test_over_a_pseudo_terminal(inputs: tuple[Input, Input]) -> None:
    """Two seconds of the uniform protocol: every frame answered, and the joint where the human's is."""
    motion = uniform(length_s=3.0)
    board = FingerBoard(motion, seed=0)
    with PtyServer(board.stream, board) as device, SerialPort(device.path) as port:
        loop = run_loop(port, JointController(*inputs, gain=4.0), board.command, seconds=2.0)
        counts = port.counts
    answered = loop.sequence >= 0
    assert np.count_nonzero(answered) + loop.passed_over >= 180 and counts.bad == 0
    assert (np.diff(loop.sequence[answered]) > 0).all()
    # How long it takes is for the benchmark; here only that it is measured from the frame's making on.
    whole = loop.sent_at[answered] - np.array(board.made)[loop.sequence[answered]]
    assert (whole > 0).all() and (loop.latency_s[answered] > 0).all() and (loop.latency_s[answered] < whole + 1e-3).all()
    error = np.array(board.robot[:180]) - motion.angle[:180]
    assert abs(error).mean() < 10 and loop.commands[-1].state == "run"


def test_frames_that_stay_away_stop_the_joint(inputs: tuple[Input, Input]) -> None:
    board = FingerBoard(uniform(length_s=0.5), seed=0)
    sent: list[float] = []
    with PacedFrames(board.stream, lambda: board) as source:
        loop = run_loop(
            source, JointController(*inputs, gain=4.0), lambda speed: (sent.append(speed), board.command(speed))[0], seconds=1.0
        )
    states = [command.state for command in loop.commands]
    # On a machine that is busy elsewhere the first frame may be late already.
    began = states.index("run")
    assert states[-1] == "stop" and "hold" in states[began:]
    assert sent[-1] == 0.0 and np.isnan(loop.latency_s[-1]) and loop.sequence[-1] == -1


def test_the_first_command_is_no_jump(inputs: tuple[Input, Input]) -> None:
    """The joint stands at 10 degrees, and the human's is at 80: 280 deg/s at once, were it not for the ramp."""
    # Before the loop begins memory is tidied, which may take a second.
    motion = Motion("far", np.arange(400) / 100, np.full(400, 80.0))
    near = FingerBoard(Motion("near", motion.time, np.full(400, 10.0)), seed=0)
    human, robot = next(iter(FingerBoard(motion, seed=0))), next(iter(near))
    assert JointController(*inputs, gain=4.0).step(human.host_time, human, robot).speed > 200

    board = FingerBoard(motion, seed=0, plant=Plant())
    board._finger = near._finger
    sent: list[float] = []
    with PacedFrames(board.stream, lambda: board) as source:
        loop = run_loop(source, JointController(*inputs, gain=4.0), sent.append, seconds=0.4)
    first = next(k for k, command in enumerate(loop.commands) if command.state == "run")
    since = loop.time - loop.time[first]
    assert loop.commands[first].clamped and (np.abs(sent[:-1]) <= RESUME_DEG_S2 * (since + 0.03))[first:].all() and max(sent) > 50


def test_a_hand_that_takes_no_more_commands_ends_it_and_the_record_stays(inputs: tuple[Input, Input]) -> None:
    board = FingerBoard(uniform(length_s=1.0), seed=0)
    sent: list[float] = []

    def send(speed: float) -> None:
        sent.append(speed)
        if len(sent) >= 5:
            raise InputError("it is gone")

    with PacedFrames(board.stream, lambda: board) as source:
        loop = run_loop(source, JointController(*inputs, gain=4.0), send, seconds=1.0)
    assert loop.fault == "it is gone" and len(loop.commands) == len(loop.time) == 4
    assert len(sent) == 6 and sent[-1] == 0.0  # a last try


def test_a_hand_that_is_gone_when_it_should_stop_is_told(inputs: tuple[Input, Input]) -> None:
    board = FingerBoard(uniform(length_s=5.0), seed=0)  # before the loop begins memory is tidied, which may take a second
    driven: list[float] = []

    def send(speed: float) -> None:
        driven.append(speed)
        if speed == 0.0 and any(driven):
            raise InputError("it is gone")

    with PacedFrames(board.stream, lambda: board) as source:
        loop = run_loop(source, JointController(*inputs, gain=4.0), send, seconds=0.3)
    assert loop.fault == "it is gone" and len(loop.commands) > 5


def test_whatever_happens_the_joint_is_stopped(inputs: tuple[Input, Input]) -> None:
    board = FingerBoard(uniform(length_s=1.0), seed=0)
    sent: list[float] = []

    def send(speed: float) -> None:
        sent.append(speed)
        if len(sent) == 5:
            raise KeyboardInterrupt

    with PacedFrames(board.stream, lambda: board) as source, pytest.raises(KeyboardInterrupt):
        run_loop(source, JointController(*inputs, gain=4.0), send, seconds=1.0)
    assert sent[-1] == 0.0 and len(sent) == 6


def test_a_late_reader_answers_the_newest_frame(inputs: tuple[Input, Input]) -> None:
    board = FingerBoard(uniform(length_s=1.0), seed=0)
    with PacedFrames(board.stream, lambda: board) as source:
        loop = run_loop(source, JointController(*inputs, gain=4.0), lambda speed: time.sleep(0.035), seconds=0.6)
    answered = loop.sequence[loop.sequence >= 0]
    assert loop.passed_over > len(answered) and np.nanmax(loop.latency_s[loop.sequence >= 0]) < 0.5


def test_jitter_is_that_between_commands() -> None:
    sent = np.array([0.0, 0.01, 0.02, 0.035, 0.04])
    loop = Loop(sent, sent, np.array([0, 1, 2, -1, 3]), np.zeros(5), 0, (), "")
    assert loop.jitter_s == pytest.approx([0.0, 0.0, 0.01])
