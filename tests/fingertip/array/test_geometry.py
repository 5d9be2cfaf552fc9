"""Where tactels lie, and which columns of a stream they are."""

import math

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.array.geometry import Geometry, tactel_columns, wrapped
from skinfab.readout.frame import Channel, Stream


def test_the_seeds_array() -> None:
    seed = Geometry()
    assert seed.stripe_pitch * seed.stripes == pytest.approx(2 * math.pi * 8.9)
    assert seed.half == pytest.approx((0.45 * 3.7, 0.45 * seed.stripe_pitch))
    assert seed.from_tactels(*seed.to_tactels(5.0, -1.0)) == pytest.approx((5.0, -1.0))


@pytest.mark.parametrize(("text", "pitch"), [("8x8", 3.7), ("8x16", 3.7), ("16x16", 1.85)])
def test_a_denser_array_covers_as_much(text: str, pitch: float) -> None:
    dense = Geometry.of_density(text)
    assert dense.ring_pitch == pitch and dense.rings * dense.ring_pitch == pytest.approx(29.6)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Geometry.of_density("8by8"), "no density"),
        (lambda: Geometry(2, 8), "4 to 64"),
        (lambda: Geometry(65, 8), "4 to 64"),
        (lambda: Geometry(skin=13.0), "thinner than the finger"),
        (lambda: Geometry(fill=1.1), "between 0 and 1"),
        (lambda: Geometry(ring_pitch=0.0), "no array"),
    ],
)
def test_what_is_no_array(make: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()  # type: ignore[operator]


def test_columns_are_found_among_others() -> None:
    seed = Geometry()
    channels = (Channel("temperature"), *reversed(seed.stream().channels), Channel("force_n"))
    shape, columns = tactel_columns(Stream("mixed", channels))
    assert shape == (8, 8)
    names = np.array([channel.name for channel in channels])
    assert names[columns][2, 5] == "r2s5"


@pytest.mark.parametrize(
    ("names", "says"), [(["a", "b"], "has no tactels"), (["r0s0", "r1s1"], "lacks 2 of 2 x 2"), (["r99s0"], "up to 64")]
)
def test_streams_without_an_array(names: list[str], says: str) -> None:
    with pytest.raises(InputError, match=says):
        tactel_columns(Stream("s", tuple(Channel(name) for name in names)))


@pytest.mark.parametrize("angle", [-7.0, -math.pi, 0.1, 3.2, 40.0])
def test_wrapped(angle: float) -> None:
    assert -math.pi <= wrapped(angle) <= math.pi and math.cos(wrapped(angle)) == pytest.approx(math.cos(angle))
