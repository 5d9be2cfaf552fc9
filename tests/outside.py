"""The window as its user has it: a process of its own on a screen of its own, driven by mouse and keys, asked by Tk's own ``send``.

``send`` is part of every Tk program on X11, so that nothing has to be built into the window for its tests: it says where a widget is
and what it shows. All that is *done* to the window is done by xdotool, through the X server and the window manager.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from screen import PATIENCE, Screen, until

from gui.state.derived import Derived
from gui.view2d.background import RULER_PX
from gui.view2d.lines import Lines
from gui.view2d.marking import HANDLE_PX
from gui.view2d.plane import Plane
from gui.view2d.sheet import Sheet
from gui.view2d.view import _BORDER_PX
from gui.view3d.camera import Camera
from skinfab.document import load_skin
from skinfab.errors import SkinfabError
from skinfab.skin import Skin

FLAT = ".body.middle.tabs.view2d.!canvas"
OBJECT = ".body.middle.view3d.canvas"


class Window:
    """``skinfab gui WORDS``, and what can be done to it and seen of it.

    Parameters
    ----------
    screen : Screen
    state : Path
        Folder for what the window keeps: settings, copies of unsaved work.
    words : str or Path
        Arguments of the command.
    """

    def __init__(self, screen: Screen, state: Path, *words: object) -> None:
        self.screen, self.state = screen, state
        command = [sys.executable, "-m", "skinfab", "gui", *map(str, words)]
        self.process = subprocess.Popen(command, env=screen.env | {"SKINFAB_STATE": str(state)}, start_new_session=True)
        self.app = ""
        try:
            # By its process: one that was killed may still stand in the server's list under the same name.
            self.app = until(self._answers, "the window")
            until(lambda: self.tcl(f"winfo viewable {OBJECT}") == "1", "the window to be seen")
        except BaseException:
            self.kill()
            raise

    def _answers(self) -> str:
        assert self.process.poll() is None, f"the window ended with {self.process.poll()}"
        for name in self.screen.ask("eval", r"join [winfo interps] \n").split("\n"):
            if name.startswith("skinfab"):
                try:
                    if int(self.screen.ask("send", name, "pid")) == self.process.pid:
                        return name
                except RuntimeError:
                    continue  # one that is no more
        return ""

    # What it says

    def tcl(self, script: str) -> str:
        """What the window answers to a line of Tcl that asks something."""
        return self.screen.ask("send", self.app, script)

    def text(self, widget: str) -> str:
        """What a label says."""
        return self.tcl(f"set _v [{widget} cget -textvariable]; expr {{$_v eq {{}} ? [{widget} cget -text] : [set ::$_v]}}")

    def exists(self, widget: str) -> bool:
        """Whether there is such a widget, and it is seen."""
        return self.tcl(f"expr {{[winfo exists {widget}] && [winfo viewable {widget}]}}") == "1"

    @property
    def title(self) -> str:
        return self.tcl("wm title .")

    @property
    def status(self) -> str:
        return self.text(".statusbar.text")

    @property
    def busy(self) -> bool:
        """Whether long work goes on."""
        return self.exists(".statusbar.work")

    @property
    def problems(self) -> list[str]:
        """Sentences of the list of problems, each with its mark."""
        table = ".body.problems.!frame.list"
        return [self.tcl(f"join [{table} item {row} -values]") for row in self.tcl(f"{table} children {{}}").split()]

    def rows(self, table: str) -> list[str]:
        """The rows of a list, as text."""
        return [self.tcl(f"join [{table} item {row} -values]") for row in self.tcl(f"{table} children {{}}").split()]

    def settled(self) -> None:
        """Wait until nothing is being worked on and all is drawn."""
        calm = 0
        end = time.monotonic() + PATIENCE
        while calm < 3:
            self.tcl("update idletasks")
            calm = 0 if self.busy else calm + 1
            assert time.monotonic() < end, f"waited {PATIENCE} s in vain for the work to end: {self.text('.statusbar.work.label')}"
            time.sleep(0.02)

    def kept(self) -> Skin | None:
        """The copy of the unsaved document."""
        for file in (self.state / "autosave").glob(f"{self.process.pid}-*.skin"):
            try:
                return load_skin(file)
            except (SkinfabError, OSError):  # just being replaced
                return None
        return None

    def wait_kept(self, condition: Callable[[Skin], Any], what: str) -> Skin:
        """The copy of the unsaved document, once something is true of it."""
        found: list[Skin] = []

        def so() -> bool:
            skin = self.kept()
            found[:] = [skin] if skin is not None else []
            return skin is not None and bool(condition(skin))

        until(so, f"a document in which {what}; the window says {self.status!r}, {self.problems}")
        return found[0]

    # What is done to it

    def place(self, widget: str, at: Sequence[float] | None = None) -> tuple[int, int]:
        """Where a point of a widget (its middle) is on the screen, pixels."""
        x, y, width, height = map(
            int, self.tcl(f"join [list {' '.join(f'[winfo {w} {widget}]' for w in ('rootx', 'rooty', 'width', 'height'))}]").split()
        )
        dx, dy = (width / 2, height / 2) if at is None else at
        return round(x + dx), round(y + dy)

    def click(self, widget: str, at: Sequence[float] | None = None, *, button: int = 1, hold: str = "") -> None:
        """Move there and click; with a key held."""
        x, y = self.place(widget, at)
        held, free = (("keydown", hold), ("keyup", hold)) if hold else ((), ())
        self.screen.xdo("mousemove", x, y, *held, "click", button, *free)
        self.tcl("update idletasks")

    def point(self, widget: str, at: Sequence[float] | None = None) -> None:
        """Move the pointer there."""
        self.screen.xdo("mousemove", *self.place(widget, at))
        self.tcl("update idletasks")

    def drag(self, widget: str, start: Sequence[float], *to: Sequence[float], drop: bool = True, steps: int = 6) -> None:
        """Press, move over places as a hand does, let go."""
        here = np.array(self.place(widget, start), dtype=float)
        self.screen.xdo("mousemove", *here.astype(int), "mousedown", 1)
        for place in to:
            there = np.array(self.place(widget, place), dtype=float)
            for k in range(1, steps + 1):
                self.screen.xdo("mousemove", *np.rint(here + (there - here) * k / steps).astype(int))
                self.tcl("update idletasks")
            here = there
        if drop:
            self.drop()

    def drop(self) -> None:
        """Let go of the button."""
        self.screen.xdo("mouseup", 1)
        self.tcl("update idletasks")

    def key(self, *keys: str) -> None:
        """Press keys, as xdotool writes them: "ctrl+s"."""
        self.screen.xdo("key", *keys)
        self.tcl("update idletasks")

    def steer(self, widget: str, to: Sequence[float]) -> None:
        """Bring the cursor that keys move, which is shown, to a place of a view by arrows alone."""
        box = list(map(int, self.tcl(f"{widget} bbox keycursor").split()))
        keys = []
        for axis, (less, more) in enumerate((("Left", "Right"), ("Up", "Down"))):
            way = round(to[axis] - (box[axis] + box[axis + 2]) / 2)
            steps, pixels = divmod(abs(way), 10)
            key = more if way > 0 else less
            keys += [key] * steps + [f"shift+{key}"] * pixels
        self.key("--delay", "2", *keys)
        box = list(map(int, self.tcl(f"{widget} bbox keycursor").split()))
        assert np.hypot((box[0] + box[2]) / 2 - to[0], (box[1] + box[3]) / 2 - to[1]) < 3

    def type(self, text: str) -> None:
        """Write."""
        self.screen.xdo("type", "--delay", 1, text)

    def press(self, button: str) -> None:
        """Click a button once it can be pressed."""
        until(lambda: self.exists(button) and self.tcl(f"{button} instate disabled") == "0", f"the button {button}")
        # The window manager still moves a dialog that has just come.
        places: list[object] = []
        until(lambda: places.append(self.place(button)) or places[-5:] == places[-1:] * 5, "the button to stay where it is")
        self.click(button)

    def open_mesh(self, text: str = "") -> None:
        """Take what the dialog about a mesh suggests; `text` must stand in it."""
        until(lambda: self.exists(".open_mesh.body.buttons.open"), "the question how to open the mesh")
        said = " ".join(
            self.text(f".open_mesh.body.{child.rsplit('.', 1)[1]}")
            for child in self.tcl("winfo children .open_mesh.body").split()
            if self.tcl(f"winfo class {child}") == "TLabel"
        )
        assert text in said, said
        self.press(".open_mesh.body.buttons.open")
        until(lambda: not self.exists(".open_mesh"), "the dialog to go")

    def answer(self, words: str) -> None:
        """Press the button of that name in a question."""
        row = ".question.body.buttons"
        until(lambda: self.exists(f"{row}.answer0"), f"a question to answer with {words}")
        (button,) = [b for b in self.tcl(f"winfo children {row}").split() if self.text(b) == words]
        self.press(button)
        until(lambda: self.gone(button), "the question to go")

    def file_named(self, path: Path) -> None:
        """Write a path into the file dialog that is open, and take it."""
        dialog = until(
            lambda: next((w for w in self.tcl("winfo children .").split() if "__tk_" in w and self.exists(w)), ""), "a file dialog"
        )
        until(lambda: self.tcl("focus").startswith(dialog), "the keys to go to the file dialog")
        self.key("Home", "shift+End")
        self.type(str(path))
        self.screen.xdo("key", "Return")
        if path.is_dir():
            # Tk's dialog for folders first goes there; the next Return takes it.
            until(lambda: self.gone(dialog) or self.tcl(f"set ::tk::dialog::file::{dialog[1:]}(selectPath)") == str(path), "the folder")
            self.screen.xdo("key", "Return")
        until(lambda: self.gone(dialog), "the file dialog to go")

    def gone(self, widget: str) -> bool:
        """Whether there is no such widget, or no window any more."""
        try:
            return not self.exists(widget)
        except RuntimeError:
            return True

    def close(self) -> None:
        """As the button in its frame does."""
        self.screen.xdo("key", "alt+F4")

    def kill(self) -> None:
        """End it whatever it does."""
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait(timeout=10)

    def workers(self) -> list[int]:
        """Processes that it has started, in their turn or now."""
        mine = []
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                stat = (folder / "stat").read_text().rsplit(")", 1)[1].split()
            except OSError:
                continue
            if int(stat[3]) == self.process.pid and int(folder.name) != self.process.pid and stat[0] != "Z":  # its session
                mine.append(int(folder.name))
        return mine

    def stop_work(self) -> None:
        """Kill the processes that do its work, as a system without memory does."""
        for pid in self.workers():
            if b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes():
                os.kill(pid, signal.SIGKILL)

    # Where things are in its views

    def size(self, widget: str) -> tuple[int, int]:
        width, height = self.tcl(f"list [winfo width {widget}] [winfo height {widget}]").split()
        return int(width), int(height)

    def look(self, skin: Skin, side: str) -> Camera:
        """Turn the object to a side by its key; how it is seen then."""
        names = ("front", "back", "left", "right", "top", "bottom")
        self.screen.xdo("mousemove", *self.place(OBJECT, (12, 12)))
        self.tcl("update idletasks")
        if self.tcl("focus") != OBJECT:
            self.click(OBJECT, (12, 12))
        self.key(str(names.index(side) + 1))
        used = skin.object.V[skin.object.topology.used_vertices]
        return Camera.fitted(used, *self.size(OBJECT)).seen_from(side).whole()

    def plane(self, skin: Skin) -> tuple[Sheet, Plane]:
        """The sheet of pieces and how it is shown when all of it is."""
        sheet = Sheet(skin, Derived())
        width, height = self.size(FLAT)
        plane = Plane.fitted(*sheet.box, width - RULER_PX, height - RULER_PX, border=_BORDER_PX)
        return sheet, plane.moved(RULER_PX, RULER_PX)

    def flat(self, skin: Skin, piece: str, uv: Sequence[float]) -> tuple[float, float]:
        """Where a point of a piece, mm, is in the flat view."""
        sheet, plane = self.plane(skin)
        x, y = plane.to_px(np.asarray(uv, dtype=float) + sheet.offset_of(piece))
        return x, self.size(FLAT)[1] - y

    def sensor(self, skin: Skin, id: str, *, handle: bool = False) -> tuple[float, float]:
        """Where a sensor's middle, or its handle, is in the flat view."""
        sheet, plane = self.plane(skin)
        (sensor,) = (s for s in skin.sensors if s.id == id)
        lines = Lines()
        at = lines.handle(sensor, sheet, beyond=HANDLE_PX / plane.scale) if handle else lines.middle(sensor, sheet)
        x, y = plane.to_px(at)
        return x, self.size(FLAT)[1] - y
