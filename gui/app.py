"""The window: makes everything and connects it; what happens is in commands, tools, panels and views."""

from __future__ import annotations

import contextlib
import time
import tkinter as tk
import traceback
from pathlib import Path
from tkinter import ttk
from types import TracebackType
from typing import get_args

from gui.actions import Action, Actions
from gui.commands.arrange import ArrangeCommands
from gui.commands.edit import EditCommands
from gui.commands.export import ExportCommands
from gui.commands.file import FileCommands
from gui.commands.help import HelpCommands
from gui.commands.seams import SeamCommands
from gui.commands.sensors import SensorCommands
from gui.commands.view import ViewCommands
from gui.desk import Desk
from gui.dialogs.colours import colour_dialogs
from gui.dialogs.dialogs import Dialogs
from gui.drop import accept_files
from gui.ending import heeding_signals
from gui.jobs.background import Background
from gui.jobs.runner import Runner
from gui.jobs.sweep import Sweep
from gui.jobs.worker import Step, sentence_of
from gui.live.tab import LiveTab
from gui.panels.field import focused, select_all_by_key
from gui.panels.forms import Forms
from gui.panels.new_sensor import NewSensorPanel
from gui.panels.pieces import PiecesPanel
from gui.panels.problems import ProblemsPanel
from gui.panels.properties import PropertiesPanel
from gui.panels.sensors import SensorsPanel
from gui.panels.statusbar import StatusBar
from gui.scale import fitting, px
from gui.state.autosave import Autosave, left_over
from gui.state.derived import Derived
from gui.state.describe import describe
from gui.state.outdated import Outdated
from gui.state.problem import Problem
from gui.state.profiles import ProfileShelf
from gui.state.session import Session, Topic
from gui.state.store import Remembered, on_screen, recall, state_folder
from gui.theme import THEMES, apply
from gui.toolpath.choice import ArcsChoice
from gui.toolpath.tab import ToolPathTab
from gui.tools.measure import Measure
from gui.tools.toolbox import Toolbox
from gui.view2d.view import View2D
from gui.view3d.view import View3D
from skinfab.errors import InputError

#: The size a window begins with, px at 96 dots an inch: with its menu bar (30 px) and the frame of a window manager it fits the smallest
#: screen it is made for, 1280 x 800; a larger one begins with the status bar below the screen.
FIRST_SIZE = (1276, 734)
LEAST_SIZE = (960, 600)

#: What buttons and menus may depend on.
TOPICS: tuple[Topic, ...] = tuple(topic for topic in get_args(Topic) if topic != "hover")

#: How often complaints of the autosave thread are looked for, ms.
_WATCH_MS = 1000

#: Width of the panel at the side, px at 96 dots an inch.
_SIDE = 320


