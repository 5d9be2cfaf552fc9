"""The worst first, and a line shows its place."""

from gui.panels.problems import ProblemsPanel
from gui.state.problem import Problem
from gui.state.selection import Target
from gui.theme import DARK, LIGHT


def test_lines_are_those_of_the_session(root, session):
    panel = ProblemsPanel(root, session, LIGHT)
    panel.pack()
    assert panel.title.get() == "No problems"
    session.report("open", [Problem("units were guessed: mm", "open", kind="note")])
    session.report("sensors", [Problem("C2 is 0.6 mm outside piece P1", "sensors", target=Target(piece="P1", sensor="C2"))])
    lines = [panel.list.item(k, "values") for k in panel.list.get_children()]
    assert lines == [("error", "C2 is 0.6 mm outside piece P1"), ("note", "units were guessed: mm")]
    assert panel.title.get() == "Problems: 1 error, 1 note"


def test_a_click_shows_the_place(root, session):
    panel = ProblemsPanel(root, session, LIGHT)
    panel.pack()
    session.report("sensors", [Problem("C2 is outside", "sensors", target=Target(piece="P1", sensor="C2"))])
    session.report("open", [Problem("repaired", "open", kind="note")])
    panel.list.selection_set("1")
    root.update()
    assert session.selected == Target()
    panel.list.selection_set("0")
    root.update()
    assert session.selected == Target(piece="P1", sensor="C2")


def test_it_can_change_its_colours(root, session):
    panel = ProblemsPanel(root, session, LIGHT)
    panel.restyle(DARK)
    assert str(panel.list.tag_configure("error", "foreground")) == DARK.error


def test_a_long_sentence_is_read_to_its_end(root, session):
    panel = ProblemsPanel(root, session, LIGHT)
    panel.pack(fill="x")
    root.update()
    text = " ".join(f"word{k}" for k in range(60)) + "; give 0.96 mm or less"
    session.report("flatten", [Problem(text, "flatten", target=Target(piece="P1"))])
    rows = panel.list.get_children()
    assert len(rows) >= 3 and " ".join(panel.list.item(row, "values")[1] for row in rows) == text
    assert [panel.list.item(row, "values")[0] for row in rows] == ["error"] + [""] * (len(rows) - 1)
    panel.list.selection_set(rows[-1])
    root.update()
    assert session.selected == Target(piece="P1")
    root.geometry("700x400")
    root.update()
    assert len(panel.list.get_children()) > len(rows)
