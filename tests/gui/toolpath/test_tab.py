"""The tab in a window: planned while it is seen, by the document as it is; checked; every moment told."""

import os
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import ImageGrab

from gcode.printer import load_printer
from gcode.write import write_skin
from gui.jobs.background import Background
from gui.state.profiles import ProfileShelf
from gui.state.selection import Target
from gui.state.session import Session
from gui.theme import DARK, LIGHT, apply, rgb
from gui.toolpath.choice import ArcsChoice
from gui.toolpath.tab import ToolPathTab


@pytest.fixture
def window(root, printed):
    root.geometry("560x640+0+0")
    apply(root, LIGHT)
    session, background, arcs, exported = Session(), Background(root), ArcsChoice(), []
    session.open(printed, None)
    tab = ToolPathTab(root, session, LIGHT, ProfileShelf(), background, arcs=arcs, export=lambda: exported.append(1))
    tab.session, tab.choice_of_arcs, tab.exported = session, arcs, exported
    yield tab
    background.close()


def wait(tab, until, seconds=20.0):
    end = time.monotonic() + seconds
    while not until():
        assert time.monotonic() < end, f"{tab.message.get()}; {[p.text for p in tab.session.problems]}"
        tab.update()
        time.sleep(0.005)


@pytest.fixture
def tab(window):
    """Seen, and planned."""
    window.pack(fill="both", expand=True)
    wait(window, lambda: window.planned is not None)
    window.update()
    return window


def replanned(tab, act):
    """Do something, and wait until the tab has followed."""
    before = tab.planned
    act()
    wait(tab, lambda: tab.planned is not before and tab.planned is not None)


def test_it_shows_the_file_that_is_written(tab, printed, tmp_path):
    write_skin(printed, tmp_path)
    assert "\n".join(tab.planned.line.lines) + "\n" == (tmp_path / "P1.gcode").read_text()
    assert tab.listing.text.get("1.0", "end").count("\n") == len(tab.planned.line.lines) + 1
    assert tab.choice.cget("values") == ("P1", "P2") and tab.piece.get() == "P1"
    assert tab.settings.title.get().startswith("ender5plus-vipro.toml")
    assert {child.cget("text").split()[0] for child in tab.legend.winfo_children()} >= {"━", "print", "travel", "prime"}


def test_nothing_is_planned_while_it_is_not_seen(window, printed):
    for _ in range(20):
        window.update()
        time.sleep(0.02)
    assert window.planned is None
    window.session.do("other", replace(printed, sensors=printed.sensors[:1]))
    window.pack(fill="both", expand=True)
    wait(window, lambda: window.planned is not None)
    shown = window.planned
    assert shown.line.patterns == ("", "C1")
    window.pack_forget()
    window.update()
    window.session.undo()
    end = time.monotonic() + 0.6
    while time.monotonic() < end:
        window.update()
    assert window.planned is shown
    replanned(window, lambda: window.pack(fill="both", expand=True))
    assert window.planned.line.patterns == ("", "C1", "C2")


def test_it_follows_the_document_and_keeps_the_time(tab, printed):
    tab.transport.seek(4.0)
    moved = replace(printed.sensors[0], x=18.0)
    replanned(tab, lambda: tab.session.do("move C1", replace(printed, sensors=(moved, *printed.sensors[1:]))))
    assert tab.transport.time == 4.0 and tab.facts.get().startswith("0:04.0 of")
    replanned(tab, lambda: tab.session.do("other printer", replace(tab.session.skin, printer="generic-grbl")))
    assert tab.planned.program.printer.spindle and tab.settings.title.get().startswith("generic-grbl.toml")
    assert any(line.startswith("M3 S") for line in tab.planned.line.lines)


def test_many_changes_in_a_row_are_planned_once(tab, printed, monkeypatch):
    from gui.toolpath import tab as module

    planned, plan = [], module.piece_program
    monkeypatch.setattr(module, "piece_program", lambda *a, **k: planned.append(1) or plan(*a, **k))
    for k in range(15):
        tab.session.do("move C1", replace(printed, sensors=(replace(printed.sensors[0], x=15 + 0.2 * k), *printed.sensors[1:])), merge=1)
        tab.update()
    wait(tab, lambda: tab.planned.skin is tab.session.skin)
    assert len(planned) == 1


def test_the_piece_is_chosen_or_selected(tab):
    replanned(tab, lambda: tab.session.select(Target(sensor="C3", piece="P2")))
    assert tab.planned.line.piece == "P2" == tab.piece.get() and tab.transport.time == tab.planned.line.end
    tab.piece.set("P1")
    replanned(tab, lambda: tab.choice.event_generate("<<ComboboxSelected>>"))
    assert tab.planned.line.piece == "P1"
    before = tab.planned
    tab.session.select(Target(piece="P1"))
    tab.update()
    assert tab.planned is before


def test_arcs_are_chosen_here_and_elsewhere(tab):
    assert any(line.startswith(("G2 ", "G3 ")) for line in tab.planned.line.lines)
    tab.arcs.current(2)
    replanned(tab, lambda: tab.arcs.event_generate("<<ComboboxSelected>>"))
    assert tab.choice_of_arcs.arcs == "lines" and not any(line.startswith(("G2 ", "G3 ")) for line in tab.planned.line.lines)
    replanned(tab, lambda: tab.choice_of_arcs.choose("native"))
    assert tab.arcs.get() == "G2 and G3"


