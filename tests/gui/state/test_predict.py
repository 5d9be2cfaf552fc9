"""Length, ink, resistance and strain of a sensor, before it is printed."""

from dataclasses import replace

import pytest

from gui.state.predict import predict, worn, worn_strain
from gui.state.profiles import ProfileShelf
from skinfab.electrical import ink_volume, resistance
from skinfab.errors import InputError


@pytest.fixture
def used(skin):
    return ProfileShelf().of(skin)


def test_length_is_the_conductors_and_ink_the_whole_beads(skin, used):
    sensor = skin.sensors[0]
    found = predict(sensor, used)
    assert found.length == sensor.path.length < sensor.printed_path.length
    ink = used.material.ink
    assert found.ink_mm3 == ink_volume(sensor.printed_path.length, ink) > ink_volume(sensor.path.length, ink)
    assert found.resistance == resistance(sensor.path.length, ink) and found.resistance.low < found.resistance.high


def test_twice_the_sensor_is_twice_the_ink(skin, used):
    small = skin.sensors[0]
    large = replace(small, pattern=replace(small.pattern, s=small.pattern.s * 2))
    one, two = predict(small, used), predict(large, used)
    assert two.ink_mm3 / one.ink_mm3 == pytest.approx(large.printed_path.length / small.printed_path.length, rel=1e-9)
    assert two.resistance.low > one.resistance.low


def test_on_a_flat_object_wearing_stretches_nothing(skin, used):
    strain = worn_strain(skin, skin.sensors[0], used, worn(skin, used))
    assert abs(strain.mean) < 1e-9


def test_a_sensor_beside_its_piece_is_refused(skin, used):
    astray = replace(skin.sensors[0], x=99.0)
    with pytest.raises(InputError, match=r"outside|piece"):
        worn_strain(skin, astray, used, worn(skin, used))
