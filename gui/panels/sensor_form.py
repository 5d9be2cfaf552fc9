"""A selected sensor: its place, its wiring, its pattern's parameters, and what it will measure like."""

from __future__ import annotations

import math
import tkinter as tk
from collections.abc import Callable
from dataclasses import replace
from tkinter import ttk

from gui.jobs.background import Background
from gui.jobs.worker import Outcome
from gui.panels.field import Field, number
from gui.scale import px
from gui.state.predict import Prediction, predict, worn, worn_strain
from gui.state.profiles import ProfileShelf
from gui.state.session import Session
from skinfab.drawings.catalogue import catalogue, common
from skinfab.errors import InputError, SkinfabError
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import parameters
from skinfab.placement import edit
from skinfab.placement.check import check_sensor
from skinfab.placement.sensor import Sensor
from skinfab.placement.wrap_strain import WornSkin, WrapStrain
from skinfab.skin import Skin

#: Strain is asked for once nothing has moved for so long, ms: while a sensor is dragged it would only be in the way.
_REST_MS = 250

_UNITS = {"mm": "mm", "count": "", "switch": ""}

#: Name, label and unit of the fields for where a sensor lies and how it is read.
_PLACE = (("x", "at x", "mm"), ("y", "at y", "mm"), ("angle", "turn", "deg"), ("channel", "ch", ""))


