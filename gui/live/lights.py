"""Contact lights: sensors that are touched glow on the object and are marked on the flat skin."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from tkinter import ttk

import numpy as np
from numpy.typing import NDArray

from gui.state.derived import Derived
from gui.state.session import Session
from gui.theme import Theme
from gui.view2d.view import View2D
from gui.view3d.view import View3D
from skinfab.skin import Skin

#: A change of this part of the reading at rest lights a sensor fully; the least light is seen too.
FULL, LEAST = 0.5, 0.45
#: Steps of brightness: a picture is drawn anew only where a light has changed by one.
STEPS = 4
#: A sensor glows round so many points of its conductor, each as far as this part of its size, mm at least and at most.
_POINTS, _REACH, _REACH_MM = 24, 0.3, (3.0, 14.0)


@dataclass(frozen=True)
class Light:
    """A sensor that is touched.

    Parameters
    ----------
    step : int
        How bright, 1 to `STEPS`.
    rises : bool
        Its reading rises; one that falls has another colour.
    """

    step: int
    rises: bool

    @property
    def strength(self) -> float:
        """From `LEAST` to 1."""
        return LEAST + (1 - LEAST) * (self.step - 1) / (STEPS - 1)


def lights_of(touched: Mapping[str, float], names: Sequence[str], sensors: Sequence[str]) -> dict[str, Light]:
    """Which sensors are lit.

    Parameters
    ----------
    touched : mapping of str to float
        Signed change of each touched channel, as a part of its reading at rest.
    names, sensors : sequence of str
        The stream's channels, and the sensor of each.

    Examples
    --------
    >>> lights_of({"S2": -0.16, "S3": 2.0}, ("S1", "S2", "S3"), ("C1", "C2", ""))
    {'C2': Light(step=2, rises=False)}
    """
    lit: dict[str, Light] = {}
    for name, sensor in zip(names, sensors, strict=True):
        if sensor and name in touched:
            change = touched[name]
            step = min(int(abs(change) / FULL * STEPS) + 1, STEPS)
            if sensor not in lit or lit[sensor].step < step:
                lit[sensor] = Light(step, change >= 0)
    return lit


class Lights:
    """Shows lights in both views, and says there that they are simulated where they are.

    Parameters
    ----------
    session : Session
    derived : Derived
    theme : Theme
    view3d : View3D
    view2d : View2D
    """

    def __init__(self, session: Session, derived: Derived, theme: Theme, view3d: View3D, view2d: View2D) -> None:
        self._session, self._derived, self._theme = session, derived, theme
        self._view3d, self._view2d = view3d, view2d
        #: What is lit.
        self.lit: dict[str, Light] = {}
        self._skin: Skin | None = None
        self._notes = [ttk.Label(view, name="live", style="Simulated.TLabel", padding=(6, 2)) for view in (view3d, view2d)]

    def restyle(self, theme: Theme) -> None:
        """Other colours."""
        self._theme = theme
        self.show(self.lit, anew=True)

    def say(self, text: str) -> None:
        """Words at the top of both views, such as that lights are simulated; "" for none."""
        for note in self._notes:
            if text:
                note.configure(text=text)
                note.place(relx=0.5, y=6, anchor="n")
            else:
                note.place_forget()

    def show(self, lit: Mapping[str, Light], *, anew: bool = False) -> None:
        """Light these and no others; only what has changed is drawn."""
        skin = self._session.skin
        anew = anew or skin is not self._skin
        self._skin = skin
        by_id = {} if skin is None else {s.id: s for s in skin.sensors}
        lit = {id: light for id, light in lit.items() if id in by_id}
        for id in self.lit:
            if id not in lit:
                self._view3d.hide(f"live {id}")
                self._view2d.hide(f"live {id}")
        for id, light in lit.items():
            if skin is not None and (anew or self.lit.get(id) != light):
                colour = self._theme.select if light.rises else self._theme.accent
                points, radius = self._round(self._derived.object_line(skin, by_id[id]))
                self._view3d.glow(f"live {id}", points, colour, radius=radius, strength=light.strength)
                line = self._derived.flat_line(by_id[id])
                self._view2d.show(f"live {id}", [(by_id[id].piece, line)], colour, 1.5 + 0.5 * light.step, words=id)
        self.lit = dict(lit)

    @staticmethod
    def _round(line: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
        there = line[np.isfinite(line).all(axis=1)]
        if not len(there):
            return there, _REACH_MM[0]
        size = float(np.linalg.norm(np.ptp(there, axis=0)))
        return there[:: max(len(there) // _POINTS, 1)], float(np.clip(_REACH * size, *_REACH_MM))
