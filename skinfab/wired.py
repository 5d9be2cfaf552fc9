"""What a wiring table says of a readout's channels: whose they are, where they are plugged in, and what they should read at rest."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from skinfab.errors import InputError
from skinfab.readout.bridge import at_rest
from skinfab.readout.frame import Recording, Stream
from skinfab.wiring import Wire, board_of, read_wiring, wiring

#: Kilohms of what a channel may be measured in, in small letters; the sign of the ohm and the Greek letter are the same then.
_KOHM = {"kohm": 1.0, "ohm": 1e-3, "k\u03c9": 1.0, "\u03c9": 1e-3}
#: So many channels are named.
_NAMED = 4


@dataclass(frozen=True)
class AtRest:
    """A sensor's resistance at rest beside the predicted one, kohm.

    Parameters
    ----------
    sensor : str
    measured : float, kohm
        NaN where it never read.
    low, median, high : float, kohm
        Predicted; nine prints in ten lie between the first and the last.
    """

    sensor: str
    measured: float
    low: float
    median: float
    high: float

    @property
    def verdict(self) -> str:
        """Empty where it is as predicted; else what it may be.

        Examples
        --------
        >>> AtRest("C1", 9000.0, 49.0, 154.0, 487.0).verdict
        'C1 reads 9000 kohm at rest, above the 49 to 487 predicted: its line or a wire may be broken'
        """
        if math.isnan(self.measured):
            return f"{self.sensor} reads nothing: its line or a wire may be broken"
        if self.low <= self.measured <= self.high:
            return ""
        side, may = ("below", "two lines or wires may touch") if self.measured < self.low else ("above", "its line or a wire may be broken")
        return f"{self.sensor} reads {self.measured:.4g} kohm at rest, {side} the {self.low:.4g} to {self.high:.4g} predicted: {may}"


def load_wiring(path: str | Path) -> tuple[Wire, ...]:
    """The table of a wiring.csv, or of a skin document.

    Raises
    ------
    InputError
        It is neither, contradicts itself, or has no sensors.
    """
    if Path(path).suffix.lower() == ".skin":
        from skinfab.document import load_skin
        from skinfab.material import load_material

        skin = load_skin(path)
        wires = wiring(skin, load_material(skin.material))
    else:
        wires = read_wiring(path)
    if not wires:
        raise InputError(f"{path} has no sensors, so it says nothing of any channel; give the wiring of a skin that has some")
    return wires


def wired(stream: Stream, wires: Sequence[Wire]) -> tuple[Stream, list[str]]:
    """A stream with its channels called after their sensors; and what does not agree, a sentence each.

    A channel is found by its column: board and input are where it is plugged in. Its kind becomes the sensor's; unit and range stay
    the device's own. Columns without a sensor keep their names.

    Raises
    ------
    InputError
        The table has a channel that the stream has not, or the stream says that it is another sensor's.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel
    >>> wires = [Wire(f"C7-{t}", "C7", "contact-spiral", "P1", t, "signal", 2.0, 3.0, 1, 1, 1, "kohm", 49.0, 154.0, 487.0) for t in (1, 2)]
    >>> got, notes = wired(Stream("skin", (Channel("ch1", "kohm"), Channel("ch2", "kohm"))), wires)
    >>> got.names, got.channels[1].kind, notes
    (('ch1', 'C7'), 'contact', ['skin has 2 channels and the wiring 1 sensor: nothing is wired to ch1'])
    """
    by_channel = {wire.channel: wire for wire in wires}
    count = len(stream.channels)
    if missing := [wire for channel, wire in sorted(by_channel.items()) if channel >= count]:
        first = missing[0]
        raise InputError(
            f"{stream.name} has {_counted(count, 'channel')}, but by the wiring {first.sensor} is channel {first.channel} (counted "
            f"from 0: board {first.board}, input {first.board_input}); give the wiring of this skin, or have the device send it"
        )
    sensors = {wire.sensor for wire in wires}
    channels, spare = [], []
    for column, channel in enumerate(stream.channels):
        wire, (board, board_input) = by_channel.get(column), board_of(column)
        if wire is None:
            name = channel.name if channel.name not in sensors else f"board {board} input {board_input}"
            spare.append(channel.name)
            channels.append(replace(channel, name=name, board=board, board_input=board_input))
            continue
        if channel.sensor and channel.sensor != wire.sensor:
            raise InputError(
                f"{stream.name} says that channel {column} is sensor {channel.sensor}, the wiring that it is {wire.sensor}; one of them is "
                "of another skin"
            )
        kind = wire.kind.partition("-")[0]
        channels.append(replace(channel, name=wire.sensor, kind=kind, sensor=wire.sensor, board=board, board_input=board_input))
    notes = []
    if spare:
        notes.append(
            f"{stream.name} has {_counted(count, 'channel')} and the wiring {_counted(len(by_channel), 'sensor')}: nothing is wired to "
            f"{', '.join(spare)}"
        )
    return replace(stream, channels=tuple(channels)), notes


def rests(recording: Recording, wires: Sequence[Wire], *, known: Mapping[str, float] | None = None) -> tuple[AtRest, ...]:
    """Measured and predicted resistance at rest of each sensor whose channel is a resistance.

    Parameters
    ----------
    recording : Recording
        Of a stream that is `wired`.
    wires : sequence of Wire
    known : mapping, optional
        Resistances at rest by channel, kohm, where they were reckoned from voltages.
    """
    known, out = dict(known or {}), []
    steps = np.diff(recording.device_time)
    rate = recording.stream.rate_hz or (1 / float(np.median(steps)) if len(steps) and np.median(steps) > 0 else 1.0)
    for wire in wires:
        if wire.terminal != 1 or wire.unit != "kohm":
            continue
        channel = recording.stream.channels[recording.stream.index(wire.sensor)]
        if channel.name in known:
            measured = known[channel.name]
        elif (unit := channel.unit.lower()) in _KOHM:
            readings = recording.column(channel.name)
            measured = _KOHM[unit] * at_rest(readings, rate).level if np.isfinite(readings).any() else math.nan
        else:
            continue
        out.append(AtRest(wire.sensor, measured, wire.low, wire.median, wire.high))
    return tuple(out)


def unit_notes(stream: Stream, wires: Sequence[Wire]) -> list[str]:
    """One sentence where resistances are predicted for channels whose unit is missing, or of ohms that `rests` does not know.

    Volts and the like are other than resistances, and nobody expects a comparison.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel
    >>> wires = [Wire("C7-1", "C7", "contact-spiral", "P1", 1, "signal", 2.0, 3.0, 0, 1, 0, "kohm", 49.0, 154.0, 487.0)]
    >>> unit_notes(Stream("skin", (Channel("C7", "kohm"),)), wires)
    []
    >>> print(*unit_notes(Stream("skin", (Channel("C7"),)), wires))
    C7 is not said to be in kohm or ohm, so its resistance at rest is not compared with the predicted one; a heading gives its unit in \
