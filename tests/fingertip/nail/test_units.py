"""Units that a log declares are converted; what is not known is refused, and what says nothing is taken as it is."""

from dataclasses import replace

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.improved import learn
from skinfab.fingertip.nail.labels import six_channels
from skinfab.fingertip.nail.live import NailWatch, decide_log
from skinfab.fingertip.nail.protocol import Protocol, session
from skinfab.fingertip.nail.simulator import RATE_HZ, nail_stream
from skinfab.fingertip.nail.units import CHANNELS, absent, channel_columns, units_said
from skinfab.readout.frame import Channel, Recording, Stream


def stream(acceleration: str, velocity: str, *, in_names: bool = False) -> Stream:
    units = [acceleration if name[0] == "A" else velocity for name in CHANNELS]
    names = [f"{name} ({unit})" if in_names else name for name, unit in zip(CHANNELS, units, strict=True)]
    return Stream("nail", tuple(Channel(name, unit) for name, unit in zip(names, units, strict=True)), RATE_HZ)


@pytest.mark.parametrize("in_names", [False, True])
def test_another_unit_is_the_same_log(in_names: bool) -> None:
    one = session("pins6", 1, protocol=Protocol(training=4, rounds=1, estimates=1, samples=256), seed=8)
    model, values = learn(one), one.rounds.readings.reshape(-1, 6)
    time = np.arange(len(values)) / RATE_HZ
    si = Recording.of_values(stream("m/s^2", "rad/s", in_names=in_names), values * ([9.80665] * 3 + [np.pi / 180] * 3), device_time=time)
    assert np.allclose(six_channels(si)[0], values)
    usual = Recording.of_values(nail_stream(), values, device_time=time)
    expected = [each.decision.label for each in decide_log(model, usual, samples=33, every=16)[0] if each.decision]
    assert [each.decision.label for each in decide_log(model, si, samples=33, every=16)[0] if each.decision] == expected
    watch = NailWatch(model, si.stream, samples=33, every=16)
    live = [made.decision.label for frame in si if (made := watch.step(frame)) is not None and made.decision]
    assert live == expected and len(expected) > 50


def test_what_is_not_known_is_refused() -> None:
    with pytest.raises(InputError, match=r"Ax is in furlong, which is not known; give G, g, mg"):
        channel_columns(stream("furlong", "deg/s"))
    with pytest.raises(InputError, match=r"Gx is in rpm, which is not known; give deg/s"):
        channel_columns(stream("G", "rpm"))
    with pytest.raises(InputError, match="2 columns Ax; leave one"):
        channel_columns(Stream("n", (Channel("Ax"), Channel("Ax (G)", "G")), 1400.0))
    with pytest.raises(InputError, match=r"capital letters count\); it has ax, ay; rename them so"):
        channel_columns(Stream("n", (Channel("ax"), Channel("ay")), 1400.0))


def test_what_says_nothing_is_taken_as_it_is() -> None:
    plain = stream("", "")
    assert not units_said(plain) and units_said(nail_stream()) and {scale for _, scale in channel_columns(plain)} == {1.0}
    assert not units_said(replace(plain, channels=(Channel("Ax", "G"), Channel("Ay"))))


def test_what_a_stream_has_not_is_named() -> None:
    stream = Stream("nail", tuple(Channel(name) for name in ("Ay", "Gx", "Ax", "Gy")), 1400.0)
    assert absent(stream) == ["stream nail has no Az, Gz, and is decided without"]
    assert absent(Stream("nail", tuple(Channel(name) for name in CHANNELS), 1400.0)) == []
