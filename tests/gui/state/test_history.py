"""Undo and redo, and what a drag leaves in them."""

from gui.state.history import MOST_STEPS, History


def test_undo_and_redo_walk_the_same_steps():
    history = History("a")
    history.do("b", "B")
    history.do("c", "C")
    assert [history.undo(), history.undo(), history.undo()] == ["c", "b", None]
    assert history.now == "a"
    assert [history.redo(), history.redo(), history.redo()] == ["b", "c", None]
    assert history.now == "C"


def test_a_new_step_forgets_what_was_undone():
    history = History(0)
    history.do("one", 1)
    history.undo()
    history.do("two", 2)
    assert history.redo() is None and history.now == 2 and history.undo_label == "two"


def test_the_steps_of_one_drag_are_one():
    history = History(0)
    for value in range(1, 6):
        history.do("move C1", value, merge="drag 1")
    history.do("move C1", 9, merge="drag 2")
    assert history.undo() == "move C1" and history.now == 5
    assert history.undo() == "move C1" and history.now == 0


def test_a_drag_after_undo_is_a_step_of_its_own():
    history = History(0)
    history.do("move", 1, merge="drag")
    history.do("move", 2, merge="drag")
    history.undo()
    history.do("move", 3, merge="drag")
    assert history.undo() == "move" and history.now == 0


def test_the_past_is_bounded():
    history = History(0)
    for value in range(MOST_STEPS + 50):
        history.do("step", value)
    count = 0
    while history.undo() is not None:
        count += 1
    assert count == MOST_STEPS


def test_a_step_has_a_number_that_undo_and_redo_come_back_to():
    history = History("a")
    history.do("b", "b")
    history.amend("bb")
    first = history.step
    history.do("c", "c", merge="drag")
    history.do("d", "d", merge="drag")
    second = history.step
    assert 0 < first < second
    history.undo()
    assert history.step == first
    history.undo()
    assert history.step == 0
    history.redo()
    assert history.step == first
    history.do("e", "e")
    assert history.step > second, "never the number of a step that was forgotten"