brackets: C7[kohm]
    """
    predicted = [wire.sensor for wire in wires if wire.terminal == 1 and wire.unit == "kohm"]
    units = {sensor: stream.channels[stream.index(sensor)].unit.lower() for sensor in predicted}
    bare = [s for s, unit in units.items() if not unit or (unit not in _KOHM and unit.endswith(("ohm", "ohms", "\u03c9")))]
    if not bare:
        return []
    named = ", ".join(bare[:_NAMED]) + (f" and {len(bare) - _NAMED} more" if len(bare) > _NAMED else "")
    are, its = ("is", "its") if len(bare) == 1 else ("are", "their")
    return [
        f"{named} {are} not said to be in kohm or ohm, so {its} resistance at rest is not compared with the predicted one; a heading gives "
        f"its unit in brackets: {bare[0]}[kohm]"
    ]


def rest_facts(found: Sequence[AtRest]) -> list[dict[str, str | float | None]]:
    """The same, ready for JSON."""
    return [
        {
            "sensor": each.sensor,
            "measured_kohm": None if math.isnan(each.measured) else each.measured,
            "low_kohm": each.low,
            "median_kohm": each.median,
            "high_kohm": each.high,
        }
        for each in found
    ]


def rest_lines(found: Sequence[AtRest]) -> list[str]:
    """A table of them for people; none where nothing was a resistance."""
    if not found:
        return []
    lines = ["sensor       R0, kohm   predicted (nine prints in ten)"]
    for each in found:
        measured = "-" if math.isnan(each.measured) else f"{each.measured:.4g}"
        outside = "  OUTSIDE" if each.verdict else ""
        lines.append(f"{each.sensor:10s}{measured:>11s}   {each.median:.4g} ({each.low:.4g} to {each.high:.4g}){outside}")
    return lines


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" + ("" if number == 1 else "s")