class SensorForm(ttk.Frame):
    """Fields for everything of a sensor that can be typed; the same changes as by dragging, through `placement.edit`."""

    def __init__(
        self, master: tk.Misc, session: Session, shelf: ProfileShelf, background: Background, *, complain: Callable[[str], None]
    ) -> None:
        super().__init__(master, name="sensor")
        self._session, self._shelf, self._background, self._complain = session, shelf, background, complain
        self._fields: dict[str, Field] = {}
        self._switches: dict[str, tk.BooleanVar] = {}
        self._kind = ""
        self._timer: str | None = None
        self._surfaces: tuple[tuple[object, ...], WornSkin] | None = None
        self._strain: tuple[Sensor, Mesh, str] | None = None
        self.words = tk.StringVar(self)
        ttk.Label(self, textvariable=self.words, wraplength=px(self, 290), justify="left", name="words").pack(anchor="w")
        self.fit = tk.StringVar(self)
        self._fit_label = ttk.Label(self, textvariable=self.fit, wraplength=px(self, 290), justify="left", name="fit")
        self._fit_label.pack(anchor="w")
        self._place = _two_columns(self, "place")
        for k, (name, label, unit) in enumerate(_PLACE):
            self._fields[name] = self._field(self._place, name, label, unit, "", at=k)
        ttk.Separator(self).pack(fill="x", pady=2)
        self._params = _two_columns(self, "params")
        self.bind("<Destroy>", lambda event: self._stop_timer())

    def refresh(self) -> None:
        """Show the selected sensor."""
        skin, sensor = self._selected()
        if skin is None or sensor is None:
            return
        if sensor.pattern.kind != self._kind:
            self._build(sensor)
        shown: dict[str, float] = {"x": sensor.x, "y": sensor.y, "angle": _turn(sensor.angle), "channel": sensor.channel}
        shown |= {f"param_{name}": value for name, value in parameters(sensor.pattern).items()}
        for name, value in shown.items():
            if name in self._switches:
                self._switches[name].set(bool(value))
            else:
                self._fields[name].show(f"{round(value, 3):g}")
        try:
            profiles = self._shelf.of(skin)
        except SkinfabError as fault:
            self.words.set("")
            self.fit.set(str(fault))
            return
        faults = check_sensor(skin.piece(sensor.piece), sensor, skin.sensors, material=profiles.roomy)
        self.fit.set("fits" if not faults else "; ".join(faults))
        self._fit_label.configure(style="Good.TLabel" if not faults else "Error.TLabel")
        # A line for it is kept from the beginning: the form is not to grow out of its room once it is known.
        self.words.set(_words(predict(sensor, profiles)) + (self._known_strain(skin, sensor) or "\nworn: not known yet"))
        self._stop_timer()
        self._timer = self.after(_REST_MS, self._ask_strain)

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self.after_cancel(self._timer)
            self._timer = None

    def _selected(self) -> tuple[Skin | None, Sensor | None]:
        skin, id = self._session.skin, self._session.selected.sensor
        found = [s for s in skin.sensors if s.id == id] if skin is not None else []
        return skin, found[0] if found else None

    def _build(self, sensor: Sensor) -> None:
        """Fields for the parameters of another kind of pattern."""
        self._kind = sensor.pattern.kind
        for child in self._params.winfo_children():
            child.destroy()
        entry = next(e for e in catalogue() if e.kind == self._kind)
        known = {p.name: p for p in (*entry.parameters, *common())}
        self._switches.clear()
        for k, name in enumerate(parameters(sensor.pattern)):
            parameter, key = known[name], f"param_{name}"
            tip = f"{parameter.meaning} ({parameter.bounds})" if parameter.bounds else parameter.meaning
            if parameter.unit == "switch":
                self._switches[key] = tk.BooleanVar(self)
                switch = ttk.Checkbutton(self._params, text=name, variable=self._switches[key], command=self._switch(key), name=key)
                switch.grid(row=k // 2, column=k % 2, sticky="w")
            else:
                self._fields[key] = self._field(self._params, key, name, _UNITS[parameter.unit], tip, at=k)

    def _field(self, master: tk.Misc, name: str, label: str, unit: str, tip: str, *, at: int) -> Field:
        field = Field(
            master, label, unit=unit, tip=tip, name=name, complain=self._complain, width=7, take=lambda text: self._take(name, text)
        )
        field.grid(row=at // 2, column=at % 2, sticky="ew", pady=0, padx=(0, 4))
        return field

    def _switch(self, name: str) -> Callable[[], None]:
        def switched() -> None:
            try:
                self._resize(name.removeprefix("param_"), self._switches[name].get())
            except SkinfabError as fault:
                self._complain(str(fault))
                self.refresh()

        return switched

    def _take(self, name: str, text: str) -> None:
        skin, sensor = self._selected()
        if skin is None or sensor is None:
            return
        value = number(text, name.removeprefix("param_"))
        id, sensors = sensor.id, skin.sensors
        if name in ("x", "y"):
            x, y = (value, sensor.y) if name == "x" else (sensor.x, value)
            self._do(f"move {id}", skin, edit.move(sensors, id, x=x, y=y))
        elif name == "angle":
            self._do(f"turn {id}", skin, edit.rotate(sensors, id, angle=math.radians(value) - sensor.angle))
        elif name == "channel":
            if value != int(value):
                raise InputError(f"channel is {value:g}; it must be a whole number, 0 or more")
            others = {s.channel: s.id for s in sensors if s.id != id}
            if int(value) in others:
                raise InputError(f"channel {int(value)} is used by {others[int(value)]}; give another")
            self._do(f"wire {id}", skin, edit.rewire(sensors, id, channel=int(value)))
        else:
            self._resize(name.removeprefix("param_"), int(value) if value == int(value) else value)

    def _resize(self, name: str, value: float | bool) -> None:
        skin, sensor = self._selected()
        if skin is not None and sensor is not None:
            self._do(f"{name} of {sensor.id}", skin, edit.resize(skin.sensors, sensor.id, {name: value}))

    def _do(self, label: str, skin: Skin, sensors: tuple[Sensor, ...]) -> None:
        self._session.do(label, replace(skin, sensors=sensors))

    def _ask_strain(self) -> None:
        self._timer = None
        skin, sensor = self._selected()
        if skin is None or sensor is None or self._known_strain(skin, sensor):
            return
        profiles = self._shelf.of(skin)
        key = (skin.object, skin.mesh, profiles)

        def strain() -> tuple[tuple[object, ...], WornSkin, WrapStrain]:
            kept = self._surfaces
            same = kept is not None and all(a is b for a, b in zip(kept[0], key, strict=True))
            surfaces = kept[1] if kept is not None and same else worn(skin, profiles)
            return key, surfaces, worn_strain(skin, sensor, profiles, surfaces)

        def answered(outcome: Outcome) -> None:
            if outcome.sentence:
                words = ""  # it lies beside its piece, which is said already
            else:
                surfaces_of, surfaces, found = outcome.result
                self._surfaces = surfaces_of, surfaces
                mean, most = round(100 * found.mean, 2) + 0.0, round(100 * found.max, 1) + 0.0  # no minus before zero
                words = f"\nworn {mean:+.2f} % (most {most:+.1f} %), R x {found.resistance_factor:.2f}"
            self._strain = sensor, skin.mesh, words
            if words:
                self.refresh()

        self._background.ask("strain", strain, answered)

    def _known_strain(self, skin: Skin, sensor: Sensor) -> str:
        known = self._strain
        return known[2] if known is not None and known[0] is sensor and known[1] is skin.mesh else ""


def _two_columns(master: tk.Misc, name: str) -> ttk.Frame:
    frame = ttk.Frame(master, name=name)
    frame.pack(fill="x")
    for column in (0, 1):
        frame.columnconfigure(column, weight=1, uniform="half")
    return frame


def _words(known: Prediction) -> str:
    r = known.resistance
    return f"{known.length:.1f} mm long, {known.ink_mm3:.0f} mm³ of ink\nR0 {r.median:.0f} kohm (nine in ten: {r.low:.0f} to {r.high:.0f})"


def _turn(angle: float) -> float:
    """Degrees as they are shown, from 0 to below 360.

    Examples
    --------
    >>> _turn(-1e-9), _turn(math.pi / 2), _turn(-math.pi / 2)
    (0.0, 90.0, 270.0)
    """
    return round(math.degrees(angle) % 360, 3) % 360
