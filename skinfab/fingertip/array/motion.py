"""How one contact moves: where it stands, and how far it slips or rolls from one stand to the next.

Speed tells which: what goes at 20 mm/s or more slips, what goes on more slowly rolls. Distances are those from stand to stand, not of
the steps in which they are noticed, and a roll that turns back ends where it turned.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
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


class At(NamedTuple):
    """A time (s) and a place on the skin's outside, mm along and around; the latter goes on beyond a turn."""

    time: float
    along: float
    around: float

    def far(self, other: At) -> float:
        """Distance, mm."""
        return math.hypot(self.along - other.along, self.around - other.around)


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
            return self._told("slip", len(self._path) - 1)
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
            if now.far(self._path[k]) >= max(SLIP_MM, SLIP_MM_S * took):
                return k
        return None

    def _slip(self) -> list[Moved]:
        """Whether the slip is over, and where it was."""
        now, k = self._path[-1], len(self._path) - 2
        while k > 0 and now.time - self._path[k].time < _SLOW_S - _ROUNDING_S:
            k -= 1
        if k == 0 or now.far(self._path[k]) > _SLOW * SLIP_MM_S * (now.time - self._path[k].time):
            return []
        made = self._told("slip", k)
        self._begin(self._path[k], tuple(self._path[k + 1 :]))
        return made

    def _turned(self) -> list[Moved]:
        """A roll that comes back is over where it was farthest."""
        k = self._farthest
        reached = self._path[k].far(self._from)
        if reached < ROLL_MM or reached - self._path[-1].far(self._from) < TURN_MM:
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
        middle = At(now.time, sum(at.along for at in last) / len(last), sum(at.around for at in last) / len(last))
        if max(at.far(middle) for at in last) > STILL_MM:
            return []
        made = self._told("roll", len(self._path) - 1, middle) if middle.far(self._from) >= ROLL_MM else []
        # The stand's frames are kept: the next roll may begin among them.
        self._begin(middle._replace(time=last[0].time), tuple(last))
        self._path.pop(0)
        self._farthest = len(self._path) - 1
        return made

    def _roll_to(self, k: int) -> list[Moved]:
        return self._told("roll", k) if self._path[k].far(self._from) >= ROLL_MM else []

    def _told(self, kind: str, k: int, to: At | None = None) -> list[Moved]:
        """From where it stood to frame k, or to the middle of the stand there; from the last frame that was still to the first that is."""
        end, first = to or self._path[k], 0
        while first < k and self._path[first + 1].far(self._from) <= STILL_MM:
            first += 1
        last = k
        while last > first + 1 and self._path[last - 1].far(end) <= STILL_MM:
            last -= 1
        along, around = end.along - self._from.along, end.around - self._from.around
        return [Moved(kind, self._path[first].time, self._path[last].time, along, around)]
