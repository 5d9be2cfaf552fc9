"""Which channel of a stream is which sensor of the skin, what it is called, and whether it is watched for contacts."""

from __future__ import annotations

from collections.abc import Sequence

from skinfab.readout.frame import Channel, Stream
from skinfab.skin import Skin
from skinfab.wiring import BOARD_INPUTS


def sensors_of(stream: Stream, skin: Skin | None) -> tuple[str, ...]:
    """The sensor of each channel, by id; "" where it has none.

    What a channel says of itself counts first: its sensor, then its board and input, as in the wiring table. Otherwise its place in
    the stream is its number, as skins count channels. One that measures something else than the sensor there is none of the skin's.
    """
    if skin is None:
        return ("",) * len(stream.channels)
    kinds, by_number = kinds_of(skin), {s.channel: s.id for s in skin.sensors}

    def sensor_of(channel: Channel, k: int) -> str:
        if channel.sensor in kinds:
            return channel.sensor
        there = by_number.get(number_of(channel, k), "")
        return there if not channel.kind or channel.kind == kinds.get(there) else ""

    return tuple(sensor_of(channel, k) for k, channel in enumerate(stream.channels))


def kinds_of(skin: Skin) -> dict[str, str]:
    """What each sensor measures, "contact" or "strain", by id: the first word of its pattern's name."""
    return {s.id: s.pattern.kind.split("-")[0] for s in skin.sensors}


def number_of(channel: Channel, place: int) -> int:
    """A channel's number over the whole skin, counted from 0.

    Examples
    --------
    >>> number_of(Channel("A"), 3), number_of(Channel("B", board=2, board_input=1), 3)
    (3, 17)
    """
    return (channel.board - 1) * BOARD_INPUTS + channel.board_input if channel.board > 0 else place


def watched(stream: Stream, sensors: Sequence[str], skin: Skin | None) -> tuple[str, ...]:
    """Names of the channels that are to be watched for contacts.

    Those that measure contact, by what the stream says or, where it says nothing, by the pattern of their sensor on the skin. All,
    where neither says anything of any.
    """
    kinds = {} if skin is None else kinds_of(skin)
    said = [channel.kind or kinds.get(sensor, "") for channel, sensor in zip(stream.channels, sensors, strict=True)]
    if not any(said):
        return stream.names
    return tuple(name for name, kind in zip(stream.names, said, strict=True) if kind == "contact")


def unread(sensors: Sequence[str], skin: Skin | None) -> str:
    """What to say of sensors of the skin that no channel of a stream is of; "" where there is none.

    Parameters
    ----------
    sensors : sequence of str
        The sensor of each channel; none of them where the source is of no skin's sensors at all, and nothing is said.
    skin : Skin, optional
    """
    left = [s for s in skin.sensors if s.id not in sensors] if skin is not None and any(sensors) else []
    if not left:
        return ""
    ids, numbers = (", ".join(map(str, each)) for each in ([s.id for s in left], [s.channel for s in left]))
    is_one = len(left) == 1
    return (
        f"no channel of the source is of {ids} (number{'s' * (not is_one)} {numbers}): no plot and no light of {'it' if is_one else 'them'}"
    )


def label(name: str, sensor: str) -> str:
    """What a strip is called: the sensor first, its channel where that is called otherwise.

    Examples
    --------
    >>> label("S3", "C1"), label("S3", "S3"), label("U", "")
    ('C1 (S3)', 'S3', 'U')
    """
    return f"{sensor} ({name})" if sensor and sensor != name else name
