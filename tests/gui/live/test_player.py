import time

import numpy as np
import pytest

from gui.live.player import Player
from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream


def log(n=100, rate=100.0):
    return Recording.of_values(Stream("one", (Channel("U"),), rate), np.arange(float(n))[:, None], device_time=5 + np.arange(n) / rate)


def values(player):
    return [float(frame.values[0]) for frame in player]


def test_it_plays_all_of_it_in_its_time():
    began = time.monotonic()
    with Player(log(), speed=10.0) as player:
        assert values(player) == list(range(100)) and player.at_end and player.counts.frames == 100
    assert 0.09 < time.monotonic() - began < 1.0


def test_it_goes_on_from_where_it_was_sought_and_says_so_once():
    with Player(log(), speed=50.0) as player:
        player.read(1.0)
        player.seek(0.9)
        assert player.jumped() == 90 and player.jumped() is None and player.position_s == pytest.approx(0.9)
        assert values(player) == list(range(90, 100))
        player.seek(0.5)
        assert not player.at_end and values(player)[0] == 50


def test_it_stands_still_and_goes_on_where_it_stood():
    with Player(log(), speed=100.0) as player:
        player.read(1.0)
        player.pause(True)
        assert player.read(0.02) is None and player.counts.frames == 1
        player.pause(False)
        assert values(player)[0] == 1
        player.pause(False)  # at its end: from the start
        assert player.jumped() == 0 and values(player)[0] == 0


def test_a_seek_while_a_frame_is_waited_for_counts():
    slow = log(n=3, rate=0.1)
    with Player(slow, speed=1.0) as player:
        player.read(0.01)
        player.seek(20.0)
        assert float(player.read(0.01).values[0]) == 2.0


def test_frames_that_are_missing_are_counted_up_to_where_it_is():
    made = log(n=4)
    made.sequence[2:] += 5
    with Player(made, speed=100.0) as player:
        player.read(1.0)
        assert player.counts.lost == 0
        list(player)
        assert player.counts.lost == 5


def test_what_cannot_be_played_is_refused():
    with pytest.raises(InputError, match="speed"):
        Player(log(), speed=0.0)
    empty = Player(log(n=0))
    with empty:
        assert empty.at_end and empty.duration_s == 0.0 and empty.read(0.01) is None
