"""Motions of a held object that nobody asked for: it slides, lets go, or rolls; each as an event with a beginning and an end.

Sliding: the force leans from the contact's normal as far as friction allows. Separation: the force drops. Rolling: the
contact's point moves and it is neither of these (the paper's section 3). Each begins at one limit and ends at a laxer one,
so that noise at a limit is one event and not twenty.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.force.contact import LEAST_FORCE_N, Hemisphere, locate
from skinfab.fingertip.force.contact_mesh import TipMesh
from skinfab.fingertip.force.wrench import SensorNoise

FloatArray = NDArray[np.float64]

SLIDING, SEPARATION, ROLLING = "sliding", "separation", "rolling"
KINDS = (SLIDING, SEPARATION, ROLLING)


@dataclass(frozen=True)
class Limits:
    """Where events begin and end.

    Parameters
    ----------
    friction_deg : float, deg
        Friction angle of finger and object, as far as it is known.
    slide, slide_end : float
        Parts of it where sliding begins and ends.
    jump, jump_level : float
        Sliding begins too where the angle rose by the part `jump` of it within `JUMP_S`, beyond the part `jump_level`.
    drop, drop_end : float
        Parts of the force held before, where separation begins and ends.
    roll_mm, roll_end_mm : float, mm
        Ways of the contact within `ROLL_S` where rolling begins and ends ...
    roll_sd : float
        ... and no less than so many standard deviations of them.

    Raises
    ------
    InputError
        An end that is beyond its beginning, or a friction angle that is none.
    """

    friction_deg: float
    slide: float = 0.92
    slide_end: float = 0.68
    jump: float = 0.3
    jump_level: float = 0.72
    drop: float = 0.5
    drop_end: float = 0.65
    roll_mm: float = 0.7
    roll_end_mm: float = 0.4
    roll_sd: float = 4.0

    def __post_init__(self) -> None:
        if not 0 < self.friction_deg < 90:
            raise InputError(f"a friction angle of {self.friction_deg:g} degrees is none; give one between 0 and 90")
        for low, high in (("slide_end", "slide"), ("drop", "drop_end"), ("roll_end_mm", "roll_mm")):
            if not 0 < getattr(self, low) <= getattr(self, high):
                raise InputError(f"{low} must be above 0 and not above {high}; they are {getattr(self, low):g} and {getattr(self, high):g}")


#: Averaged before anything is concluded, s; times over which the angle's rise, the contact's way and a steady force are judged.
AVERAGE_S, JUMP_S, ROLL_S, STEADY_S = 0.05, 0.1, 0.2, 0.5
#: The force held is followed with this time constant, s.
HELD_S = 0.5
#: A dropped force that stays within this part of itself is a new grip.
STEADY_PART = 0.1
#: A longer silence, s, ends what lasts: nobody knows what went on.
HOLE_S = 0.1


@dataclass(frozen=True)
class Motion:
    """One event.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    start, end : float, s
        NaN while it lasts.
    told : float, s
        When it was noticed: `start` is reckoned back from there.
    """

    kind: str
    start: float
    end: float = math.nan
    told: float = math.nan

    @property
    def lasting(self) -> bool:
        """Has it not ended?"""
        return math.isnan(self.end)


@dataclass(frozen=True)
class _Seen:
    """What one averaged sample says."""

    force: float
    angle: float
    point: tuple[float, float, float]
    sd: float
    touching: bool


class MotionWatch:
    """Events sample by sample; `find_motions` does the same for a whole log.

    Parameters
    ----------
    limits : Limits
    rate_hz : float
    surface : Hemisphere or TipMesh
        The fingertip; a `Hemisphere` of 20 mm where left out.
    noise : SensorNoise
    least_force : float, N

    Examples
    --------
    >>> watch = MotionWatch(Limits(friction_deg=30), rate_hz=200)
    >>> told = []
    >>> for k in range(400):  # presses with 1 N on the pole, and leans from 5 degrees to 30 after one second
    ...     lean = np.radians(5 if k < 200 else 30)
    ...     f = np.array([np.sin(lean), 0, -np.cos(lean)])
    ...     told += watch.step(k / 200, f, np.cross([0, 0, 20.0], f))
    >>> [(each.kind, round(each.start, 1)) for each in told]
    [('sliding', 1.0)]
    """

    def __init__(
        self,
        limits: Limits,
        *,
        rate_hz: float,
        surface: Hemisphere | TipMesh | None = None,
        noise: SensorNoise | None = None,
        least_force: float = LEAST_FORCE_N,
    ) -> None:
        if not (math.isfinite(rate_hz) and rate_hz > 0):
            raise InputError(f"a rate of {rate_hz:g} Hz is none; give the samples a second")
        self.limits, self.surface, self.noise, self.least_force = limits, surface or Hemisphere(), noise or SensorNoise(), least_force
        self.samples = max(round(AVERAGE_S * rate_hz), 1)
        self._jump, self._roll, self._steady = (max(round(s * rate_hz), 1) for s in (JUMP_S, ROLL_S, STEADY_S))
        self._held_part = 1 - math.exp(-1 / (HELD_S * rate_hz))
        self._wrenches: deque[FloatArray] = deque(maxlen=self.samples)
        self._past: deque[_Seen] = deque(maxlen=self._steady + 1)
        self._time = -math.inf
        self._held = 0.0
        self._now: Motion | None = None

    def step(self, time: float, force: FloatArray, moment: FloatArray) -> list[Motion]:
        """Events that begin (their end is NaN) or end with this sample. One that is no number, or out of order, is passed over."""
        wrench = np.concatenate([force, moment])
        if not np.isfinite(wrench).all() or not time > self._time:
            return []
        out = self._silence(time)
        self._wrenches.append(wrench)
        mean = _mean(self._wrenches)
        return out + self._conclude(time, next(self._located(mean[None, :3], mean[None, 3:])))

    def run(self, time: FloatArray, force: FloatArray, moment: FloatArray) -> list[Motion]:
        """All samples of a log at once: what `step` gives for each, one after the other."""
        wrench = np.column_stack([force, moment])
        whole = np.isfinite(wrench).all(axis=1) & (np.diff(time, prepend=-math.inf) > 0)
        time, wrench = time[whole], wrench[whole]
        begins = np.flatnonzero(np.diff(time, prepend=-math.inf) > HOLE_S)
        out: list[Motion] = []
        for a, b in zip(begins, [*begins[1:], len(time)], strict=True):
            out += self._silence(float(time[a]))
            mean = moving_mean(wrench[a:b], self.samples)
            for t, seen in zip(time[a:b].tolist(), self._located(mean[:, :3], mean[:, 3:]), strict=True):
                out += self._conclude(t, seen)
        return out

    def _located(self, force: FloatArray, moment: FloatArray) -> Iterator[_Seen]:
        noise = self.noise.averaged(self.samples)
        found = locate(force, moment, self.surface, least_force=self.least_force, noise=noise)
        columns = (found.force_n, found.inclination_rad, found.point, found.sd_mm, found.touching)
        for size, angle, point, sd, touching in zip(*(each.tolist() for each in columns), strict=True):
            yield _Seen(size, math.degrees(angle), tuple(point), sd, touching)

    def _silence(self, time: float) -> list[Motion]:
        """After a hole in the time everything begins anew."""
        if time - self._time <= HOLE_S:
            return []
        out = [self._ended(self._time)] if self._now else []
        self._wrenches.clear()
        self._past.clear()
        self._held = 0.0
        return out

    def _conclude(self, time: float, seen: _Seen) -> list[Motion]:
        self._past.append(seen)
        self._time = time
        out: list[Motion] = []
        kind = self._kind(seen)
        if self._now and kind != self._now.kind:
            out.append(self._ended(time))
        if kind and not self._now:
            self._now = Motion(kind, time - self._age(kind), told=time)
            out.append(self._now)
        if kind != SEPARATION and seen.touching:
            self._held += (seen.force - self._held) * (self._held_part if self._held else 1.0)
        return out

    def _ended(self, time: float) -> Motion:
        assert self._now is not None
        ended = replace(self._now, end=max(time - self._age(self._now.kind), self._now.start))
        self._now = None
        return ended

    def _age(self, kind: str) -> float:
        """How long ago the middle of what was looked at is, s."""
        return AVERAGE_S / 2 + (ROLL_S / 2 if kind == ROLLING else 0.0)

    def _kind(self, seen: _Seen) -> str:
        """What goes on now; empty where nothing does."""
        now = self._now.kind if self._now else ""
        limits = self.limits
        if self._separated(seen, now):
            return SEPARATION
        if not seen.touching:
            return ""
        angle = seen.angle / limits.friction_deg
        if angle > (limits.slide_end if now == SLIDING else limits.slide):
            return SLIDING
        before = self._ago(self._jump)
        if before and before.touching and angle > limits.jump_level and angle - before.angle / limits.friction_deg > limits.jump:
            return SLIDING
        before = self._ago(self._roll)
        if before and before.touching:
            least = limits.roll_end_mm if now == ROLLING else max(limits.roll_mm, limits.roll_sd * math.hypot(seen.sd, before.sd))
            if math.dist(seen.point, before.point) > least:
                return ROLLING
        return ""

    def _separated(self, seen: _Seen, now: str) -> bool:
        if now != SEPARATION:
            return self._held > 0 and (not seen.touching or seen.force < self.limits.drop * self._held)
        if seen.touching and seen.force > self.limits.drop_end * self._held:
            return False
        before = self._ago(self._steady)
        if before and before.touching and seen.touching and abs(seen.force - before.force) < STEADY_PART * seen.force:
            self._held = seen.force  # lighter than before, but held
            return False
        return True

    def _ago(self, samples: int) -> _Seen | None:
        return self._past[-1 - samples] if len(self._past) > samples else None


def find_motions(time: FloatArray, force: FloatArray, moment: FloatArray, watch: MotionWatch) -> list[Motion]:
    """Events of a log, in order; one that still lasts at its end has no end.

    Parameters
    ----------
    time : (n,) float, s
    force : (n, 3) float, N
    moment : (n, 3) float, N mm
    watch : MotionWatch
        A new one: what it saw before counts.
    """
    events: dict[float, Motion] = {}
    for each in watch.run(time, force, moment):
        events[each.told] = each  # its end comes after its beginning, and takes its place
    return list(events.values())


def _mean(rows: deque[FloatArray]) -> FloatArray:
    """Summed in the order of `moving_mean`, so that both agree to the last bit."""
    total = np.zeros(6)
    for row in rows:
        total = total + row
    return total / len(rows)


def moving_mean(rows: FloatArray, count: int) -> FloatArray:
    """Of the last `count` rows at each, or of as many as there are."""
    n = len(rows)
    out = np.empty_like(rows)
    for k in range(min(count - 1, n)):
        out[k] = _mean(deque(rows[: k + 1]))
    if n >= count:
        total = np.zeros((n - count + 1, rows.shape[1]))
        for j in range(count):
            total = total + rows[j : n - count + 1 + j]
        out[count - 1 :] = total / count
    return out
