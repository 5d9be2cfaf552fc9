import math

from gui.live.feed import Status
from gui.live.words import silent, words_of
from skinfab.readout.frame import Channel, Stream
from skinfab.readout.source import Counts

STREAM = Stream("skin", (Channel("S1"), Channel("S2")), 100.0)


def status(**given):
    return Status(**{"state": "running", "stream": STREAM, "rate_hz": 100.0, "age_s": 0.01} | given)


def test_all_is_well():
    words = words_of("port", status())
    assert words.kind == "good" and words.text == "skin: 2 channels, 100 Hz of 100"


def test_simulated_is_said():
    made = Stream("skin", STREAM.channels, 100.0, simulated=True)
    assert "simulated" in words_of("x", status(stream=made)).text


def test_stale_lost_and_gone():
    stale = words_of("port", status(age_s=2.04))
    assert stale.kind == "error" and "stale: no frame for 2.0 s" in stale.text
    assert "no frame has come yet" in words_of("port", status(age_s=math.inf)).text
    lost = words_of("port", status(counts=Counts(frames=10, lost=3, bad=1)))
    assert lost.kind == "warning" and "3 lost, 1 damaged" in lost.text
    gone = words_of("port", status(gone_s=3.0, age_s=3.0))
    assert gone.kind == "error" and "gone for 3 s" in gone.text
    assert "was gone once, 2.5 s in all, and is back" in words_of("port", status(outages_s=(2.5,), counts=Counts(reopened=2))).text
    assert "began anew once" in words_of("port", status(counts=Counts(reopened=1))).text
    assert "no checksum" in words_of("port", status(counts=Counts(unchecked=1))).text


def test_a_log_that_stands_is_not_stale():
    assert not silent(status(age_s=60.0), paused=True) and silent(status(age_s=60.0))
    assert words_of("log", status(age_s=60.0), standing="paused").text.endswith("paused")


def test_a_slow_stream_may_take_its_time():
    slow = status(stream=Stream("s", STREAM.channels, 2.0), age_s=3.0)
    assert not silent(slow) and silent(status(age_s=3.0))


def test_it_ends_with_its_reason():
    ended = words_of("port", Status("ended", "there is no port x"))
    assert ended.kind == "error" and ended.text == "there is no port x"
    assert words_of("port", Status("opening")).kind == "warning"
    assert words_of("port", status(state="ended", sentence="other stream", counts=Counts(lost=2))).text == "other stream; 2 lost"


def test_what_keeps_contacts_from_being_seen_is_added():
    assert words_of("port", status(), contacts="frozen: S1").text.endswith("frozen: S1")


def test_a_log_says_its_pace_and_not_a_rate():
    assert words_of("log", status(), pace="5 times its own pace").text == "skin: 2 channels, 5 times its own pace"
    assert words_of("log", status(), pace="5 times its own pace", standing="paused").text.endswith("paused")
    assert words_of("log", Status("opening"), opening="opening log").text == "opening log"


def test_what_is_simulated_or_read_is_no_device_to_look_at_before_its_first_frame():
    words = words_of("simulated hand", status(age_s=math.inf), opening="opening simulated hand")
    assert words.kind == "warning" and "waiting for its first frame" in words.text and "device" not in words.text
    assert words_of("port", status(age_s=math.inf)).kind == "error"


def test_no_rate_is_said_while_it_is_counted():
    assert words_of("port", status(rate_hz=math.nan)).text == "skin: 2 channels, counting frames"
