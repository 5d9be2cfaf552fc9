"""From a mesh to G-code as a person goes, with the mouse and the keys; what the window leaves is what the command line leaves."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from outside import FLAT, OBJECT, Window
from PIL import Image
from screen import Screen, until

from gui.theme import LIGHT
from skinfab.document import load_skin
from skinfab.skin import Skin

MESHES = Path(__file__).parents[3] / "meshes"


def in_front(skin: Skin, camera, x: float, y: float, *, inwards: float = 0.0, reach: float = 8.0) -> tuple[int, np.ndarray]:
    """The vertex nearest to the viewer about a pixel, and where a click means it: at the object's rim a little inwards."""
    at = camera.to_screen(skin.object.V)
    near = np.flatnonzero(np.hypot(*(at[:, :2] - (x, y)).T) < reach)
    vertex = int(near[at[near, 2].argmin()])
    middle = np.array([camera.width, camera.height]) / 2
    return vertex, at[vertex, :2] + inwards * (middle - at[vertex, :2]) / np.linalg.norm(middle - at[vertex, :2])


def cut_by_clicks(window: Window, skin: Skin) -> Skin:
    """A seam from the finger's base to near its tip, on the side that is seen from the front."""
    camera = window.look(skin, "front")
    at = camera.to_screen(skin.object.V)
    x, top, bottom = at[:, 0].mean(), at[:, 1].min(), at[:, 1].max()
    (base, click_base), (tip, click_tip) = in_front(skin, camera, x, bottom, inwards=2.5), in_front(skin, camera, x, top + 30)
    window.key("c")
    window.click(OBJECT, click_base)
    assert window.status == "Now the next point; Esc ends the line."
    window.click(OBJECT, click_tip)
    cut = window.wait_kept(lambda s: len(s.seams), "there is a seam")
    ends, counts = np.unique(cut.seams, return_counts=True)
    assert set(ends[counts == 1].tolist()) == {base, tip}, "the seam runs from the one click to the other"
    assert np.median(cut.object.V[ends, 1]) < 0, "on the near side"
    window.key("Escape")
    return cut


def reddish(picture: Path, window: Window, at: tuple[float, float]) -> int:
    """Pixels in the colour of what does not fit, within 60 px of a place of the flat view."""
    x, y = window.place(FLAT, at)
    near = np.asarray(Image.open(picture).convert("RGB"), dtype=int)[max(y - 60, 0) : y + 60, max(x - 60, 0) : x + 60]
    wrong = np.array([int(LIGHT.error[k : k + 2], 16) for k in (1, 3, 5)])
    return int((np.abs(near - wrong).max(axis=-1) <= 12).sum())


def angle_of(skin: Skin, id: str) -> float:
    return next(s.angle for s in skin.sensors if s.id == id)


