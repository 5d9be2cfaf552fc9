"""A stream's description survives JSON, and what is none is refused in one line."""

import json
import math

import pytest

from skinfab.errors import InputError
from skinfab.readout.description import stream_of_json, stream_to_json
from skinfab.readout.frame import Channel, Stream

STREAM = Stream(
    "skin of the finger",
    (Channel("S1", "V", "strain", 0.1, 3.3, "S1", 2, 15), Channel("C1", low=-math.inf, high=0.1 + 0.2), Channel("Ω ü", "kΩ")),
    1 / 3,
    simulated=True,
)


def test_nothing_is_lost() -> None:
    assert stream_of_json(stream_to_json(STREAM)) == STREAM
    assert stream_of_json(stream_to_json(Stream("", ()))) == Stream("", ())


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"schema": 2}, "schema 2"),
        ({"channels": None}, "wrong kind"),
        ({"channels": [{}]}, "'name'"),
        ({"channels": [3]}, "wrong kind"),
        ({"rate_hz": "fast"}, "'fast' is no number"),
        ({"rate_hz": -1}, "-1 Hz"),
        ({"rate_hz": 10**400}, "is too large a number"),
        ({"simulated": "no"}, "neither true nor false"),
        ({"name": 3}, "no text"),
    ],
)
def test_a_wrong_part_is_named(change: dict[str, object], says: str) -> None:
    with pytest.raises(InputError, match=says):
        stream_of_json(json.dumps(json.loads(stream_to_json(STREAM)) | change))


@pytest.mark.parametrize("text", ["", "{", "[]", "3", "{}", "[" * 100_000, b"\xff\xfe"])
def test_garbage_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="description"):
        stream_of_json(text)
