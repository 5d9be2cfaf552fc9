"""The controller at 100 Hz over a pseudo-terminal, closed over the simulated finger: how long from frame to command?

``python benchmarks/control_loop.py [--seconds 60] [--figure FILE.png]``. The board is a process of its own; both processes read
one monotonic clock, and the board notes when it makes each frame, so that the latency is the whole way: reading the
simulated sensors, packing, the terminal, unpacking, waking the controller, and its step. The default controller is used.
"""

from __future__ import annotations

import argparse
import gc
import multiprocessing
import time
from multiprocessing.connection import Connection
from multiprocessing.sharedctypes import Synchronized
from pathlib import Path

import numpy as np

from calibration.control.controller import Input, JointController
from calibration.control.loop import FingerBoard, run_loop
from calibration.control.loop_figure import draw_loop
from calibration.control.margin import judged
from calibration.control.protocols import uniform
from calibration.finger.logs import calibrated
from calibration.finger.simulated import HUMAN, ROBOT
from skinfab.readout.priority import real_time
from skinfab.readout.pty_server import PtyServer
from skinfab.readout.serial_port import SerialPort


class Driven(FingerBoard):
    """A board that is told its command through memory that both processes share."""

    def __init__(self, seconds: float, speed: Synchronized) -> None:
        super().__init__(uniform(length_s=seconds), seed=0)
        self.told = speed

    def __iter__(self):  # type: ignore[no-untyped-def]
        for frame in super().__iter__():
            self.command(self.told.value)
            yield frame


def device(seconds: float, speed: Synchronized, line: Connection) -> None:
    """Serve the board, then say when each frame was made and where the joint was."""
    board = Driven(seconds, speed)
    gc.collect()
    gc.freeze()  # a real board has no garbage collector that stops it for 30 ms
    with PtyServer(board.stream, board) as server:
        line.send(str(server.path))
        server.wait()
    line.send((board.made, board.robot))


def main() -> None:
    """Run it, print a line, and draw the histogram."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--seconds", type=float, default=60.0)
    p.add_argument("--figure", type=Path)
    args = p.parse_args()
    human, robot = Input(calibrated(HUMAN, "branches"), 0), Input(calibrated(ROBOT, "branches"), 1)
    gain = judged(robot, "full", None, lag_s=0.1, delay_s=0.05, period_s=0.01).gain
    context = multiprocessing.get_context("spawn")
    speed = context.Value("d", 0.0)
    ours, theirs = context.Pipe()
    process = context.Process(target=device, args=(args.seconds + 2.0, speed, theirs), daemon=True)
    process.start()

    def send(command: float) -> None:
        speed.value = command

    with real_time() as granted, SerialPort(ours.recv()) as port:
        cpu = time.process_time()
        loop = run_loop(port, JointController(human, robot, gain=gain), send, seconds=args.seconds)
        cpu = time.process_time() - cpu
        made, joint = (np.array(each) for each in ours.recv())
        counts = port.counts
    process.join()
    answered = loop.sequence >= 0
    # A frame that was passed over waited for the command that came in its stead: the oldest that had none counts.
    oldest = np.concatenate([loop.sequence[answered][:1], loop.sequence[answered][:-1] + 1])
    whole = 1e3 * (loop.sent_at[answered] - made[oldest])
    jitter = 1e3 * np.abs(loop.jitter_s)
    n = round(args.seconds * 100)
    error = np.abs(joint[:n] - uniform(length_s=args.seconds).angle[:n])
    print(
        f"{answered.sum()} frames answered in {args.seconds:g} s, {loop.passed_over} passed over, {counts.lost} lost; "
        f"frame to command: median {np.median(whole):.2f}, 99 % {np.quantile(whole, 0.99):.2f}, 99.9 % {np.quantile(whole, 0.999):.2f}, "
        f"worst {whole.max():.2f} ms; "
        f"jitter 99 % {np.quantile(jitter, 0.99):.2f}, worst {jitter.max():.2f} ms; {100 * cpu / args.seconds:.1f} % of one core; "
        f"mean error {error.mean():.2f} degrees; {'with' if granted else 'without'} real-time priority"
    )
    if args.figure:
        latency = np.full(len(answered), np.nan)
        latency[answered] = whole / 1e3
        draw_loop(loop, args.figure, title="100 Hz over a pseudo-terminal (simulated finger)", latency_s=latency)


if __name__ == "__main__":
    main()
