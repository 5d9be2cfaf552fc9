"""How one contact moves: where it stands, and how far it slips or rolls from one stand to the next.

Speed tells which: what goes at 20 mm/s or more slips, what goes on more slowly rolls. Distances are those from stand to stand, not of
the steps in which they are noticed, and a roll that turns back ends where it turned. Places of a light contact scatter by more than
slips are long: along and around each for itself, a way counts only beyond what its ends' standard deviations explain.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median
from typing import NamedTuple

#: Slips are at least so fast, mm/s, measured within so short a time, s (or from frame to frame), and so long, mm: a bar that rolls
#: through 90 degrees in ten of the seed's frames goes at 12 mm/s; places scatter by 0.05 mm, those of rods by a few times that.
SLIP_MM_S, SLIP_S, SLIP_MM = 20.0, 0.2, 1.0
#: A slip is over below this part of its least speed, measured over so long, s.
_SLOW, _SLOW_S = 0.5, 0.06
#: A contact stands where it keeps within so many mm of its middle for so long, s, and for so many frames: what creeps at less than 1 mm/s
#: stands. A roll is at least so long, mm, and turns where it comes back by so much, mm.
STILL_MM, STAND_S, STAND_FRAMES, ROLL_MM, TURN_MM = 0.35, 0.7, 3, 2.0, 1.0
#: Times of frames are rounded by no more than this, s.
_ROUNDING_S = 1e-6
#: Places differ where they lie so many standard deviations of their difference apart. Those of the less sure one are taken for both: beside
#: the middle of a stripe a light contact is by chance told where it seems surer, and 7 of its own deviations of two were seen in 5000.
PLACE_SIGMAS = 5.0
#: Frames of so short a time are taken together, s: each of the seed's is one. Standard deviation of a median, times the root of its number.
SMOOTH_S, _MEDIAN = 0.06, math.sqrt(math.pi / 2)
#: A place that is told by so much surer than where it came down is taken for that.
_LIGHTER = 0.7
#: Standard deviations beyond this, mm, are a guess: a fit is not straight over a sixth of the way from one stripe to the next.
VAGUE_MM = 1.0
#: Halves of a stand may differ by so many.
_HALVES_SIGMAS = 2.0


class At(NamedTuple):
    """A time (s), a place on the skin's outside, mm along and around (which goes on beyond a turn), and its standard deviations."""

    time: float
    along: float
    around: float
    along_sd: float = 0.0
    around_sd: float = 0.0

    def far(self, other: At) -> float:
        """Distance, mm."""
        return math.hypot(self.along - other.along, self.around - other.around)

    def gone(self, other: At, *, sigmas: float = PLACE_SIGMAS) -> float:
        """Distance, mm, of what of it is sure."""
        return math.hypot(
            _sure(self.along - other.along, max(self.along_sd, other.along_sd), sigmas),
            _sure(self.around - other.around, max(self.around_sd, other.around_sd), sigmas),
        )


def _sure(way: float, sd: float, sigmas: float) -> float:
    """A way between places that are so sure; 0 of one that noise explains."""
    return abs(way) if sd <= VAGUE_MM and abs(way) >= sigmas * math.sqrt(2) * sd else 0.0


def middle_of(each: Sequence[At]) -> At:
    """Their mean, the surer ones counting for more, at the time of the last.

    Examples
    --------
    >>> middle_of([At(0.0, 1.0, 0.0, 0.1, 0.1), At(1.0, 2.0, 0.0, 0.1, 0.1)])
    At(time=1.0, along=1.5, around=0.0, along_sd=0.07071067811865475, around_sd=0.07071067811865475)
    """
    along, along_sd = _mean([at.along for at in each], [at.along_sd for at in each])
    around, around_sd = _mean([at.around for at in each], [at.around_sd for at in each])
    return At(each[-1].time, along, around, along_sd, around_sd)


