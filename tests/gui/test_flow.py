"""A row of widgets that goes on below itself."""

from tkinter import ttk

import pytest

from gui.flow import Flow


@pytest.fixture
def bar(root):
    flow = Flow(root, name="bar")
    flow.pack(side="top", fill="x")
    for k in range(12):
        if k == 6:
            flow.add(ttk.Separator(flow, orient="vertical", name="line"), padx=5, divides=True)
        flow.add(ttk.Button(flow, text=f"button {k}", name=f"b{k}"))
    return flow


def rows(bar):
    return sorted({child.winfo_y() for child in bar.winfo_children() if child.winfo_class() == "TButton"})


def test_in_a_wide_window_it_is_one_row_and_in_a_narrow_one_all_are_still_there(root, bar):
    root.update()
    assert len(rows(bar)) == 1 and bar.nametowidget("line").winfo_ismapped()
    root.geometry("420x300")
    for _ in range(3):
        root.update()
    assert len(rows(bar)) >= 3
    for child in bar.winfo_children():
        if child.winfo_class() == "TButton":
            assert child.winfo_x() + child.winfo_width() <= bar.winfo_width()
            assert child.winfo_y() + child.winfo_height() <= bar.winfo_height()
    root.geometry("1270x300")
    for _ in range(3):
        root.update()
    assert len(rows(bar)) == 1


def test_a_line_between_groups_begins_no_row(root, bar):
    root.update()
    line, last = bar.nametowidget("line"), bar.nametowidget("b5")
    root.geometry(f"{last.winfo_x() + last.winfo_width() + 12}x300")
    for _ in range(3):
        root.update()
    assert len(rows(bar)) >= 2 and (not line.winfo_ismapped() or line.winfo_x() > last.winfo_x())


def test_closed_at_once_it_leaves_nothing_waiting(root, bar):
    bar.destroy()
    root.update()
