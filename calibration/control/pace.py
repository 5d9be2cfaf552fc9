"""How many periods went by between two frames, by a clock that shakes."""

from __future__ import annotations

#: By this part of a frame's lateness the count follows it: boards are off their rate by little, and frames come late by much.
FOLLOW = 0.1
#: One period went by as long as the frame is less than this off, in periods: whoever counted by rounding would take a frame that
#: is half a period late for two, and the next for none.
SLACK = 0.9


class Pace:
    """Periods between frames that should come one a period.

    Parameters
    ----------
    period_s : float
    hole_s : float
        After a longer time without a frame nothing is counted.

    Examples
    --------
    >>> pace = Pace(0.01, 0.1)
    >>> [pace.steps(t) for t in (5.0, 5.01, 5.027, 5.03, 5.07, 5.08, 6.08, 6.09)]  # one is late, three are missing, then a hundred
    [None, 1, 1, 1, 4, 1, None, 1]
    """

    def __init__(self, period_s: float, hole_s: float) -> None:
        self._period, self._hole = period_s, hole_s
        self._at: float | None = None

    def steps(self, time: float) -> int | None:
        """Periods since the last call (0: two came at once); None at the first one and after a hole, or where time ran back."""
        if self._at is None or abs(time - self._at) > self._hole + self._period:
            self._at = time
            return None
        went = (time - self._at) / self._period
        steps = 1 if abs(went - 1) < SLACK else max(round(went), 0)
        self._at += (steps + FOLLOW * (went - steps)) * self._period
        return steps