def _mean(values: Sequence[float], sd: Sequence[float]) -> tuple[float, float]:
    if not min(sd) > 0:
        return sum(values) / len(values), 0.0
    weights = [one**-2 for one in sd]
    return sum(w * value for w, value in zip(weights, values, strict=True)) / sum(weights), sum(weights) ** -0.5


class Smooth:
    """A contact's place as the median of the last frames, so that two hundred a second tell no more of noise than fifteen.

    Examples
    --------
    >>> smooth = Smooth()
    >>> made = [smooth.step(At(k / 100, float(k >= 9), 0.0, 0.1, 0.1), 0.01) for k in range(14)]
    >>> [(round(at.time, 2), at.along, round(at.along_sd, 3)) for at in made if at is not None][:6]  # a jump stays one
    [(0.03, 0.0, 0.056), (0.04, 0.0, 0.056), (0.05, 0.0, 0.056), (0.06, 0.0, 0.056), (0.07, 0.0, 0.056), (0.08, 0.0, 0.056)]
    """

    def __init__(self) -> None:
        self._last: list[At] = []
        self._told, self._full = -math.inf, False

    def step(self, at: At, every_s: float) -> At | None:
        """Take the next frame's, so long after the frame before; None until there are frames enough."""
        self._full |= not self._last and every_s >= SMOOTH_S
        self._last.append(at)
        self._full |= at.time - self._last[0].time + every_s >= SMOOTH_S - _ROUNDING_S
        while at.time - self._last[0].time >= SMOOTH_S - _ROUNDING_S:
            self._last.pop(0)
        # An odd number, so that a jump is one of the places before it or of those after.
        last = self._last[1 - len(self._last) % 2 :]
        middle = last[len(last) // 2].time
        if not self._full or middle <= self._told:
            return None
        self._told = middle
        if len(last) == 1:
            return at
        part = _MEDIAN / math.sqrt(len(last))
        return At(
            middle,
            median(each.along for each in last),
            median(each.around for each in last),
            part * median(each.along_sd for each in last),
            part * median(each.around_sd for each in last),
        )


@dataclass(frozen=True)
class Moved:
    """A slip or a roll: from when to when, and how far."""

    kind: str
    start: float
    end: float
    along_mm: float
    around_mm: float


class Motion:
    """Follows one contact.

    Parameters
    ----------
    start : At

    Examples
    --------
    >>> motion = Motion(At(0.0, 5.0, 0.0))
    >>> path = [At(k / 10, 5.0 + min(max(k - 10, 0), 16) / 4, 0.0) for k in range(1, 45)]
    >>> [(made.kind, round(made.start, 1), round(made.end, 1), round(made.along_mm, 1)) for at in path for made in motion.step(at)]
    [('roll', 1.1, 2.5, 3.9)]
    """

    def __init__(self, start: At) -> None:
        self._begin(start)

    def _begin(self, start: At, after: tuple[At, ...] = ()) -> None:
        """From here on it has neither slipped nor rolled; `after` are frames that came since."""
        self._from = start  # where it stood
        self._path = [start, *after]
        self._farthest = 0  # the frame of the path that is farthest from there
        self._slipping = False
        for k in range(len(self._path)):
            self._look_back(k)

    def step(self, at: At) -> list[Moved]:
        """Take the next place; what is over with it."""
        self._path.append(at)
        if self._slipping:
            return self._slip()
        if at.gone(self._from) <= STILL_MM and max(at.along_sd, at.around_sd) < _LIGHTER * max(self._from.along_sd, self._from.around_sd):
            # It is pressed harder where it came down: from here on it is known where that is.
            self._begin(at)
            return []
        began = self._fast()
        if began is not None:
            made = self._roll_to(began)
            self._begin(self._path[began], tuple(self._path[began + 1 :]))
            self._slipping = True
            return made
        self._look_back(len(self._path) - 1)
        return self._turned() or self._stood()

    def end(self) -> list[Moved]:
        """What goes on still, ended with the last place."""
        if self._slipping:
            return self._slip_to(len(self._path) - 1)
        return self._roll_to(len(self._path) - 1)

    def _look_back(self, k: int) -> None:
        if self._path[k].far(self._from) >= self._path[self._farthest].far(self._from):
            self._farthest = k

    def _fast(self) -> int | None:
        """The latest frame since which it has gone far and fast."""
        now = self._path[-1]
        for k in range(len(self._path) - 2, -1, -1):
            took = now.time - self._path[k].time
            if took > SLIP_S + _ROUNDING_S and k < len(self._path) - 2:
                return None
            if now.gone(self._path[k]) >= max(SLIP_MM, SLIP_MM_S * took):
                return k
        return None

    def _slip(self) -> list[Moved]:
        """Whether the slip is over, and where it was."""
        now, k = self._path[-1], len(self._path) - 2
        while k > 0 and now.time - self._path[k].time < _SLOW_S - _ROUNDING_S:
            k -= 1
        if k == 0 or now.far(self._path[k]) > _SLOW * SLIP_MM_S * (now.time - self._path[k].time):
            return []
        made = self._slip_to(k)
        self._begin(self._path[k], tuple(self._path[k + 1 :]))
        return made

    def _slip_to(self, k: int) -> list[Moved]:
        """None where it went nowhere: it was thrown off and came back."""
        return self._told("slip", k) if self._path[k].gone(self._from) >= SLIP_MM else []

    def _turned(self) -> list[Moved]:
        """A roll that comes back is over where it was farthest."""
        k = self._farthest
        reached = self._path[k].far(self._from)
        if not self._rolled(k) or reached - self._path[-1].far(self._from) < TURN_MM or self._path[-1].gone(self._path[k]) < TURN_MM:
            return []
        made = self._roll_to(k)
        self._begin(self._path[k], tuple(self._path[k + 1 :]))
        return made

    def _stood(self) -> list[Moved]:
        """Whether it stands now; a roll from the last stand to this one."""
        k, now = len(self._path) - 1, self._path[-1]
        while k > 0 and (now.time - self._path[k].time < STAND_S - _ROUNDING_S or len(self._path) - k < STAND_FRAMES):
            k -= 1
        if now.time - self._path[k].time < STAND_S - _ROUNDING_S or len(self._path) - k < STAND_FRAMES:
            return []
        last = self._path[k:]
        middle, half = middle_of(last), len(last) // 2
        if max(at.gone(middle) for at in last) > STILL_MM:
            return []
        if middle_of(last[:half]).gone(middle_of(last[-half:]), sigmas=_HALVES_SIGMAS) > 2 * STILL_MM:
            return []
        made = self._told("roll", len(self._path) - 1, middle) if middle.gone(self._from) >= ROLL_MM else []
        # The stand's frames are kept: the next roll may begin among them.
        self._begin(middle._replace(time=last[0].time), tuple(last))
        self._path.pop(0)
        self._farthest = len(self._path) - 1
        return made

    def _roll_to(self, k: int) -> list[Moved]:
        return self._told("roll", k) if self._rolled(k) else []

    def _rolled(self, k: int) -> bool:
        return self._path[k].gone(self._from) >= ROLL_MM

    def _told(self, kind: str, k: int, to: At | None = None) -> list[Moved]:
        """From where it stood to frame k, or to the middle of the stand there; from the last frame that was still to the first that is."""
        end, first = to or self._path[k], 0
        while first < k and self._path[first + 1].gone(self._from) <= STILL_MM:
            first += 1
        last = k
        while last > first + 1 and self._path[last - 1].gone(end) <= STILL_MM:
            last -= 1
        along, around = end.along - self._from.along, end.around - self._from.around
        return [Moved(kind, self._path[first].time, self._path[last].time, along, around)]