class App:
    """The placement window.

    Parameters
    ----------
    root : Tk
    path : Path, optional
        A mesh or a skin to open at once.
    dialogs : Dialogs, optional
        Who answers questions; a person by default.
    """

    def __init__(self, root: tk.Tk, path: Path | None = None, *, dialogs: Dialogs | None = None) -> None:
        self.root = root
        self.sweep = Sweep(root)
        root.title("skinfab")
        root.minsize(*fitting(root, LEAST_SIZE))
        state = state_folder()
        remembered = recall(state)
        root.geometry(
            on_screen(remembered.geometry, root.winfo_screenwidth(), root.winfo_screenheight())
            or "{}x{}".format(*fitting(root, FIRST_SIZE))
        )
        self.theme = THEMES[remembered.theme]
        apply(root, self.theme)
        colour_dialogs(root, self.theme)
        self.background = Background(root)
        self.session, self.derived, self.shelf = Session(), Derived(self.background), ProfileShelf()
        Outdated(self.session)
        self.autosave = Autosave(state / "autosave", failed=self._autosave_failed)
        self.runner = Runner(root, changed=self._progress, log=self._log)
        self.desk = Desk(
            root=root,
            session=self.session,
            derived=self.derived,
            shelf=self.shelf,
            runner=self.runner,
            dialogs=dialogs or Dialogs(root),
            say=lambda text: self.status.say(text),
            state=state,
        )
        self._log_file = state / "gui.log"
        self._closed = False
        self._refresh: str | None = None
        self._behind: str | None = None
        #: Ended because the system wanted it.
        self.interrupted = False
        self._autosave_fault = ""
        self._watch = root.after(_WATCH_MS, self._watch_autosave)
        root.report_callback_exception = self._fault
        self._build(remembered)
        root.protocol("WM_DELETE_WINDOW", self.close)
        accept_files(root, self.files.open_path)
        self.actions.refresh()
        self._first = root.after(50, self._begin, path)

    def close(self) -> None:
        """Ask about an export that goes on and about unsaved work, and end."""
        if not self._closed and self.exports.may_leave() and self.files.may_leave():
            self._end(keep_copy=False)

    def abandon(self) -> None:
        """End without a question, as one who is told to by the system must; unsaved work is offered at the next start."""
        if not self._closed:
            self._end(keep_copy=True)

    def _end(self, *, keep_copy: bool) -> None:
        self._closed = True
        for timer in (self._watch, self._first, self._refresh, self._behind):
            if timer:
                self.root.after_cancel(timer)
        self._refresh = self._behind = "none from now on"
        geometry = self.root.geometry()
        self.root.withdraw()  # what is stopped may take a moment to clean up after itself
        self.live.close()
        self.runner.close()
        self.background.close()
        self.autosave.close(keep=keep_copy)
        self.sweep.close()
        self.files.keep(theme=self.theme.name, geometry=geometry)
        self.root.destroy()

    def use_theme(self, name: str) -> None:
        """Light or dark."""
        self.theme = THEMES[name]
        apply(self.root, self.theme)
        colour_dialogs(self.root, self.theme)
        for part in (self.view3d, self.view2d, self.problems, self.new_sensor, self.toolpath, self.live):
            part.restyle(self.theme)
        self.actions.refresh()
        self.files.keep(theme=name)

    # How it is put together

    def _build(self, remembered: Remembered) -> None:
        root, session = self.root, self.session
        self.status = StatusBar(root, session, cancel=self._cancel, describe=lambda: describe(session, self.derived))
        self.status.pack(side="bottom", fill="x")
        self.seams = SeamCommands(self.desk)
        body = ttk.Panedwindow(root, orient="vertical", name="body")
        middle = ttk.Panedwindow(body, orient="horizontal", name="middle")
        self.view3d = View3D(middle, session, self.derived, self.theme, name="view3d")
        self.tabs = ttk.Notebook(middle, name="tabs")
        self.view2d = View2D(self.tabs, session, self.derived, self.theme, name="view2d")
        self.tabs.add(self.view2d, text="Flat skin")
        self.arcs = ArcsChoice()
        self.toolpath = ToolPathTab(
            self.tabs, session, self.theme, self.shelf, self.background, arcs=self.arcs, export=lambda: self.actions.do("export_gcode")
        )
        self.tabs.add(self.toolpath, text="Tool path")
        self.live = self._live_tab()
        self.tabs.add(self.live, text="Live")
        self.side = self._side_panel(middle)
        middle.add(self.view3d, weight=5)
        middle.add(self.tabs, weight=6)
        middle.add(self.side, weight=0)
        self.problems = ProblemsPanel(body, session, self.theme)
        body.add(middle, weight=1)
        body.add(self.problems, weight=0)
        self._connect(remembered)
        self.actions.tool_bar(root, self.status.tip).pack(side="top", fill="x", before=self.status)
        submenus = {
            "File/open/Open recent": self.files.fill_recent,
            "Seams/auto_cut/Cut into": self.seams.fill_aims,
            "Seams/flatten/Flatten by": self.seams.fill_methods,
        }
        root.configure(menu=self.actions.menu_bar(submenus))
        apply(root, self.theme)  # menus too
        body.pack(side="top", fill="both", expand=True)

    def _live_tab(self) -> LiveTab:
        return LiveTab(
            self.tabs,
            self.session,
            self.derived,
            self.theme,
            view3d=self.view3d,
            view2d=self.view2d,
            ask_open=lambda title, kinds: self.desk.dialogs.open_file(title, kinds),
            ask_save=lambda title, suffix, name: self.desk.dialogs.save_path(title, suffix, name),
            log=self._log,
        )

    def _side_panel(self, master: tk.Misc) -> ttk.Frame:
        session, complain = self.session, self.status.tip
        side = ttk.Frame(master, name="side", width=px(self.root, _SIDE))
        side.pack_propagate(False)
        PiecesPanel(side, session, self.derived).pack(fill="x")
        forms = Forms(side, session)
        properties = PropertiesPanel(
            forms, session, self.derived, self.shelf, self.background, complain=complain, make_thick=self.seams.make_thick
        )
        self.new_sensor = NewSensorPanel(forms, session, self.shelf, self.theme, complain=complain, place=lambda: session.take_up("add"))
        forms.add(properties, text="Properties")
        forms.add(self.new_sensor, text="New sensor")
        forms.pack(side="bottom", fill="x")
        SensorsPanel(side, session, self.shelf).pack(fill="both", expand=True)  # last of all: where room is scarce, the list is scrolled
        # What is taken in hand or selected is what one wants to see.
        session.listen("tool", lambda: forms.select(self.new_sensor if session.tool == "add" else properties))
        session.listen("selection", lambda: forms.select(properties) if session.tool != "add" else None)
        return side

    def _connect(self, remembered: Remembered) -> None:
        desk = self.desk
        self.files = FileCommands(desk, self.autosave, remembered, opened=self._opened)
        measure = Measure(desk, self.view3d, self.view2d, self.background, theme=lambda: self.theme)
        self.toolbox = Toolbox(desk, self.view3d, self.view2d, theme=lambda: self.theme, pattern=self.new_sensor.pattern, more=[measure])
        views = ViewCommands(desk, self.view3d, self.view2d, theme=lambda: self.theme.name, use_theme=self.use_theme)
        self.exports = ExportCommands(desk, self.arcs)
        actions = [
            *self.files.actions(),
            Action("quit", "Close", "File", self.close, "Control-q"),
            *EditCommands(desk).actions(),
            *ArrangeCommands(desk).actions(),
            *self.seams.actions(),
            *SensorCommands(desk).actions(),
            *self.toolbox.actions(),
            *self.exports.actions(),
            *views.actions(),
            *HelpCommands(desk, lambda: self.actions.keys()).actions(),
        ]
        self.actions = Actions(self.root, actions, settle=self._settle)
        select_all_by_key(self.root)
        for topic in TOPICS:
            self.session.listen(topic, self._changed)
        self.session.listen("file", self._name_window)

    # What happens

    def _settle(self, action: str) -> bool:
        """Before anything is done: a text that is being typed is taken, or, by undo, taken back."""
        field = focused(self.root)
        if action == "undo" and field is not None and field.pending:
            field.revert()
            return False
        return self.desk.settle()

    def _begin(self, path: Path | None) -> None:
        """Offer what a crash has left, then open what was asked for."""
        for left in left_over(self.desk.state / "autosave"):
            what = left.path.name if left.path is not None else f"the skin of {left.object or 'an object'}, which had no file yet"
            when = time.strftime("%H:%M on %d %B", time.localtime(left.when))
            text = f"skinfab ended without saving {what}. There is a copy of it as it was at {when}."
            answer = self.desk.dialogs.ask("Unsaved work was kept", text, ("Open the copy", "Later", "Throw it away"), cancel="Later")
            if answer == "Open the copy":
                self.files.recover(left)
                return
            if answer == "Throw it away":
                left.discard()
        if path is not None:
            self.files.open_path(path)

    def _opened(self) -> None:
        self.view3d.fit()
        self.view2d.fit()

    def _changed(self) -> None:
        # Many changes in a row are one to buttons and menus.
        if self._refresh is None:
            self._refresh = self.root.after_idle(self._refresh_now)

    def _refresh_now(self) -> None:
        self._refresh = None
        self.actions.refresh()
        self._name_window()

    def _name_window(self) -> None:
        skin, path = self.session.skin, self.session.path
        if skin is None:
            self.root.title("skinfab")
            return
        name = path.name if path is not None else f"{skin.source.file} (not saved as a skin yet)"
        self.root.title(f"{'*' if self.session.dirty else ''}{name} - skinfab")

    def _autosave_failed(self, sentence: str) -> None:
        """From the thread that writes copies: said once the window's own loop comes to it."""
        self._autosave_fault = sentence

    def _watch_autosave(self) -> None:
        """A thread must not touch the window: what it has to say is fetched here."""
        self._watch = self.root.after(_WATCH_MS, self._watch_autosave)
        sentence, self._autosave_fault = self._autosave_fault, ""
        if sentence:
            self.session.report("autosave", [Problem(sentence, "autosave", kind="warning")])

    def _progress(self, step: Step | None) -> None:
        job = self.runner.job
        self.status.progress(step, asked=job is not None and not job.own)
        if step is None and self._behind is None:
            self._behind = self.root.after_idle(self._catch_up)

    def _catch_up(self) -> None:
        self._behind = None
        if self.runner.job is None:
            self.seams.catch_up()

    def _cancel(self) -> None:
        self.seams.give_up()
        self.session.report("busy", [])
        if self.runner.cancel():
            self.status.say("Stopped." + (" F6 flattens the pieces." if self.seams.can_flatten() else ""))

    def _fault(self, kind: type[BaseException], fault: BaseException, trace: TracebackType | None) -> None:
        """What a callback raised: a sentence, never a traceback or a dead window."""
        if isinstance(fault, KeyboardInterrupt):
            self.interrupted = True
            self.abandon()
            return
        sentence, ours = sentence_of(fault)
        if ours:
            self._log("".join(traceback.format_exception(kind, fault, trace)))
            sentence += f"; details are in {self._log_file}"
        if self._closed:
            return
        try:
            self.session.report("window", [Problem(sentence, "window")])
        except Exception:  # one who listens to problems is what is broken: the loop must go on
            self._log(traceback.format_exc())
            self.status.say(sentence)

    def _log(self, trace: str) -> None:
        with contextlib.suppress(OSError), self._log_file.open("a", encoding="utf-8") as log:
            log.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')}\n{trace}\n")


def run(path: Path | None = None) -> None:
    """Open the window and stay until it is closed.

    Raises
    ------
    InputError
        There is no screen.
    KeyboardInterrupt
        Ctrl-C on the terminal, or the system wants the program to end.
    """
    try:
        root = tk.Tk(className="skinfab")
    except tk.TclError as fault:
        raise InputError(f"there is no screen to open a window on ({fault}); set DISPLAY, or use the commands without a window") from fault
    app = App(root, path)
    try:
        with heeding_signals(root, app.abandon):
            root.mainloop()
    except KeyboardInterrupt:
        app.interrupted = True
        app.abandon()
    if app.interrupted:
        raise KeyboardInterrupt
