from dataclasses import replace

from gui.live.channels import sensors_of, unread, watched
from skinfab.patterns.registry import make_pattern
from skinfab.placement.sensor import Sensor
from skinfab.readout.frame import Channel, Stream


def test_what_a_channel_says_of_itself_counts_before_its_place(skin):
    stream = Stream("s", (Channel("a", sensor="C2"), Channel("b", board=1, board_input=0), Channel("c", sensor="cube-S1"), Channel("d")))
    assert sensors_of(stream, skin) == ("C2", "C1", "", "")
    assert sensors_of(Stream("s", (Channel("a"), Channel("b"), Channel("c"))), skin) == ("C1", "C2", "")
    assert sensors_of(stream, None) == ("", "", "", "")


def test_a_sensor_on_the_second_board(skin):
    far = replace(skin, sensors=(replace(skin.sensors[0], channel=17), skin.sensors[1]))
    stream = Stream("s", (Channel("x", board=2, board_input=1), Channel("y", board=1, board_input=1)))
    assert sensors_of(stream, far) == ("C1", "C2")


def test_a_channel_that_measures_something_else_is_none_of_the_skins(skin):
    stream = Stream("s", (Channel("a", kind="angle"), Channel("b", kind="contact"), Channel("c", kind="strain", sensor="C1")))
    assert sensors_of(stream, skin) == ("", "C2", "C1")


def test_only_what_measures_contact_is_watched(skin):
    kinds = Stream("s", (Channel("a", kind="contact"), Channel("b", kind="strain")))
    assert watched(kinds, ("", ""), None) == ("a",)
    assert watched(Stream("s", (Channel("a", kind="strain"),)), ("",), None) == ()
    plain = Stream("s", (Channel("a"), Channel("b"), Channel("c")))
    assert watched(plain, ("", "", ""), None) == ("a", "b", "c")
    bend = Sensor("S1", "P1", make_pattern("strain-lines", {"l1": 53, "l2": 43, "b": 6}), 10.0, 10.0, 0.0, 2)
    mixed = replace(skin, sensors=(*skin.sensors, bend))
    assert watched(plain, sensors_of(plain, mixed), mixed) == ("a", "b")


def test_sensors_that_no_channel_is_of_are_told(skin):
    assert unread(("C1", "C2"), skin) == unread(("", ""), skin) == unread(("C1",), None) == ""
    assert unread(("C1", ""), skin) == "no channel of the source is of C2 (number 1): no plot and no light of it"
    three = replace(skin, sensors=(*skin.sensors, replace(skin.sensors[0], id="C3", channel=7)))
    assert unread(("C1", ""), three) == "no channel of the source is of C2, C3 (numbers 1, 7): no plot and no light of them"
