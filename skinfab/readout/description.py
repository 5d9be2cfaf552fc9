"""A stream's description as JSON: it stands at the head of every recording, whatever the file's format."""

from __future__ import annotations

import json
import math
from typing import Any

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Stream
from skinfab.strict_json import strict_json

SCHEMA = 1


def stream_to_json(stream: Stream) -> str:
    """One line of JSON; an end of a range that nobody stated is null.

    Examples
    --------
    >>> text = stream_to_json(Stream("finger", (Channel("S1", "V", low=0.0),), 100.0, simulated=True))
    >>> stream_of_json(text).channels[0]
    Channel(name='S1', unit='V', kind='', low=0.0, high=inf, sensor='', board=0, board_input=0)
    """
    channels = [
        {
            "name": c.name,
            "unit": c.unit,
            "kind": c.kind,
            "low": _finite(c.low),
            "high": _finite(c.high),
            "sensor": c.sensor,
            "board": c.board,
            "input": c.board_input,
        }
        for c in stream.channels
    ]
    content = {"schema": SCHEMA, "name": stream.name, "rate_hz": stream.rate_hz, "simulated": stream.simulated, "channels": channels}
    return json.dumps(content, allow_nan=False)


def stream_of_json(text: str | bytes) -> Stream:
    """What `stream_to_json` wrote, or a device's own words: there a key may be missing whose value says nothing.

    Examples
    --------
    >>> stream_of_json('{"schema": 1, "name": "skin", "channels": [{"name": "S1", "unit": "V"}]}').names
    ('S1',)

    Raises
    ------
    InputError
        It is no such description, of a newer schema, or a part of it is missing or of the wrong kind.
    """
    try:
        content = strict_json(text)
    except (ValueError, RecursionError) as fault:
        raise InputError(f"the description of the stream is no JSON ({fault}); the file is damaged") from fault
    if not isinstance(content, dict) or "schema" not in content:
        raise InputError("the description of the stream is no JSON object with a schema; the file is damaged")
    if content["schema"] != SCHEMA:
        raise InputError(f"the stream's description has schema {content['schema']!r}, and this skinfab reads {SCHEMA}; update skinfab")
    try:
        channels = tuple(
            Channel(
                _text(c["name"]),
                _text(c.get("unit", "")),
                _text(c.get("kind", "")),
                -math.inf if c.get("low") is None else _number(c["low"]),
                math.inf if c.get("high") is None else _number(c["high"]),
                _text(c.get("sensor", "")),
                _whole(c.get("board", 0)),
                _whole(c.get("input", 0)),
            )
            for c in content["channels"]
        )
        simulated = content.get("simulated", False)
        if not isinstance(simulated, bool):
            raise TypeError(f"{simulated!r} is neither true nor false")
        return Stream(_text(content["name"]), channels, _number(content.get("rate_hz", 0.0)), simulated)
    except KeyError as fault:
        raise InputError(f"the description of the stream lacks {fault.args[0]!r}; the file is damaged") from fault
    except (TypeError, AttributeError, OverflowError) as fault:
        raise InputError(f"the description of the stream has a part of the wrong kind ({fault}); the file is damaged") from fault


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{value!r} is no text")
    return value


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise TypeError(f"{value!r} is no number")
    return float(value)


def _whole(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise TypeError(f"{value!r} is no whole number")
    return value
