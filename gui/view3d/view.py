"""The 3D view: turns, moves and enlarges the object, says what the pointer is on, and hands clicks to the tool."""

from __future__ import annotations

import threading
import time
import tkinter as tk
from collections.abc import Callable
from tkinter import ttk
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gui.cursor import KeyCursor
from gui.state.derived import Derived
from gui.state.selection import NOTHING, Target
from gui.state.session import Session
from gui.theme import Theme
from gui.view3d.camera import SIDES, Camera
from gui.view3d.detail import Detail
from gui.view3d.furniture import Furniture
from gui.view3d.gestures import Gestures
from gui.view3d.hit import Hit, hit
from gui.view3d.labels import piece_labels, seam_labels, sensor_label
from gui.view3d.painter import Painter, warm
from gui.view3d.plate import Plate
from gui.view3d.scene import Scene
from gui.view3d.solid import Solid
from skinfab.mesh.model import Mesh
from skinfab.skin import Skin

#: Milliseconds without a change after which the picture is drawn at its best.
_REST_MS = 140

#: A picture of a moving object that takes longer is drawn from the rough likeness, s: 30 pictures a second.
_SLOW = 0.030

#: Samples of the best picture at most: four a pixel up to 1600 x 1000, one where the screen is finer than the eye.
_SAMPLES = 6_400_000

#: Pixels from which a moving object is drawn at half the width and height: the way to the screen alone takes too long for more.
_COARSE = 1_600_000

#: How near the pointer must come to a line, pixels at 96 dots per inch.
_REACH = 5

_EMPTY, _SOON = "Open a mesh or a skin document", "Drawing it \N{HORIZONTAL ELLIPSIS}"


