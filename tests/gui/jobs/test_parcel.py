"""What is sent arrives whole and can be written to; what was sent before is only named."""

import threading
from dataclasses import replace
from multiprocessing import Pipe

import numpy as np
import pytest

from gui.jobs.parcel import receive, send, shared
from skinfab.placement.lifted import Lifted


def through(message, known=(), theirs=()):
    """Send it from another thread, as another process would: pipes hold little."""
    ours, other = Pipe()
    sender = threading.Thread(target=send, args=(other, message, known))
    sender.start()
    received = receive(ours, theirs)
    sender.join(timeout=10)
    assert not sender.is_alive()
    return received


@pytest.mark.parametrize("shape", [(0, 2), (7, 3), (300_000, 3)])
def test_arrays_arrive_whole_and_can_be_written_to(shape):
    sent = np.random.default_rng(3).normal(size=shape)
    got = through({"a": sent, "b": [sent[::2], "words"]})
    assert np.array_equal(got["a"], sent) and np.array_equal(got["b"][0], sent[::2]) and got["b"][1] == "words"
    got["a"] += 1


def test_parts_of_a_document_that_were_sent_come_back_as_they_are(skin):
    there = through({"skin": skin})["skin"]
    changed = replace(there, sensors=(there.sensors[0], replace(there.sensors[1], x=9.0)), seed=5)
    back = through(changed, shared({"skin": there}), shared({"skin": skin}))
    assert back.seed == 5 and back.sensors[1].x == 9.0
    assert back.mesh is skin.mesh and back.seams is skin.seams and back.pieces[1] is skin.pieces[1] and back.sensors[0] is skin.sensors[0]
    assert through(there, shared({"skin": there}), shared({"skin": skin})) is skin


def test_who_is_gone_is_an_end_not_a_wait():
    ours, other = Pipe()
    other.send([1000])
    other.send_bytes(b"")
    other.close()
    with pytest.raises(EOFError):
        receive(ours)
    with pytest.raises((BrokenPipeError, ConnectionResetError)):
        send(ours, np.zeros(10))


def test_lifted_sensors_come_back_with_their_own_pieces(skin):
    ours = {"skin": replace(skin, pieces=(), sensors=(), lifted=(Lifted(skin.sensors[0], skin.pieces[0], "overlaps C9", 3),))}
    theirs = through(ours)
    (back,) = through(theirs["skin"].lifted, shared(theirs), shared(ours))
    assert back is ours["skin"].lifted[0]
    waiting = replace(theirs["skin"].lifted[0], why="")
    (back,) = through((waiting,), shared(theirs), shared(ours))
    assert back.piece is skin.pieces[0] and back.sensor is skin.sensors[0] and (back.why, back.place) == ("", 3)
