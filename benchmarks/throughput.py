"""Ten minutes of frames over a pseudo-terminal: are any lost, how evenly do they come, and how late at worst?

``python benchmarks/throughput.py [--minutes 10] [--rates 100x32,1400x6]``. The device is a process of its own; both
processes read one monotonic clock, and the device stamps each frame with it just before it is sent, so that the latency is
the whole way: packing, the terminal, unpacking, and the wake-up of the thread that asked for the frame.
"""

from __future__ import annotations

import argparse
import itertools
import multiprocessing
import time
from collections.abc import Iterator
from dataclasses import replace
from multiprocessing.connection import Connection

import numpy as np

from skinfab.readout.frame import Frame, Stream
from skinfab.readout.pty_server import PtyServer
from skinfab.readout.serial_port import SerialPort
from skinfab.readout.strain_simulator import strain_frames, strain_stream

_GONE_S = 3.0  # so long without a frame, and the device has stopped


def device(stream: Stream, frames: int, line: Connection) -> None:
    """Send so many frames, each stamped with the moment at which it is sent, and say how many went."""
    # One cycle made beforehand, so that the device's own arithmetic takes no time.
    cycle = list(itertools.islice(strain_frames(stream), min(frames, 2000)))

    def stamped() -> Iterator[Frame]:
        for k in range(frames):
            yield replace(cycle[k % len(cycle)], sequence=k, device_time=time.monotonic())

    with PtyServer(stream, stamped()) as server:
        line.send(str(server.path))
        server.wait()
        line.send((server.sent, server.unsent))


def measure(channels: int, rate_hz: float, seconds: float) -> str:
    """One run, in a line."""
    stream = strain_stream(channels=channels, rate_hz=rate_hz)
    ours, theirs = multiprocessing.Pipe()
    process = multiprocessing.get_context("spawn").Process(target=device, args=(stream, round(rate_hz * seconds), theirs), daemon=True)
    process.start()
    came: list[float] = []
    latency: list[float] = []
    with SerialPort(ours.recv()) as port:
        cpu = time.process_time()
        while (frame := port.read(_GONE_S)) is not None:
            now = time.monotonic()
            came.append(now)
            latency.append(now - frame.device_time)
        cpu = time.process_time() - cpu
        counts = port.counts
    sent, unsent = ours.recv()
    process.join()
    late = np.array(latency) * 1e3
    gaps = np.diff(came) * 1e3
    return (
        f"{rate_hz:g} Hz x {channels}: sent {sent}, unsent {unsent}, {counts}; latency ms: median {np.median(late):.3f}, "
        f"p99 {np.percentile(late, 99):.3f}, p99.9 {np.percentile(late, 99.9):.3f}, worst {late.max():.3f}; between frames ms: "
        f"mean {gaps.mean():.3f}, sd {gaps.std():.3f}, longest {gaps.max():.3f}; reader's processor time {cpu / (came[-1] - came[0]):.1%}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--rates", default="100x32,1400x6", help="HZxCHANNELS,...")
    args = parser.parse_args()
    for word in args.rates.split(","):
        rate, channels = word.split("x")
        print(measure(int(channels), float(rate), 60 * args.minutes), flush=True)


if __name__ == "__main__":
    main()
