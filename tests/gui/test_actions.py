"""One table makes menus, buttons and keys."""

from tkinter import ttk

import pytest

from gui.actions import Action, Actions


@pytest.fixture
def table(root):
    done, on = [], {"can": True, "cut": False}
    actions = Actions(
        root,
        [
            Action("open", "Open …", "File", lambda: done.append("open"), "Control-o", tool=True, tip="Open a mesh."),
            Action("save", "Save", "File", lambda: done.append("save"), "Control-s", lambda: on["can"], tool=True),
            Action("undo", "Undo", "Edit", lambda: done.append("undo"), "Control-z"),
            Action("cut", "Cut", "Tools", lambda: done.append("cut"), "c", tool=True, checked=lambda: on["cut"]),
        ],
    )
    return actions, done, on


def press(root, key, widget=None):
    target = widget or root
    target.focus_force()
    root.update()
    target.event_generate(f"<{key}>")
    root.update()


def test_a_key_does_what_its_menu_says(root, table):
    actions, done, on = table
    bar = actions.menu_bar({})
    root.configure(menu=bar)
    press(root, "Control-s")
    press(root, "Control-S")
    on["can"] = False
    press(root, "Control-s")
    assert done == ["save", "save"] and not actions.do("save") and actions.do("undo")
    menu = root.nametowidget(bar.entrycget(0, "menu"))
    assert [menu.entrycget(k, "label") for k in (0, 1)] == ["Open …", "Save"]
    assert menu.entrycget(0, "accelerator") == "Ctrl+O"
    actions.refresh()
    assert menu.entrycget(1, "state") == "disabled"


def test_a_letter_with_alt_opens_a_menu_and_does_nothing_else(root):
    done = []
    menus = ("Edit", "Seams", "Sensors", "Export", "Help")
    listed = [
        Action(name, name, name, lambda name=name: done.append(name), name[0].lower() if name in ("Edit", "Seams") else "")
        for name in menus
    ]
    bar = Actions(root, listed).menu_bar({})
    letters = [bar.entrycget(k, "label")[bar.entrycget(k, "underline")].lower() for k in range(len(menus))]
    assert letters == ["e", "s", "n", "x", "h"]
    press(root, "Alt-s")
    press(root, "Alt-e")
    assert done == []
    press(root, "s")
    assert done == ["Seams"]


def test_letters_typed_into_a_field_stay_there(root, table):
    _, done, _ = table
    entry = ttk.Entry(root)
    entry.pack()
    press(root, "c", entry)
    assert done == [] and entry.get() == "c"
    press(root, "Control-o", entry)
    assert done == ["open"]


def test_buttons_follow_the_state(root, table):
    actions, done, on = table
    tips = []
    bar = actions.tool_bar(root, tips.append)
    bar.pack()
    on.update(can=False, cut=True)
    actions.refresh()
    save, cut = bar.nametowidget("save"), bar.nametowidget("cut")
    assert save.instate(["disabled"]) and cut.instate(["selected"])
    bar.nametowidget("open").invoke()
    assert done == ["open"]
    bar.nametowidget("open").event_generate("<Enter>")
    bar.nametowidget("open").event_generate("<Leave>")
    assert tips == ["Open a mesh. (Ctrl+O)", ""]


def test_a_submenu_is_filled_when_it_is_opened(root, table):
    actions, _, _ = table
    files = ["a.skin"]
    bar = actions.menu_bar({"File/open/Open recent": lambda menu: [menu.add_command(label=f) for f in files]})
    menu = root.nametowidget(bar.entrycget(0, "menu"))
    assert menu.entrycget(1, "label") == "Open recent" and menu.entrycget(2, "label") == "Save"
    below = root.nametowidget(menu.entrycget(1, "menu"))
    files.append("b.skin")
    root.tk.call(*root.tk.splitlist(below.cget("postcommand")))
    assert [below.entrycget(k, "label") for k in range(2)] == ["a.skin", "b.skin"]


def test_two_actions_cannot_share_a_key(root):
    with pytest.raises(ValueError, match="key Control-s is used by two"):
        Actions(root, [Action("a", "A", "File", print, "Control-s"), Action("b", "B", "File", print, "Control-s")])


def test_the_help_lists_every_key(root, table):
    actions, _, _ = table
    assert list(actions.keys()) == [("Ctrl+O", "Open"), ("Ctrl+S", "Save"), ("Ctrl+Z", "Undo"), ("C", "Cut")]


def test_caps_lock_changes_no_key(root, table):
    _, done, _ = table
    for key in ("Control-O", "Control-Z", "C"):
        press(root, key)
    assert done == ["open", "undo", "cut"]
    actions = Actions(root, [Action("as", "Save as …", "File", lambda: done.append("as"), "Control-Shift-S")])
    press(root, "Control-Shift-s")
    assert done[-1] == "as" and actions["as"].key == "Control-Shift-S"
