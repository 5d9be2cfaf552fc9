"""Everything the window can be told to do, in one table: menus, tool bar, keys and their list are made from it."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from tkinter import ttk

from gui.flow import Flow

#: Words of a key as Tk writes them, and as people read them.
_KEY_WORDS = (("Control-", "Ctrl+"), ("Shift-", "Shift+"), ("Alt-", "Alt+"), ("Key-", ""), ("Return", "Enter"), ("space", "Space"))

#: Bits of an event's state that say Alt is held: the X server's own, and Tk's.
_ALT = 0x8 | 0x20000

#: Classes of widgets that do something of their own when Space is pressed.
_PRESSED_BY_SPACE = ("TButton", "TCheckbutton", "TRadiobutton", "Treeview", "Button", "Checkbutton", "Radiobutton", "Listbox")


def always() -> bool:
    """Can be done at any time."""
    return True


def _settled(id: str) -> bool:
    return True


@dataclass(frozen=True)
class Action:
    """One thing the user can do.

    Parameters
    ----------
    id : str
        Unique, a Tk name too: "save".
    label : str
        What menus and buttons say.
    menu : str
        The menu it is in: "File", "Edit", ...; "" for none.
    run : callable
    key : str
        As Tk writes it, without brackets: "Control-s"; "" for none.
    enabled : callable
        Whether it can be done now.
    tip : str
        One sentence, shown over its button and in the status bar.
    tool : bool
        Has a button in the tool bar.
    checked : callable, optional
        For one that is on or off: whether it is on.
    """

    id: str
    label: str
    menu: str
    run: Callable[[], object]
    key: str = ""
    enabled: Callable[[], bool] = always
    tip: str = ""
    tool: bool = False
    checked: Callable[[], bool] | None = None


def key_words(key: str) -> str:
    """A key as people read it.

    Examples
    --------
    >>> key_words("Control-Shift-s"), key_words("Key-1"), key_words("F1")
    ('Ctrl+Shift+S', '1', 'F1')
    """
    for written, read in _KEY_WORDS:
        key = key.replace(written, read)
    head, plus, last = key.rpartition("+")
    return head + plus + (last.upper() if len(last) == 1 else last)


class Actions:
    """The table, and what is made from it.

    Parameters
    ----------
    root : Tk
        Its keys are bound here.
    actions : sequence of Action
        In the order of the menus.
    settle : callable, optional
        Called with an action's id before it is done, to see to a text that is being typed; whether it may go on.

    Raises
    ------
    ValueError
        Two have the same id or key.
    """

    def __init__(self, root: tk.Tk, actions: Sequence[Action], *, settle: Callable[[str], bool] = _settled) -> None:
        self.all = tuple(actions)
        self._settle = settle
        for what, words in (("id", [a.id for a in self.all]), ("key", [a.key for a in self.all if a.key])):
            twice = {word for word in words if words.count(word) > 1}
            if twice:
                raise ValueError(f"{what} {', '.join(sorted(twice))} is used by two actions")
        self._root = root
        self._buttons: list[tuple[Action, ttk.Button | ttk.Checkbutton, tk.BooleanVar | None]] = []
        self._checks: dict[str, tk.BooleanVar] = {}
        self._menus: list[tuple[tk.Menu, list[tuple[int, Action]]]] = []
        for action in self.all:
            if action.key:
                root.bind(f"<{action.key}>", self._on_key(action))
                # With Caps Lock Tk calls a letter by its other case.
                before, letter = action.key[:-1], action.key[-1]
                if letter.isalpha() and before in ("", "Control-", "Control-Shift-"):
                    root.bind(f"<{before}{letter.swapcase()}>", self._on_key(action))

    def __getitem__(self, id: str) -> Action:
        return next(a for a in self.all if a.id == id)

    def do(self, id: str) -> bool:
        """Do it if it can be done now; whether it was."""
        return self._do(self[id])

    def _do(self, action: Action) -> bool:
        if not self._settle(action.id) or not action.enabled():
            return False
        action.run()
        return True

    def menu_bar(self, submenus: Mapping[str, Callable[[tk.Menu], None]]) -> tk.Menu:
        """A menu bar; `submenus` ("File/Open recent") are filled by their callables whenever they are opened."""
        bar = tk.Menu(self._root, tearoff=False, name="menu")
        letters: set[str] = set()
        for name in dict.fromkeys(a.menu for a in self.all if a.menu):
            menu = tk.Menu(bar, tearoff=False, name=name.lower())
            entries = []
            for action in (a for a in self.all if a.menu == name):
                accelerator = key_words(action.key)
                if action.checked is None:
                    menu.add_command(label=action.label, accelerator=accelerator, command=partial(self._press, action))
                else:
                    var = self._checks.setdefault(action.id, tk.BooleanVar(self._root))
                    menu.add_checkbutton(label=action.label, accelerator=accelerator, command=partial(self._press, action), variable=var)
                entries.append((menu.index("end") or 0, action))
                self._insert_submenu(menu, f"{name}/{action.id}", submenus)
            menu.configure(postcommand=self.refresh)
            # Seams and Sensors, Edit and Export: a letter opens one menu only.
            underlined = next((k for k, letter in enumerate(name.lower()) if letter not in letters), 0)
            letters.add(name[underlined].lower())
            bar.add_cascade(label=name, menu=menu, underline=underlined)
            self._menus.append((menu, entries))
        return bar

    def tool_bar(self, master: tk.Misc, show_tip: Callable[[str], None]) -> ttk.Frame:
        """A slim row of buttons, two where the window is narrow; `show_tip` is called with a sentence, or "" when the pointer leaves."""
        bar = Flow(master, margin=6, name="toolbar")
        before = ""
        for action in (a for a in self.all if a.tool):
            if before and action.menu != before:
                bar.add(ttk.Separator(bar, orient="vertical"), padx=5, divides=True)
            before = action.menu
            button: ttk.Button | ttk.Checkbutton
            var = None
            text = action.label.removesuffix(" …")
            press = partial(self._press, action)
            if action.checked is None:
                button = ttk.Button(bar, text=text, command=press, style="Tool.TButton", name=action.id, takefocus=True)
            else:
                var = self._checks.setdefault(action.id, tk.BooleanVar(self._root))
                button = ttk.Checkbutton(bar, text=text, command=press, style="Tool.Toolbutton", variable=var, name=action.id)
            key = f" ({key_words(action.key)})" if action.key else ""
            _bind_tip(button, f"{action.tip or action.label}{key}", show_tip)
            bar.add(button)
            self._buttons.append((action, button, var))
        return bar

    def _press(self, action: Action) -> None:
        """By a menu or a button; what Tk has ticked by itself is put right where nothing came of it."""
        if not self._do(action):
            self.refresh()

    def refresh(self) -> None:
        """Grey out what cannot be done now, and tick what is on."""
        for action in self.all:
            if action.checked is not None and action.id in self._checks:
                self._checks[action.id].set(action.checked())
        for action, button, _ in self._buttons:
            button.state(["!disabled" if action.enabled() else "disabled"])
        for menu, entries in self._menus:
            for index, action in entries:
                menu.entryconfigure(index, state="normal" if action.enabled() else "disabled")

    def keys(self) -> Iterable[tuple[str, str]]:
        """Every key and what it does, for the help."""
        return ((key_words(a.key), a.label.removesuffix(" …")) for a in self.all if a.key)

    def _insert_submenu(self, menu: tk.Menu, place: str, submenus: Mapping[str, Callable[[tk.Menu], None]]) -> None:
        """A submenu named "Open recent" stands behind the action whose place it gives: "File/open/Open recent"."""
        for name, fill in submenus.items():
            where, _, label = name.rpartition("/")
            if where != place:
                continue
            below = tk.Menu(menu, tearoff=False)
            below.configure(postcommand=_refill(below, fill))
            menu.add_cascade(label=label, menu=below)

    def _on_key(self, action: Action) -> Callable[[tk.Event], str | None]:
        def pressed(event: tk.Event) -> str | None:
            # A letter typed into a field is meant for the field.
            if isinstance(event.widget, (tk.Entry, ttk.Entry, tk.Text)) and not action.key.startswith(("Control-", "F", "Alt-")):
                return None
            # Alt and a letter open a menu.
            if int(event.state) & _ALT and "Alt-" not in action.key:
                return None
            # Space presses the button that has the focus, and nothing else.
            if action.key == "Key-space" and event.widget.winfo_class() in _PRESSED_BY_SPACE:
                return None
            return "break" if self._do(action) else None

        return pressed


def _bind_tip(widget: tk.Misc, text: str, show: Callable[[str], None]) -> None:
    widget.bind("<Enter>", lambda event: show(text))
    widget.bind("<Leave>", lambda event: show(""))


def _refill(menu: tk.Menu, fill: Callable[[tk.Menu], None]) -> Callable[[], None]:
    def refill() -> None:
        menu.delete(0, "end")
        fill(menu)

    return refill
