"""What each channel was good for: when it was watched, and what is wrong with it, in sentences."""

from __future__ import annotations

import math
from dataclasses import dataclass

from calibration.contact.rest import STILL_S

#: A channel that is watched so much later than it could be is said to be late, s.
LATE_S = 1.0


@dataclass(frozen=True)
class Freeze:
    """A while in which a channel read one value, as its noise never lets it.

    Parameters
    ----------
    start, end : float, s
        The end is NaN where it lasts.
    value : float
    """

    start: float
    end: float
    value: float


@dataclass(frozen=True)
class Health:
    """What a channel was good for.

    Parameters
    ----------
    channel : str
    r0, noise : float
        Reading at rest and its standard deviation; NaN where it never was at rest.
    ready : float, s
        From when on it was watched; NaN where it never was.
    late : float, s
        How much sooner it would have been watched, had it rested from the beginning; NaN where it never rested.
    watched : float
        Part of the frames in which a contact could be seen.
    masked, saturated : float
        Part of the frames in which it read nothing, or the end of its range.
    constant : bool
        It read one value only.
    tells : bool
        Its noise is large enough to show that it has frozen.
    least, most : float
        Of what it read; infinite where it read nothing.
    freezes : tuple of Freeze
        In their order.
    """

    channel: str
    r0: float
    noise: float
    ready: float
    late: float
    watched: float
    masked: float
    saturated: float
    constant: bool
    tells: bool
    least: float
    most: float
    freezes: tuple[Freeze, ...]

    @property
    def state(self) -> str:
        """In a word or two; empty where nothing took it out of the decision."""
        if self.masked == 1:
            return "silent"
        if self.constant:
            return "constant"
        if math.isnan(self.ready):
            return "never at rest"
        return "frozen" if self.freezes else ""

    @property
    def faults(self) -> tuple[str, ...]:
        """What is wrong with it, a sentence each."""
        name = f"channel {self.channel}"
        if self.state == "silent":
            return (f"{name} never read anything; check its wires. The others go on without it",)
        if self.state == "constant":
            return (f"{name} read one value all the time; it is dead or not connected. The others go on without it",)
        found = []
        if self.state == "never at rest":
            found.append(f"{name} never rested for {STILL_S:g} s, so its noise is not known; leave the object alone at first")
        elif self.late > LATE_S:
            found.append(
                f"{name} was not at rest at first and is watched from {self.ready:.2f} s on; contacts before that are not seen: "
                "leave the object alone at first"
            )
        if self.freezes:
            found.append(self._frozen())
        elif not math.isnan(self.ready) and not self.tells:
            found.append(f"{name} hardly moves at rest, so nobody could tell if it froze; give its readings more digits")
        if self.masked > 0:
            found.append(f"{name} read nothing in {100 * self.masked:.1f} % of the frames; contacts there are not seen")
        if self.saturated > 0:
            part = f"{100 * self.saturated:.1f} % of the frames"
            found.append(f"{name} was at the end of its range in {part}; its bridge is off balance, or a wire open")
        return tuple(found)

    def _frozen(self) -> str:
        first, last = self.freezes[0], self.freezes[-1]
        until = "to the end" if math.isnan(last.end) else f"to {last.end:.2f} s"
        times = "" if len(self.freezes) == 1 else f", {len(self.freezes)} times in between"
        near = 0.5 * self.noise
        where = "the most" if first.value >= self.most - near else "the least" if first.value <= self.least + near else ""
        at = f", {where} that it ever read, as at the end of a range" if where else ""
        return (
            f"channel {self.channel} froze at {first.start:.2f} s ({first.value:.5g}{at}), {until}{times}; "
            "check its wires and its range. The others go on without it"
        )
