"""What is said of sensors that a cut took off."""

from dataclasses import replace

from gui.state.lifted import taken_off
from skinfab.placement.lifted import Lifted


def test_one_line_a_piece_and_one_for_each_that_does_not_fit(skin):
    C1, C2 = skin.sensors
    other = replace(C2, id="C3", piece="P2")
    lifted = [Lifted(C1, skin.pieces[0]), Lifted(C2, skin.pieces[0]), Lifted(other, skin.pieces[1])]
    assert [p.text for p in taken_off(lifted, by_last_step=True)] == [
        "2 sensors taken off P1 until it lies flat again; Ctrl+Z brings them back",
        "C3 taken off P2 until it lies flat again; Ctrl+Z brings it back",
    ]
    waiting = [replace(lifted[0], why="overlaps C9"), lifted[1]]
    assert [p.text for p in taken_off(waiting, by_last_step=False)] == [
        "C2 taken off P1 until it lies flat again",
        "C1 stays off: overlaps C9; make room for it and press F6, or place another",
    ]