class View3D(ttk.Frame):
    """The object, with its seams and sensors.

    The left button turns the object, unless the tool takes the drag; the right one always turns it. The middle button, or the left with
    Ctrl, moves it, the wheel enlarges what is under the pointer. Arrow keys turn (with Shift they move), + and - enlarge, f shows
    all, 1 to 6 show the six sides. Enter begins a cursor that arrow keys move (`KeyCursor`).

    Parameters
    ----------
    master : tk.Misc
    session : Session
        Its document is shown; hovering is told to it.
    derived : Derived
    theme : Theme
    on_click : callable, optional
        Is called with a `Hit` (None beside the object) and whether Shift is down when the left button is let go where it was pressed.
    on_drag : callable, optional
        Is called with a `Hit` when a drag with the left button begins on the object, that of the place where it began; the tool takes
        the drag by returning True, and is then called with each further hit.
    on_release : callable, optional
        Is called with a `Hit` or None at the end of a drag that the tool took.
    options
        Of the frame, such as ``name="view3d"``.
    """

    def __init__(
        self,
        master: tk.Misc,
        session: Session,
        derived: Derived,
        theme: Theme,
        *,
        on_click: Callable[[Hit | None, bool], object] | None = None,
        on_drag: Callable[[Hit], object] | None = None,
        on_release: Callable[[Hit | None], object] | None = None,
        **options: Any,
    ) -> None:
        super().__init__(master, **options)
        self.session, self.theme = session, theme
        self.on_click, self.on_drag, self.on_release = on_click, on_drag, on_release
        #: Is called with a `Hit`, or None beside the object, wherever the pointer goes without a button down.
        self.on_point: Callable[[Hit | None], object] | None = None
        self.dpi = self.winfo_fpixels("1i") / 96
        self.scene = Scene(session, derived, theme, dpi=self.dpi)
        self.painter = Painter()
        self.camera = Camera(np.eye(3), np.zeros(3), np.ones(3), 1, 1)
        #: How many pictures were drawn, and how long the last one took, s.
        self.pictures, self.last_picture = 0, 0.0
        self.canvas = tk.Canvas(self, name="canvas", highlightthickness=1, borderwidth=0, takefocus=True, width=400, height=300)
        self.canvas.pack(fill="both", expand=True)
        self._plates: dict[int, Plate] = {}
        self._picture = self.canvas.create_image(0, 0, anchor="nw", tags=("picture",))
        self._furniture = Furniture(self.canvas, dpi=self.dpi)
        self._mesh: Mesh | None = None
        self._solid: Solid | None = None
        self._detail: Detail | None = None
        self._idle = self._rest = ""
        self._moving = False
        self._labelled: tuple[object, ...] = ()
        self._slow = self._gone = False
        self._whole = True  # all of the object is shown, and stays so when the window changes its size
        self._gestures = Gestures(self)
        self.cursor = KeyCursor(self._gestures, self.canvas, colours=lambda: (self.theme.accent, self.theme.view))
        self.canvas.bind("<Configure>", self._configured, add=True)
        self.bind("<Destroy>", self._destroyed, add=True)
        self._skin: Skin | None = None
        self._derived = derived
        derived.needs(self.scene.parts)
        session.listen("skin", self._on_skin)
        for topic in ("selection", "hover", "shading"):
            session.listen(topic, self.redraw)
        self._on_skin()
        self.restyle(theme)
        # Loading what is compiled takes half a second: while the window is still empty, not when there is something to show.
        threading.Thread(target=warm, daemon=True).start()

    # What others ask of it

    def restyle(self, theme: Theme) -> None:
        """Take the colours of another theme."""
        self.theme = self.scene.theme = theme
        self.canvas.configure(background=theme.view, highlightbackground=theme.border, highlightcolor=theme.accent)
        self.redraw()

    def show(self, name: str, polylines: list[ArrayLike], colour: str, width: float) -> None:
        """Draw polylines (k, 3) mm over the object, a single point as a dot, until the same name is shown anew or hidden."""
        self.scene.show(name, polylines, colour, width)
        self.redraw()

    def glow(self, name: str, points: ArrayLike, colour: str, *, radius: float, strength: float = 1.0) -> None:
        """Let the object glow round points (k, 3) mm, out to `radius` mm; `strength` from 0 to 1."""
        self.scene.glow(name, points, colour, radius=radius, strength=strength)
        self.redraw()

    def hide(self, name: str) -> None:
        """Take away what is shown or glows under a name."""
        if self.scene.hide(name):
            self.redraw()

    def fit(self) -> None:
        """Show all of the object."""
        self.move(self.camera.whole())

    def look(self, side: str) -> None:
        """From one of "front", "back", "left", "right", "top", "bottom"."""
        if side not in SIDES:
            raise ValueError(f"no side {side!r}; there are {', '.join(SIDES)}")
        self.move(self.camera.seen_from(side).whole())

    def move(self, camera: Camera) -> None:
        """See the object in another way; drawn at its best when it comes to rest."""
        if (camera.zoom, camera.pan) != (self.camera.zoom, self.camera.pan):
            whole = camera.whole()
            self._whole = camera.pan == whole.pan and bool(np.isclose(camera.zoom, whole.zoom))
        self.camera = camera
        self._moving = True
        self.redraw()

    def hit_at(self, x: int, y: int) -> Hit | None:
        """What is at a pixel of the canvas as it was drawn last; None beside the object."""
        skin = self._skin
        if skin is None or skin is not self.session.skin or self._solid is None or self._mesh is not skin.object:
            return None
        if self.painter.camera is None:
            return None
        return hit(skin, self.painter, self.scene.owner(skin), x, y, reach=round(_REACH * self.dpi))

    def hover_at(self, x: int, y: int) -> Target:
        """Tell the session what is at a pixel."""
        found = self.hit_at(x, y)
        target = NOTHING if found is None else found.target
        self.session.hover(target)
        if self.on_point is not None:
            self.on_point(found)
        return target

    @property
    def ready(self) -> bool:
        """Whether what is made beside the window, to turn a big object quickly, is there."""
        return self._detail is None or self._detail.wait(0)

    def redraw(self) -> None:
        """Draw anew as soon as nothing else is waiting; many calls give one picture."""
        if not self._idle and not self._gone:  # the session outlives the view, and still calls
            self._idle = self.after_idle(self._draw_idle)

    def settle(self) -> None:
        """Draw now, at its best."""
        self._cancel()
        self._moving = False
        self._draw()

    # How it draws

    def _on_skin(self) -> None:
        """Take the session's document as soon as it can be shown; until then, the one before stays."""
        skin = self.session.skin
        if not self._gone and (skin is None or self._derived.ready(skin, self._on_skin)):
            self._skin = skin
            self.redraw()

    def _draw_idle(self) -> None:
        self._idle = ""
        self._draw()
        if self._moving:
            if self._rest:
                self.after_cancel(self._rest)
            self._rest = self.after(_REST_MS, self._come_to_rest)

    def _come_to_rest(self) -> None:
        self._rest = ""
        self._moving = False
        self._draw()

    def _draw(self) -> None:
        width, height = self.canvas.winfo_width(), self.canvas.winfo_height()
        if width < 8 or height < 8:
            return  # not on the screen yet
        skin = self._skin
        words = _EMPTY if self.session.skin is None else _SOON
        self._furniture.notice(words if skin is None else "", self.theme)
        if skin is None:
            self._mesh = self._solid = self._detail = None
            self.canvas.itemconfigure(self._picture, state="hidden")
            self._furniture.clear(self.theme)
            self._labelled = ()
            return
        self._take(skin, width, height)
        start = time.perf_counter()
        self._paint(skin)
        self._paste()
        self._label(skin)
        self.last_picture = time.perf_counter() - start
        self.pictures += 1

    def _take(self, skin: Skin, width: int, height: int) -> None:
        """Prepare what follows from the object and the window's size."""
        if self._mesh is not skin.object:
            known = self._mesh is not None and self._mesh.F is skin.object.F
            self._mesh, self._solid, self._slow = skin.object, self.scene.solid(skin.object), False
            self._detail = Detail(skin.object)
            if not known:
                self.camera = Camera.fitted(skin.object.V[skin.object.topology.used_vertices], width, height)
        if (self.camera.width, self.camera.height) != (width, height):
            self.camera = self.camera.sized(width, height)
            if self._whole:
                self.camera = self.camera.whole()

    def _paint(self, skin: Skin) -> None:
        assert self._solid is not None
        camera, paint = self.camera, self.scene.paint(skin)
        strokes, spots = self.scene.strokes(skin, camera.scale), self.scene.spots
        rough = self._detail.rough if self._detail is not None else None
        solid = rough if self._moving and self._slow and rough is not None else self._solid
        fine = not self._moving and 4 * camera.width * camera.height <= _SAMPLES
        coarse = self._moving and camera.width * camera.height > _COARSE
        start = time.perf_counter()
        self.painter.draw(solid, camera, paint, strokes, sharper=2 if fine else 1, coarser=2 if coarse else 1, spots=spots)
        if self._moving and solid is self._solid:
            self._slow = time.perf_counter() - start > _SLOW

    def _paste(self) -> None:
        times = self.painter.coarser
        plate = self._plates.setdefault(times, Plate(self.canvas, times=times))
        self.canvas.itemconfigure(self._picture, image=plate.show(self.painter.pixels), state="normal")

    def _label(self, skin: Skin) -> None:
        camera, painter, scene = self.camera, self.painter, self.scene
        labelled = (skin, camera, painter.sharper, painter.coarser, self.theme.name, self.session.shading)
        if labelled == self._labelled:
            return  # only what lights up has changed
        self._labelled = labelled
        sensors = [sensor_label(painter, camera, sensor.id, scene.sensor_line(skin, k)) for k, sensor in enumerate(skin.sensors)]
        words = [label for label in sensors if label is not None]
        words += piece_labels(painter, scene.owner(skin), [piece.id for piece in skin.pieces])
        self._furniture.labels(words + seam_labels(painter, camera, scene.labels(skin)), self.theme)
        self._furniture.axes(camera, self.theme)
        self._furniture.scale(camera, self.theme)
        self._furniture.legend(self.session.shading, self.theme)

    def _configured(self, event: tk.Event[tk.Misc]) -> None:
        self._moving = self.session.skin is not None
        self.redraw()

    def _cancel(self) -> None:
        if self._idle:
            self.after_cancel(self._idle)
        if self._rest:
            self.after_cancel(self._rest)
        self._idle = self._rest = ""

    def _destroyed(self, event: tk.Event[tk.Misc]) -> None:
        if event.widget is self:
            self._cancel()
            self._gone = True
