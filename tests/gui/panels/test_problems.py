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


def lines(panel):
    return [panel.list.item(k, "values")[1] for k in panel.list.get_children()]


def test_what_is_new_comes_first_and_notes_last(root, session):
    panel = ProblemsPanel(root, session, LIGHT)
    session.report("sensors", [Problem("C1 is outside", "sensors"), Problem("C2 is outside", "sensors")])
    session.report("flatten", [Problem("2 sensors taken off P1", "flatten", kind="warning")])
    session.report("export", [Problem("wrote 3 files", "export", kind="note")])
    assert lines(panel) == ["2 sensors taken off P1", "C1 is outside", "C2 is outside", "wrote 3 files"]
    session.report("sensors", [Problem("C2 is outside", "sensors"), Problem("C3 is outside", "sensors")])
    assert lines(panel) == ["C3 is outside", "2 sensors taken off P1", "C2 is outside", "wrote 3 files"]


def test_the_same_is_listed_once_and_shows_its_place(root, session):
    panel = ProblemsPanel(root, session, LIGHT)
    place = Target(piece="P1", sensor="C2")
    session.report("sensors", [Problem("C2 is 1.2 mm outside piece P1; move, turn or shrink it", "sensors", target=place)])
    session.report("export", [Problem("C2 is 1.2 mm outside piece P1; move, turn or shrink it", "export")])
    assert len(lines(panel)) == 1 and panel.title.get() == "Problems: 1 error"
    panel.list.selection_set("0")
    root.update()
    assert session.selected == place
    session.report("sensors", [])
    assert len(lines(panel)) == 1, "what nobody else says stays"
    session.report("export", [Problem("cannot write P1.gcode; close it", "export"), Problem("cannot write P1.gcode; close it", "gcode")])
    assert lines(panel) == ["cannot write P1.gcode; close it"]
