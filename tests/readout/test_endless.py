import itertools

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.readout.endless import endless
from skinfab.readout.frame import Channel, Recording, Stream

STREAM = Stream("s", (Channel("U"),), 2000.0, simulated=True)


def recording(values, stream=STREAM):
    return Recording.of_values(stream, np.array(values)[:, None], device_time=7 + np.arange(len(values)) / 2000)


def test_times_and_counts_go_on_from_one_to_the_next():
    with endless(STREAM, lambda: [recording([1.0, 2.0]), recording([3.0])]) as source:
        frames = list(source)
    assert [f.values[0] for f in frames] == [1.0, 2.0, 3.0] and [f.sequence for f in frames] == [0, 1, 2]
    assert np.allclose([f.device_time for f in frames], [0, 0.0005, 0.001])


def test_it_begins_anew_when_it_is_opened_again_and_need_not_end():
    source = endless(STREAM, lambda: itertools.repeat(recording([1.0, 2.0])))
    for _ in range(2):
        with source:
            assert [source.read(1.0).values[0] for _ in range(5)] == [1.0, 2.0, 1.0, 2.0, 1.0]


def test_a_recording_of_other_channels_is_refused():
    other = recording([1.0], Stream("t", (Channel("V"),), 2000.0))
    with pytest.raises(InputError, match="goes on with other channels, V"), endless(STREAM, lambda: [other]) as source:
        source.read(1.0)
