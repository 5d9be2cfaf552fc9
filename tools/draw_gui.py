"""Draw docs/pictures/gui_*.png: the window in each of its states, light and dark, as it is on a screen of 1280 x 800.

``python tools/draw_gui.py [-o FOLDER] [--theme light|dark]`` drives ``skinfab gui`` by mouse and keys on a virtual screen; it needs Xvfb,
openbox and xdotool (tests/setup_gui.sh).
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]  # in this order: tests/gui is not gui

from outside import FLAT, OBJECT, Window  # noqa: E402
from screen import Screen, missing, until  # noqa: E402

from gui.view3d.camera import Camera  # noqa: E402
from skinfab.mesh.door import load_usable  # noqa: E402
from skinfab.skin import Skin, Source  # noqa: E402

MESH = ROOT / "meshes/robot_finger.obj"
#: A picture is taken once the screen has stayed the same for so long, s; so many times it is looked whether it has.
_CALM_S, _TRIES = 1.0, 8
#: What lasts a second only is tried for so many times.
_CATCHES = 40

FORM = ".body.middle.side.forms"
TABS = ".body.middle.tabs"


class Album:
    """Takes the pictures of one theme."""

    def __init__(self, screen: Screen, folder: Path, theme: str, scratch: Path) -> None:
        self.screen, self.folder, self.theme, self.scratch = screen, folder, theme, scratch
        self.state = scratch / theme
        self.state.mkdir()
        (self.state / "gui.json").write_text(json.dumps({"theme": theme}), encoding="utf-8")

    def window(self, *words: object) -> Window:
        """Open the window."""
        return Window(self.screen, self.state, *words)

    def take(self, window: Window, name: str) -> None:
        """The screen once all is drawn, in 256 colours: a third of the bytes, and nothing to be seen of it."""
        window.settled()
        path = self.folder / f"gui_{name}_{self.theme}.png"
        # What a document is shown by is made beside the window's loop: until nothing changes any more, or always does, as live plots.
        before = b""
        for _ in range(_TRIES):
            self.screen.picture(path)
            with Image.open(path) as shown:
                now = shown.tobytes()
            if now == before:
                break
            before = now
            time.sleep(_CALM_S)
        self._keep(path)

    def catch(self, window: Window, name: str, seen: Callable[[], str]) -> None:
        """The screen while something is seen in the window, for some time before and still after."""
        path = self.folder / f"gui_{name}_{self.theme}.png"
        for _ in range(_CATCHES):
            before = until(seen, f"what {name} is to show")
            rest(window, 3)  # all parts of the window have followed by then
            self.screen.picture(path)
            if seen() == before:
                break
        else:
            raise AssertionError(f"{name}: never seen long enough in {_CATCHES} times")
        self._keep(path)

    def _keep(self, path: Path) -> None:
        with Image.open(path) as full:
            full.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(path, optimize=True)


def scanned(path: Path) -> Path:
    """The finger as a scanner might give it: in cm, with holes and a face twice."""
    lines = MESH.read_text(encoding="utf-8").splitlines()
    points = [line.split() for line in lines if line.startswith("v ")]
    faces = [line for line in lines if line.startswith("f ")]
    small = [f"v {float(x) / 10:.9g} {float(y) / 10:.9g} {float(z) / 10:.9g}" for _, x, y, z in points]
    path.write_text("\n".join([*small, *faces[:4000], *faces[4002:7000], *faces[7001:], faces[0]]) + "\n", encoding="utf-8")
    return path


def opening(album: Album) -> None:
    """What is asked before a mesh is taken."""
    window = album.window(scanned(album.scratch / f"finger_scan_{album.theme}.obj"))
    until(lambda: window.exists(".open_mesh.body.buttons.open"), "the question")
    album.take(window, "open")
    window.kill()


def seams(album: Album, window: Window, skin: Skin) -> None:
    """Paint, a line that is being cut, an automatic cut, and what it did to lengths."""
    camera = window.look(skin, "front")
    low, high = at_ends(skin, camera)
    window.key("v")
    window.drag(OBJECT, low + (0.5 * (high - low)), low + 0.8 * (high - low))
    window.key("a")
    window.drag(OBJECT, low + np.array([12.0, -60.0]), low + np.array([14.0, -170.0]))
    window.wait_kept(lambda s: s.marks is not None, "there is paint")
    album.take(window, "preferences")
    window.key("ctrl+1", "c")
    window.click(OBJECT, low)
    window.point(OBJECT, low + 0.75 * (high - low))
    album.take(window, "cut")
    window.key("Escape", "space", "f")
    window.key("F5")
    window.settled()
    window.wait_kept(lambda s: len(s.seams), "there are seams")
    window.point(".statusbar")
    album.take(window, "pieces")
    window.key("ctrl+2")
    album.take(window, "distortion")
    window.key("ctrl+3")
    album.take(window, "checker")
    window.key("ctrl+1")


def at_ends(skin: Skin, camera: Camera) -> np.ndarray:
    """Where the object begins, at the bottom, and ends, at the top, pixels; a little inside."""
    at = camera.to_screen(skin.object.V)
    return np.array([[at[:, 0].mean(), at[:, 1].max() - 4], [at[:, 0].mean(), at[:, 1].min() + 4]])


def sensors(album: Album, window: Window) -> None:
    """Automatic ones, the form of a new one, one that does not fit while it is dragged, and one that does."""
    window.key("F7")
    window.settled()
    placed = window.wait_kept(lambda s: len(s.sensors) > 2, "there are sensors")
    window.key("s")
    until(lambda: window.exists(f"{FORM}.new_sensor"), "the form")
    album.take(window, "placing")
    window.key("space")
    home = np.array(window.sensor(placed, "C1"))
    window.click(FLAT, home)
    album.take(window, "properties")
    window.drag(FLAT, home, home + np.array([-30.0, 45.0]), drop=False)
    until(lambda: any("C1" in line for line in window.problems), "words about it")
    rest(window, 5)  # the form and the list follow once the pointer rests
    album.take(window, "invalid")
    window.drop()
    window.key("ctrl+z", "Escape")


def tabs(album: Album, window: Window) -> None:
    """Tool path, files, live readings."""
    menu(window, "Export")
    album.take(window, "export")
    window.key("Escape", "Escape")
    choose_tab(window, "Tool path")
    window.settled()
    album.take(window, "toolpath")
    choose_tab(window, "Live")
    button = f"{TABS}.live.connect.button"
    window.press(button)
    until(lambda: window.text(button) == "Disconnect", "the simulator")
    rest(window, 60)  # some seconds of readings
    album.catch(window, "live", lambda: touched(window))
    window.press(button)
    choose_tab(window, "Flat skin")


def touched(window: Window) -> str:
    """The strips that say that a sensor is touched, such as C1 (S2); not those of channels that are no sensor's, which light nothing."""
    canvas = f"{TABS}.live.plots.canvas"
    texts = window.tcl(
        f'join [lmap i [{canvas} find all] {{expr {{[{canvas} type $i] eq "text" ? '
        f'"[lindex [{canvas} coords $i] 1] [{canvas} itemcget $i -text]" : "0 -"}}}}] |'
    )
    placed = [text.split(" ", 1) for text in texts.split("|")]
    rows = {float(y) for y, text in placed if text.startswith("touched")}
    return "|".join(text for y, text in placed if float(y) in rows and text.endswith(")"))


