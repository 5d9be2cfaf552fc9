"""How a source is, in words: what it is, whether it sends, what was lost."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gui.live.feed import Status

#: A source that sends no frame for so long, s, or so many of its frames' distances, is silent: what is shown is of then.
SILENT_S, SILENT_FRAMES = 0.5, 10


@dataclass(frozen=True)
class Words:
    """A sentence and how bad it is: "good", "warning" or "error"."""

    text: str
    kind: str


def silent(status: Status, *, paused: bool = False) -> bool:
    """Is what is shown no more what is?"""
    rate = status.stream.rate_hz if status.stream is not None else 0.0
    limit = max(SILENT_S, SILENT_FRAMES / rate if rate else 0.0)
    return status.state != "running" or not math.isnan(status.gone_s) or (not paused and status.age_s > limit)


def words_of(name: str, status: Status, *, standing: str = "", pace: str = "", contacts: str = "", opening: str = "") -> Words:
    """What to say of a source.

    Parameters
    ----------
    name : str
        What it was asked for by.
    status : Status
    standing : str
        Why a log gives nothing now, such as "paused"; empty where it plays.
    pace : str
        How fast a log plays; empty where frames come as they are measured.
    contacts : str
        What keeps contacts from being seen; empty where nothing does.
    opening : str
        What is being done while it is opened, where that is no device.

    Examples
    --------
    >>> from skinfab.readout.frame import Channel, Stream
    >>> words_of("/dev/ttyACM0", Status("running", stream=Stream("skin", (Channel("S1"),), 100.0), rate_hz=99.9, age_s=0.01)).text
    'skin: 1 channel, 100 Hz of 100'
    >>> words_of("/dev/ttyACM0", Status("opening")).text
    'waiting for /dev/ttyACM0 to say what it sends'
    """
    if status.state == "opening":
        return Words(opening or f"waiting for {name} to say what it sends", "warning")
    if status.stream is None:
        return Words(status.sentence or "not connected", "error" if status.sentence else "warning")
    parts = [_stream(status, standing or pace), *_counts(status)]
    if status.state == "ended":
        return Words("; ".join([status.sentence or "ended", *parts[1:]]), "error" if status.sentence else "warning")
    if not math.isnan(status.gone_s):
        gone = f"{name} is gone for {status.gone_s:.0f} s: plug it in again, it is found by itself; all lights are off"
        return Words("; ".join([gone, *parts[1:]]), "error")
    if math.isinf(status.age_s) and opening:
        return Words(f"{name}: waiting for its first frame", "warning")  # what is simulated or read is not there at once
    if silent(status, paused=bool(standing)):
        since = "no frame has come yet" if math.isinf(status.age_s) else f"stale: no frame for {status.age_s:.1f} s"
        return Words("; ".join([f"{name}, {since}; look at the device", *parts[1:]]), "error")
    kind = "warning" if len(parts) > 1 else "good"
    if contacts and not standing:
        parts.append(contacts)
    return Words("; ".join(parts), kind)


def _stream(status: Status, pace: str) -> str:
    stream = status.stream
    assert stream is not None
    many = len(stream.channels)
    nominal = f" of {stream.rate_hz:.4g}" if stream.rate_hz else ""
    # As it is called, unless that says so already.
    made = ", simulated" if stream.simulated and "simulated" not in stream.name else ""
    lately = pace or ("counting frames" if math.isnan(status.rate_hz) else f"{status.rate_hz:.0f} Hz{nominal}")
    return f"{stream.name}{made}: {many} channel{'s' * (many != 1)}, {lately}"


def _counts(status: Status) -> list[str]:
    counts = status.counts
    said = [f"{count:,} {word}" for count, word in ((counts.lost, "lost"), (counts.bad, "damaged"), (counts.late, "late")) if count]
    found = [", ".join(said)] if said else []
    if status.outages_s:
        times = "once" if len(status.outages_s) == 1 else f"{len(status.outages_s)} times"
        found.append(f"was gone {times}, {sum(status.outages_s):.1f} s in all, and is back")
    elif counts.reopened:
        found.append(f"the device began anew {counts.reopened} times" if counts.reopened > 1 else "the device began anew once")
    if counts.unchecked:
        found.append("frames have no checksum")
    return found