def test_from_a_mesh_to_gcode(start: Callable[..., Window], screen: Screen, tmp_path: Path) -> None:
    document, folder, picture = tmp_path / "finger.skin", tmp_path / "by hand", tmp_path / "screen.png"
    window = start()
    window.key("ctrl+o")
    window.file_named(MESHES / "robot_finger.obj")
    window.open_mesh("11070 triangles")
    window.settled()
    assert window.title == "robot_finger.obj (not saved as a skin yet) - skinfab"

    # Seams: by clicks, kept by a lock, the rest by itself; it lies flat each time without being told to.
    from skinfab.mesh.door import load_usable  # the object as it was opened: before any change there is no copy to look at
    from skinfab.skin import Source

    mesh = load_usable(MESHES / "robot_finger.obj", units="mm", mend=False).mesh
    opened = Skin(mesh, Source("robot_finger.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), ())
    cut = cut_by_clicks(window, opened)
    window.settled()
    flat = window.wait_kept(lambda s: len(s.pieces) == 1 and len(s.pieces[0].UV) > len(opened.object.V), "the seam is open")
    assert window.title.startswith("*")
    on_seam = window.look(opened, "front").to_screen(cut.object.V[cut.seams[len(cut.seams) // 2]].mean(axis=0))[0, :2]
    window.key("l", "F3")  # by keys alone
    window.steer(OBJECT, on_seam)
    window.key("Return", "Escape")
    window.wait_kept(lambda s: s.marks is not None and len(s.marks.locked) == len(cut.seams), "the seam is locked")
    window.key("F5")
    window.settled()
    flat = window.wait_kept(lambda s: len(s.seams) > len(cut.seams), "there are more seams")
    assert {tuple(e) for e in cut.seams.tolist()} <= {tuple(e) for e in flat.seams.tolist()}
    assert not window.problems, window.problems

    # Sensors: automatic, and one by a click.
    window.key("F7")
    window.settled()
    placed = window.wait_kept(lambda s: len(s.sensors) > 2, "there are sensors")
    assert all("no sensor" in line for line in window.problems), window.problems  # the tip's small piece has no room
    window.key("space")
    window.click(FLAT, window.sensor(placed, "C1"))
    window.key("Delete")
    without = window.wait_kept(lambda s: len(s.sensors) == len(placed.sensors) - 1, "one sensor is gone")
    window.key("s")
    size = ".body.middle.side.forms.new_sensor.fields.s.entry"
    until(lambda: window.exists(size), "the form of the new sensor")
    window.click(size)
    window.key("Home", "shift+End")
    window.type("16")  # smaller than the one that went, so that a pixel more or less is no matter
    window.key("Return", "F4")
    window.steer(FLAT, window.sensor(placed, "C1"))
    window.key("Return", "Escape")
    by_keys = window.wait_kept(lambda s: len(s.sensors) == len(placed.sensors), "one sensor is new, by keys alone")
    window.key("ctrl+z")
    window.wait_kept(lambda s: len(s.sensors) == len(without.sensors), "it is gone again")
    window.click(FLAT, window.sensor(placed, "C1"))
    added = window.wait_kept(lambda s: len(s.sensors) == len(placed.sensors), "one sensor is new")
    (new,) = {s.id for s in added.sensors} - {s.id for s in without.sensors}
    assert next(s.pattern.s for s in added.sensors if s.id == new) == 16
    places = [np.array([s.x, s.y]) for skin in (by_keys, added) for s in skin.sensors if s.id == new]
    assert np.hypot(*(places[1] - places[0])) < 1.0, "where the keys put it, the click did"
    window.key("space")

    # To where it does not fit, which words and colour say, and back.
    home = window.sensor(added, new)
    piece = next(s.piece for s in added.sensors if s.id == new)
    width = next(p.size[0] for p in added.pieces if p.id == piece)
    out = window.flat(added, piece, (width, 0.0))
    screen.picture(picture)
    fitting = reddish(picture, window, home)
    window.drag(FLAT, home, out, drop=False)
    until(lambda: any(new in line for line in window.problems), "words about the sensor while it is held")
    screen.picture(picture)
    assert reddish(picture, window, out) > fitting + 100
    window.drop()
    said = [line for line in window.problems if new in line]
    assert said and any(word in said[0] for word in ("outside", "too close", "beyond")), said
    wrong = window.wait_kept(lambda s: s.sensors != added.sensors, "the sensor has moved")
    window.drag(FLAT, window.sensor(wrong, new), home)
    until(lambda: not any(new in line for line in window.problems), "the words to go")

    # Turned by its handle; undone, and done again.
    back = window.wait_kept(lambda s: s.sensors != wrong.sensors, "the sensor is back")
    window.click(FLAT, window.sensor(back, new))
    handle, middle = np.array(window.sensor(back, new, handle=True)), np.array(window.sensor(back, new))
    arm = handle - middle
    window.drag(FLAT, handle, middle + np.array([arm[1], -arm[0]]))  # a quarter to the left as it is seen
    turned = window.wait_kept(lambda s: angle_of(s, new) != angle_of(back, new), "the sensor has turned")
    assert np.isclose((angle_of(turned, new) - angle_of(back, new)) % (2 * np.pi), np.pi / 2, atol=np.radians(6))
    window.key("ctrl+z")
    window.wait_kept(lambda s: angle_of(s, new) == angle_of(back, new), "the turn is undone")
    assert window.status == f"Undone: turn {new}."
    window.key("ctrl+y")
    last = window.wait_kept(lambda s: angle_of(s, new) == angle_of(turned, new), "the turn is done again")
    while any(new in line for line in window.problems):
        window.key("ctrl+z")
        # The copy is written by a thread of its own: it has to be that of this step before it is compared with what is saved.
        last = window.wait_kept(lambda s, before=last: s.sensors != before.sensors, "a step is undone")

    # Saved, closed, opened again by the name of its file.
    window.key("ctrl+s")
    window.file_named(document)
    until(lambda: window.title == "finger.skin - skinfab", "the saved document's name")
    window.close()
    assert window.process.wait(timeout=20) == 0
    saved = load_skin(document)
    assert saved.sensors == last.sensors and np.array_equal(saved.seams, last.seams)
    again = start(document)
    until(lambda: again.title == "finger.skin - skinfab", "the document to be open")
    again.settled()
    assert again.rows(".body.middle.side.sensors.!frame.list")[-1].startswith(saved.sensors[-1].id)

    # The files for the printer are those of the command line, byte for byte.
    folder.mkdir()
    again.key("ctrl+e")
    again.file_named(folder)
    until(lambda: any(folder.iterdir()), "G-code")
    again.settled()
    subprocess.run(
        [sys.executable, "-m", "skinfab", "gcode", document, "-o", tmp_path / "by command"], check=True, stdout=subprocess.DEVNULL
    )
    names = sorted(f.name for f in (tmp_path / "by command").iterdir())
    assert names == sorted(f.name for f in folder.iterdir()) and names
    for name in names:
        assert (folder / name).read_bytes() == (tmp_path / "by command" / name).read_bytes(), name
    again.close()
    assert again.process.wait(timeout=20) == 0