def rest(window: Window, tenths: int) -> None:
    """Do nothing for so many tenths of a second of the window's own time."""
    for _ in range(tenths):
        window.tcl("after 100 {set ::later 1}; vwait ::later")


def menu(window: Window, name: str) -> None:
    """Open a menu."""
    last = int(window.tcl(".#menu index end"))
    (index,) = [k for k in range(last + 1) if window.tcl(f".#menu entrycget {k} -label") == name]
    window.click(".#menu", (int(window.tcl(f".#menu xposition {index}")) + 12, 14))


def choose_tab(window: Window, name: str) -> None:
    """Show a tab by a click on it."""
    (index,) = [k for k in range(int(window.tcl(f"{TABS} index end"))) if window.tcl(f"{TABS} tab {k} -text") == name]
    x = next(x for x in range(5, 500, 5) if window.tcl(f"{TABS} index @{x},12") == str(index))
    window.click(TABS, (x + 8, 12))
    until(lambda: window.tcl(f"{TABS} index current") == str(index), f"the tab {name}")


def help_and_crash(album: Album, window: Window) -> None:
    """A line by keys alone, the list of keys; and what is asked after the window was killed."""
    window.key("F4", "F3", "c", "shift+Right", *["Down"] * 6, "Return", *["Up"] * 4, *["Right"] * 2)
    album.take(window, "cursor")
    window.key("Escape", "Escape", "Escape")
    window.key("F1")
    until(lambda: window.exists(".question.body.buttons.answer0"), "the keys")
    album.take(window, "keys")
    window.answer("Close")
    window.key("F7")
    window.settled()
    window.wait_kept(lambda s: len(s.sensors) > 2, "there is a copy")
    window.kill()
    again = album.window()
    until(lambda: again.exists(".question.body.buttons.answer0"), "the question about the copy")
    album.take(again, "recovery")
    again.kill()


def draw(screen: Screen, folder: Path, theme: str, scratch: Path) -> None:
    """All pictures of one theme."""
    album = Album(screen, folder, theme, scratch)
    opening(album)
    mesh = load_usable(MESH, units="mm", mend=False).mesh
    skin = Skin(mesh, Source(MESH.name, "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), ())
    window = album.window(MESH)
    try:
        window.open_mesh()
        window.settled()
        seams(album, window, skin)
        sensors(album, window)
        tabs(album, window)
        help_and_crash(album, window)
    finally:
        window.kill()


def main() -> int:
    """Draw them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "docs/pictures", help="folder for the pictures")
    parser.add_argument("--theme", choices=("light", "dark"), action="append", help="only this one")
    args = parser.parse_args()
    if gone := missing():
        parser.exit(1, f"draw_gui: {', '.join(gone)} not installed; tests/setup_gui.sh installs them as root\n")
    args.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        screen = Screen(Path(scratch))
        try:
            for theme in args.theme or ("light", "dark"):
                draw(screen, args.output, theme, Path(scratch))
        finally:
            screen.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