def test_every_moment_is_told(tab):
    path = tab.planned.line
    for share in (0.0, 0.3, 0.8, 1.0):
        tab.transport.seek(share * path.end)
        tab.update()
        now = path.at(share * path.end)
        words = tab.facts.get()
        assert f"line {now.line} of {len(path.lines)}" in words and f"ink {now.ink:.1f} of {path.ink[-1]:.1f} mm³" in words
        assert now.role in words and tab.listing.marked == now.line
    assert "X" in words and "Z" in words


def test_a_line_or_a_step_is_gone_to(tab):
    path = tab.planned.line
    for k in range(len(path)):
        tab.seek_step(k)
        now = path.at(tab.transport.time)
        if path.timing.duration[path.index[k]] > 0:
            assert now.step == k and now.done == pytest.approx(1.0, abs=1e-6)
    tab.seek_line(int(path.line[12]))
    assert tab.listing.marked == path.line[12]


def test_check_says_that_all_is_well(tab):
    tab.check_button.invoke()
    wait(tab, lambda: tab.session.problems)
    (note,) = tab.session.problems
    assert note.kind == "note" and "no fault found on Creality" in note.text and tab.message.get() == "checked: no fault found"


def test_check_lists_faults_and_shows_the_first(tab, printed, tmp_path):
    profile = tmp_path / "thick.toml"
    profile.write_text('extends = "ender5plus-vipro"\n[nozzle]\nouter_radius = 11.0\n')
    replanned(tab, lambda: tab.session.do("other printer", replace(printed, printer=str(profile))))
    assert tab.settings.title.get().startswith(str(profile))
    tab.check()
    wait(tab, lambda: tab.session.problems)
    errors = [p for p in tab.session.problems if p.kind == "error"]
    judgement = tab.planned.program.judge()
    assert errors and "wall" in errors[0].text and errors[0].target.sensor in ("C1", "C2")
    assert tab.message.get() == f"checked: {len(judgement.findings)} faults, the first is shown"
    assert tab.listing.marked == judgement.findings[0].line
    # What was found is of that program alone.
    replanned(tab, tab.session.undo)
    assert not tab.session.problems


def test_a_sensor_that_lies_wrong_is_told_by_check(tab, printed):
    beside = replace(printed.sensors[0], x=2.0)
    replanned(tab, lambda: tab.session.do("move C1", replace(printed, sensors=(beside, *printed.sensors[1:]))))
    tab.check()
    wait(tab, lambda: tab.session.problems)
    assert "C1" in tab.session.problems[0].text and tab.message.get() == "not checked: see the problems"


def test_what_cannot_be_planned_is_a_sentence(tab, printed):
    before = load_printer()
    tab.session.do("other printer", replace(printed, printer="no-such-printer"))
    wait(tab, lambda: tab.planned is None)
    assert "no-such-printer" in tab.session.problems[0].text and "no-such-printer" in tab.message.get()
    assert tab.check_button.instate(["disabled"]) and tab.transport.play.instate(["disabled"]) and tab.facts.get() == ""
    tab.check()
    tab.seek_line(3)
    replanned(tab, tab.session.undo)
    assert not tab.session.problems and tab.planned.program.printer == before


def test_without_sensors_it_says_what_to_do(tab, printed):
    tab.session.do("remove all", replace(printed, sensors=()))
    wait(tab, lambda: tab.planned is None)
    assert "place a sensor" in tab.message.get() and tab.choice.cget("values") in ((), "")
    tab.restyle(DARK)
    tab.update()


def test_export_is_handed_on(tab):
    tab.nametowidget("top.export").invoke()
    assert tab.exported == [1]


def test_it_is_closed_while_it_plans(window, root, printed):
    window.pack(fill="both", expand=True)
    root.update()
    window.session.do("other", replace(printed, sensors=printed.sensors[:1]))
    window.destroy()
    end = time.monotonic() + 0.5
    while time.monotonic() < end:
        root.update()


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=lambda theme: theme.name)
def test_all_of_it_is_seen(tab, root, theme, tmp_path):
    """Nothing is cut off, and the picture has the theme's colours, in the room it has at 1280 x 800."""
    apply(root, theme)
    tab.restyle(theme)
    tab.transport.seek(tab.planned.line.end / 2)
    for _ in range(5):
        root.update()
    shot = ImageGrab.grab(xdisplay=os.environ["DISPLAY"])
    if folder := os.environ.get("SKINFAB_SCREENSHOTS"):
        shot.save(Path(folder) / f"toolpath-{theme.name}.png")
    picture = np.asarray(shot.convert("RGB"))[: root.winfo_height(), : root.winfo_width()].reshape(-1, 3)
    for colour in (theme.view, theme.ink, theme.panel, theme.accent):
        assert (np.abs(picture.astype(int) - rgb(colour)).max(axis=1) < 3).mean() > 0.0003, colour
    for name in ("top", "top.export", "legend", "transport", "transport.speed", "facts", "below"):
        widget = tab.nametowidget(name)
        assert widget.winfo_ismapped() and widget.winfo_width() >= widget.winfo_reqwidth() - 1, name
        assert widget.winfo_rootx() + widget.winfo_width() <= root.winfo_rootx() + root.winfo_width()
        assert widget.winfo_rooty() + widget.winfo_height() <= root.winfo_rooty() + root.winfo_height()
    assert tab.picture.size[1] > 150
