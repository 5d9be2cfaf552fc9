"""What a port sends, decided as it comes, with how long each decision took."""

from __future__ import annotations

import time
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from skinfab.fingertip.nail.classify import NailModel
    from skinfab.fingertip.nail.histogram_model import HistogramModel as _Published
    from skinfab.fingertip.nail.live import Told
    from skinfab.fingertip.nail.regress import Regression

#: A contact is said when so many decisions in a row agree: of windows of 33 readings, 8 apart, the fifth shares none with the first.
_AGREE = 5
_OFF = "the motor does not turn"
#: Edges of the histogram of latencies, ms.
_EDGES_MS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)


def watch_port(
    port: str,
    model: NailModel | _Published,
    regression: Regression | None,
    *,
    samples: int,
    every: int,
    baud: int | None,
    seconds: float | None,
    rate_hz: float | None,
    units_said: bool | None,
    quiet: bool,
    until_written: ExitStack,
) -> tuple[list[Told], dict[str, Any]]:
    """Decide on what a port sends until Ctrl-C, or for a while; what is touched is printed as it changes.

    Once the port is open Ctrl-C is held off in `until_written`, which the caller leaves when what came is written.

    Raises
    ------
    InputError
        The port cannot be read, or what it sends is not what the model learned from.
    """
    from skinfab.cli.ending import ended_by_signals
    from skinfab.cli.listening import Listening
    from skinfab.fingertip.nail.histogram_model import HistogramModel
    from skinfab.fingertip.nail.live import NailWatch
    from skinfab.fingertip.nail.units import absent, units_note
    from skinfab.readout.serial_port import BAUD, SerialPort
    from skinfab.readout.source import HostClock

    told: list[Told] = []
    latency: list[float] = []
    speaker = _Speaker(quiet, agree=1 if isinstance(model, HistogramModel) else _AGREE)
    with SerialPort(port, baud=baud or BAUD) as source:
        stop = until_written.enter_context(ended_by_signals())
        watch = NailWatch(model, source.stream, samples=samples, every=every, regression=regression, rate_hz=rate_hz)
        listening = Listening(source, stop, seconds=seconds, quiet=quiet)
        clock = HostClock()
        began, frames, passed_over, busy = clock.now(), 0, 0, 0.0
        for frame in listening.frames():
            if frame.host_time < began:  # what gathered meanwhile is old, and would make all that follows late
                passed_over += 1
                continue
            frames += 1
            before = time.thread_time()  # of this alone: whatever else runs makes it wait for a processor too
            made = watch.step(frame)
            busy += time.thread_time() - before
            if made is not None:
                latency.append(1000 * (clock.now() - frame.host_time))
                told.append(made)
                speaker.hear(made)
        counts = source.counts
        facts = {
            "source": port,
            "sha256": None,
            "simulated": source.stream.simulated,
            "frames": frames,
            "passed_over": passed_over,
            "lost": max(watch.lost, counts.lost),
            "window_readings": watch.samples,
            "latency_ms": latency_facts(latency),
            "deciding": min(busy / max(clock.now() - began, 1e-9), 1.0),
            "outages": listening.outages,
            "notes": [
                *absent(source.stream),
                *units_note(units_said, source.stream, "stream"),
                *listening.notes,
                *[f"{counts.bad} packets were damaged"] * bool(counts.bad),
            ],
        }
    return told, facts


def latency_facts(latency_ms: list[float]) -> dict[str, Any] | None:
    """Median, 99 %, worst, and counts between edges, of which the last is None, as the last count has no end; None of nothing.

    Examples
    --------
    >>> found = latency_facts([0.15, 0.3, 300.0])
    >>> found["worst"], found["histogram"]["edges"][-2:], found["histogram"]["counts"][-1]
    (300.0, [50.0, None], 1)
    """
    import numpy as np

    if not latency_ms:
        return None
    each = np.array(latency_ms)
    counts = np.histogram(each, [0.0, *_EDGES_MS, np.inf])[0]
    quantiles = {name: float(np.quantile(each, part)) for name, part in (("median", 0.5), ("p99", 0.99), ("worst", 1.0))}
    return {**quantiles, "histogram": {"edges": [0.0, *_EDGES_MS, None], "counts": counts.tolist()}}


class _Speaker:
    """Prints what is touched when it changes and stays for a moment."""

    def __init__(self, quiet: bool, *, agree: int) -> None:
        # Windows of the published method share no readings, so one is as good as five that do.
        self._needed = agree
        self._quiet, self._said, self._last, self._agree = quiet, "", "", 0

    def hear(self, told: Told) -> None:
        """Take a decision; print it where it is news."""
        if not self._quiet and told.turning is False and self._said != _OFF:
            self._said = _OFF
            print(f"{told.time_s:9.3f} s  {_OFF}", flush=True)
        if self._quiet or (decision := told.decision) is None:
            return
        self._agree = self._agree + 1 if decision.label == self._last else 1
        self._last = decision.label
        if self._agree < self._needed or decision.label == self._said:
            return
        self._said = decision.label
        found = decision.continuous
        parts = [f"{told.time_s:9.3f} s  {decision.label}"]
        if decision.contact:
            parts += [f"confidence {decision.confidence:.2f}"] * (decision.confidence == decision.confidence)
            parts += [f"{found.angle_deg:.0f} deg"] * (found.angle_deg == found.angle_deg)
            parts += [f"at {found.x_mm:+.1f}, {found.y_mm:+.1f} mm"] * (found.x_mm == found.x_mm)
            beyond = {"high": " or more", "low": " or less", "": ""}[found.force_end]
            parts += [f"{found.force_n:.2f} N{beyond}"] * (found.force_n == found.force_n)
            parts += ["like nothing learned"] * decision.strange
        print("  ".join(parts), flush=True)
