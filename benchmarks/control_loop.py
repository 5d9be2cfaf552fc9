"""The controller at 100 Hz over a pseudo-terminal, closed over the simulated finger: how long from frame to command?

``python benchmarks/control_loop.py [--seconds 20] [--rounds 3] [--figure FILE.png]``. The board is a process of its own; both
processes read one monotonic clock, and the board notes when it makes each frame, so that the latency is the whole way: reading
the simulated sensors, packing, the terminal, unpacking, waking the controller, and its step. The default controller is used.

How long a program is kept waiting depends on what else the machine does. So three are run in turn, round by round: the loop
with real-time priority where that is granted, the loop without, and a bare one, which does nothing but write 48 bytes to a
terminal at one end and read them at the other: no program in Python could be faster.
"""

from __future__ import annotations

import argparse
import gc
import multiprocessing
import os
import time
import tty
from contextlib import nullcontext
from multiprocessing.connection import Connection
from multiprocessing.sharedctypes import Synchronized
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calibration.control.controller import Input, JointController
from calibration.control.loop import FingerBoard, Loop, run_loop
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


#: What a bare loop's board sends, bytes: as much as a packet of two channels.
PACKET = 48
RATE = 100


def device(seconds: float, speed: Synchronized, line: Connection) -> None:
    """Serve the board, then say when each frame was made and where the joint was."""
    board = Driven(seconds, speed)
    gc.collect()
    gc.freeze()  # a real board has no garbage collector that stops it for 30 ms, and runs no other programs
    with real_time(), PtyServer(board.stream, board) as server:
        line.send(str(server.path))
        server.wait()
    line.send((board.made, board.robot))


def bare_device(seconds: float, line: Connection) -> None:
    """Write to a terminal at the same rate, then say when."""
    ours, theirs = os.openpty()
    tty.setraw(theirs)
    line.send(os.ttyname(theirs))
    line.recv()
    made = []
    with real_time():
        began = time.monotonic()
        for k in range(round(seconds * RATE)):
            time.sleep(max(began + k / RATE - time.monotonic(), 0.0))
            made.append(time.monotonic())
            os.write(ours, bytes(PACKET))
    line.send(made)


class Bench:
    """Processes, and the controller's inputs."""

    def __init__(self) -> None:
        self.human, self.robot = Input(calibrated(HUMAN, "branches"), 0), Input(calibrated(ROBOT, "branches"), 1)
        self.gain = judged(self.robot, "full", None, lag_s=0.1, delay_s=0.05, period_s=1 / RATE).gain
        self.context = multiprocessing.get_context("spawn")

    def closed(self, seconds: float, *, first: bool) -> tuple[Loop, NDArray[np.float64], str]:
        """The loop closed over the finger; latencies of its answers in ms, and a sentence."""
        speed = self.context.Value("d", 0.0)
        ours, theirs = self.context.Pipe()
        process = self.context.Process(target=device, args=(seconds + 2.0, speed, theirs), daemon=True)
        process.start()

        def send(command: float) -> None:
            speed.value = command

        path = ours.recv()
        with real_time() if first else nullcontext(False) as granted, SerialPort(path) as port:
            cpu = time.process_time()
            loop = run_loop(port, JointController(self.human, self.robot, gain=self.gain), send, seconds=seconds)
            cpu = time.process_time() - cpu
            made, joint = (np.array(each) for each in ours.recv())
            counts = port.counts
        process.join()
        answered = loop.sequence >= 0
        # A frame that was passed over waited for the command that came in its stead: the oldest that had none counts.
        oldest = np.concatenate([loop.sequence[answered][:1], loop.sequence[answered][:-1] + 1])
        jitter = 1e3 * np.abs(loop.jitter_s)
        n = round(seconds * RATE)
        error = np.abs(joint[:n] - uniform(length_s=seconds).angle[:n])
        said = (
            f"{'with' if granted else 'without'} real-time priority: {answered.sum()} frames answered in {seconds:g} s, {loop.passed_over} "
            f"passed over, {counts.lost} lost; jitter 99 % {np.quantile(jitter, 0.99):.2f}, worst {jitter.max():.2f} ms; "
            f"{100 * cpu / seconds:.1f} % of one core; mean error {error.mean():.2f} degrees"
        )
        return loop, 1e3 * (loop.sent_at[answered] - made[oldest]), said

    def bare(self, seconds: float) -> NDArray[np.float64]:
        """From writing to reading, ms."""
        ours, theirs = self.context.Pipe()
        process = self.context.Process(target=bare_device, args=(seconds, theirs), daemon=True)
        process.start()
        terminal = os.open(ours.recv(), os.O_RDWR | os.O_NOCTTY)
        ours.send(None)
        read: list[float] = []
        size, wanted = 0, round(seconds * RATE)
        while len(read) < wanted:
            size += len(os.read(terminal, 4096))
            read += [time.monotonic()] * (size // PACKET - len(read))
        made = np.array(ours.recv())
        process.join()
        os.close(terminal)
        return 1e3 * (np.array(read) - made)


def main() -> None:
    """Run it, print a line each, and draw the histogram of the first."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--seconds", type=float, default=20.0)
    p.add_argument("--rounds", type=int, default=3)
    p.add_argument("--figure", type=Path)
    args = p.parse_args()
    bench = Bench()
    taken: dict[str, list[NDArray[np.float64]]] = {}
    for turn in range(args.rounds):
        for name, first in (("real-time priority", True), ("without", False)):
            loop, whole, said = bench.closed(args.seconds, first=first)
            print(said, flush=True)
            taken.setdefault(name, []).append(whole)
            if args.figure and first and not turn:
                latency = np.full(len(loop.sequence), np.nan)
                latency[loop.sequence >= 0] = whole / 1e3
                draw_loop(loop, args.figure, title="100 Hz over a pseudo-terminal (simulated finger)", latency_s=latency)
        taken.setdefault("bare, without", []).append(bench.bare(args.seconds))
    print("from making a frame to the command, ms:")
    for name, parts in taken.items():
        each = np.concatenate(parts)
        median, high, higher = np.quantile(each, (0.5, 0.99, 0.999))
        print(f"{name:20} {len(each):6} median {median:.2f}, 99 % {high:.2f}, 99.9 % {higher:.2f}, worst {each.max():.2f}")


if __name__ == "__main__":
    main()
