"""Contacts and unintended motions in what a port sends, told as they come, with how long each decision took."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from skinfab.fingertip.force.contact import Hemisphere
    from skinfab.fingertip.force.contact_mesh import TipMesh
    from skinfab.fingertip.force.logs import WrenchLog
    from skinfab.fingertip.force.motion import Limits, Motion
    from skinfab.fingertip.force.touch_model import TouchModel
    from skinfab.readout.frame import Stream

#: A contact that lasts is told again this often, s.
_AGAIN_S = 1.0
_MS = 1e3
#: Samples with a force after which units are looked at.
_LOOKED_AT = 20
#: Decisions that come so much later than their samples, s, in the median of the last ones, are ever more behind.
_BEHIND_S, _LAST = 0.5, 20


@dataclass(frozen=True, eq=False)
class Watched:
    """What a port sent.

    Parameters
    ----------
    log : WrenchLog
        All samples.
    motions : tuple of Motion
        In order; one that lasted at the end has no end.
    latency_s : (n,) float
        Of each sample that came while it was read on: from when its last byte was read until it was decided on. What had gathered
        before waits for its turn, which says nothing of how long a decision takes.
    simulated : bool
    notes : tuple of str
    """

    log: WrenchLog
    motions: tuple[Motion, ...]
    latency_s: NDArray[np.float64]
    simulated: bool
    notes: tuple[str, ...]

    @property
    def latency(self) -> dict[str, float]:
        """Of the decisions, ms: the median, the 99 % quantile, and the worst; nothing where nothing came while it was read on."""
        import numpy as np

        if not len(self.latency_s):
            return {}
        middle, most, worst = (_MS * np.quantile(self.latency_s, (0.5, 0.99, 1.0))).tolist()
        return {"median_ms": middle, "p99_ms": most, "worst_ms": worst}


def watch_port(
    port: str,
    *,
    limits: Limits,
    seconds: float | None = None,
    baud: int | None = None,
    least_force: float | None = None,
    surface: Hemisphere | TipMesh | None = None,
    tare: float = 0.0,
    model: TouchModel | None = None,
    quiet: bool = False,
    until_written: ExitStack,
) -> Watched:
    """Watch a port until Ctrl-C, or for a while, and tell contacts and motions as they come.

    Parameters
    ----------
    port : str
    limits : Limits
        Of `skinfab.fingertip.force.motion`.
    seconds : float, optional
    baud : int, optional
    least_force : float, optional
        N; weaker is no contact.
    surface : Hemisphere or TipMesh, optional
        The fingertip.
    tare : float, s
        For so long nothing touches the finger: what it reads then is its offset, and is taken off all that follows.
    model : TouchModel, optional
        How the sensor is mounted, and its noise.
    quiet : bool
        Tell nothing.
    until_written : ExitStack
        In which Ctrl-C is held off once the port is open; the caller leaves it when what came is written.

    Raises
    ------
    InputError
        The port cannot be opened, sends nothing, does not send the six components, does not say how many samples come a second,
        does not name the unit of its moments, which are in N m, or something touched the finger while it was to rest.
    """
    import numpy as np

    from skinfab.cli.ending import ended_by_signals
    from skinfab.cli.listening import Listening
    from skinfab.errors import InputError
    from skinfab.fingertip.force.contact import LEAST_FORCE_N, locate
    from skinfab.fingertip.force.logs import WrenchLog
    from skinfab.fingertip.force.motion import MotionWatch
    from skinfab.readout.serial_port import BAUD, SerialPort
    from skinfab.readout.source import HostClock

    rows: list[tuple[float, ...]] = []
    latency: list[float] = []
    motions: dict[float, Motion] = {}
    # Compiled now: the first sample of the port would wait a second for it.
    locate(np.array([[0.0, 0.0, -1.0]]), np.zeros((1, 3)), surface)
    with SerialPort(port, baud=baud or BAUD) as source:
        stop = until_written.enter_context(ended_by_signals())
        stream = source.stream
        columns, scale, said = _columns(stream, port)
        if not stream.rate_hz:
            raise InputError(f"{port} does not say how many samples come a second; let the device describe its stream (docs/readout.md)")
        least = LEAST_FORCE_N if least_force is None else least_force
        noise = model.noise if model else None
        watch = MotionWatch(limits, rate_hz=stream.rate_hz, surface=surface, least_force=least, noise=noise)
        teller, rest = _Teller(least, surface, quiet), _Rest(stream.name, tare)
        units = None if said else _Units(port, watch.surface, least)
        listening, clock, missing = Listening(source, stop, seconds=seconds, quiet=quiet), HostClock(), 0
        began = clock.now()
        for frame in listening.frames():
            if not frame.valid[columns].all() or frame.saturated[columns].any():
                missing += 1
                continue
            wrench = rest.less(frame.device_time, scale * frame.values[columns])
            if wrench is None:
                continue
            if units:
                units.look(wrench)
            wrench = model.matrix @ wrench if model else wrench
            new = watch.step(frame.device_time, wrench[:3], wrench[3:])
            if frame.host_time >= began:
                latency.append(clock.now() - frame.host_time)
            rows.append((frame.device_time, *wrench.tolist()))
            for each in new:
                motions[each.told] = each
            teller.step(frame.device_time, wrench, new)
        counts = source.counts
        if not rows:
            after = f" after the {tare:g} s in which it rests" if tare else ""
            raise listening.too_little(f"sent no whole sample{after}", "is the sensor running?")
        notes = listening.notes
    table = np.array(rows)
    notes += [
        f"{count} samples were {how}" for how, count in (("lost", counts.lost), ("damaged", counts.bad), ("late", counts.late)) if count
    ]
    notes += [f"{missing} samples lacked a component or were saturated, and were passed over"] * bool(missing)
    notes += fallen_behind(latency)
    log = WrenchLog(stream.name, table[:, 0], table[:, 1:4], table[:, 4:], simulated=stream.simulated)
    return Watched(log, tuple(motions.values()), np.array(latency), stream.simulated, tuple(notes))


def fallen_behind(latency_s: Sequence[float]) -> list[str]:
    """What to say of decisions that came ever later.

    Examples
    --------
    >>> fallen_behind([2.0] * 50 + [0.01] * 50), fallen_behind([3.0] * 5)  # a while in between, or next to nothing
    ([], [])
    >>> fallen_behind([0.01] * 50 + [3.0] * 50)[0][:42]
    'at the end decisions were 3.0 s behind the'
    """
    if len(latency_s) < _LAST or (behind := statistics.median(latency_s[-_LAST:])) < _BEHIND_S:
        return []
    return [
        f"at the end decisions were {behind:.1f} s behind their samples, and what came in that time was not read: this computer is too "
        "busy; end other work on it"
    ]


class _Rest:
    """Gathers what the finger reads while it rests, and takes it off afterwards."""

    def __init__(self, name: str, seconds: float) -> None:
        self._name, self._seconds = name, seconds
        self._rows: list[tuple[float, NDArray[np.float64]]] = []
        self._offset: NDArray[np.float64] | None = None

    def less(self, now: float, wrench: NDArray[np.float64]) -> NDArray[np.float64] | None:
        """The wrench without the offset; None while the finger rests."""
        if not self._seconds:
            return wrench
        if self._offset is None:
            if not self._rows or now - self._rows[0][0] < self._seconds:
                self._rows.append((now, wrench))
                return None
            self._offset = self._found()
        return wrench - self._offset

    def _found(self) -> NDArray[np.float64]:
        import numpy as np

        from skinfab.fingertip.force.logs import WrenchLog
        from skinfab.fingertip.force.tare import tared

        table = np.array([row for _, row in self._rows])
        log = WrenchLog(self._name, np.array([now for now, _ in self._rows]), table[:, :3], table[:, 3:])
        tared(log, seconds=self._seconds)  # raises where something touched
        mean: NDArray[np.float64] = table.mean(axis=0)
        return mean


class _Units:
    """Looks whether moments whose unit nobody named are in N m: once, when so many samples with a force have come."""

    def __init__(self, port: str, surface: Hemisphere | TipMesh, least_force: float) -> None:
        from skinfab.cli.force_contact import reach

        self._port, self._reach, self._least = port, reach(surface), least_force
        self._rows: list[NDArray[np.float64]] | None = []

    def look(self, wrench: NDArray[np.float64]) -> None:
        """Raises InputError."""
        if self._rows is None or float(wrench[:3] @ wrench[:3]) <= self._least**2:
            return
        self._rows.append(wrench)
        if len(self._rows) < _LOOKED_AT:
            return
        import numpy as np

        from skinfab.fingertip.force.wrench import require_nmm

        table, self._rows = np.array(self._rows), None
        require_nmm(table[:, :3], table[:, 3:], reach_mm=self._reach, least_force=self._least, where=self._port)


def _columns(stream: Stream, port: str) -> tuple[list[int], NDArray[np.float64], bool]:
    """Where the six components are, what makes them N and N mm, and whether the unit of the moments is named."""
    import numpy as np

    from skinfab.fingertip.force.wrench import wrench_columns

    units = {each.name: each.unit for each in stream.channels}
    used = wrench_columns(stream.names, units, where=port)
    return [stream.index(name) for name, _ in used], np.array([scale for _, scale in used]), all(units[name] for name, _ in used[3:])


class _Teller:
    """Says where the finger is touched, when it is let go, and what moves."""

    def __init__(self, least_force: float, surface: Hemisphere | TipMesh | None, quiet: bool) -> None:
        self._least, self._surface, self._quiet = least_force, surface, quiet
        self._touching, self._next = False, -math.inf

    def step(self, now: float, wrench: Any, new: list[Motion]) -> None:
        if self._quiet:
            return
        for each in new:
            steps.say(
                [f"{now:.2f} s, {each.kind} {'began' if each.lasting else f'ended after {each.end - each.start:.2f} s'}"], kind="motion"
            )
        from skinfab.fingertip.force.contact import locate

        force = math.sqrt(float(wrench[:3] @ wrench[:3]))
        if force >= self._least and now >= self._next:
            found = locate(wrench[None, :3], wrench[None, 3:], self._surface, least_force=self._least)
            x, y, z = found.point[0].tolist()
            word = f"; {found.words(0)}" if found.flags[0] else ""
            steps.say([f"{now:.2f} s, {force:.2f} N at {x:.1f}, {y:.1f}, {z:.1f} mm{word}"], kind="contact")
            self._next, self._touching = now + _AGAIN_S, True
        elif force < self._least / 2 and self._touching:
            steps.say([f"{now:.2f} s, let go"], kind="contact")
            self._touching, self._next = False, -math.inf
