"""The document's own settings: printer, material, the bound on distortion, and where it came from."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from dataclasses import replace
from importlib import resources
from pathlib import Path
from tkinter import filedialog, ttk

from gcode.printer import load_printer
from gui.panels.field import Field, number
from gui.scale import px
from gui.state.session import Session
from skinfab.errors import InputError, SkinfabError
from skinfab.material import load_material
from skinfab.skin import Skin
from skinfab.tolerances import BOUNDS

_OWN = "a file of your own …"


class DocumentForm(ttk.Frame):
    """What is selected when nothing is."""

    def __init__(
        self,
        master: tk.Misc,
        session: Session,
        *,
        complain: Callable[[str], None],
        make_thick: Callable[[float], object],
    ) -> None:
        super().__init__(master, name="document")
        self._session, self._complain, self._make_thick = session, complain, make_thick
        self.columnconfigure(1, weight=1)
        self.printer = self._choice(0, "printer", bundled("gcode", "profiles"), load_printer)
        self.material = self._choice(1, "material", bundled("skinfab", "materials"), load_material)
        self.bound = Field(
            self,
            "bound on mean d",
            name="bound",
            take=self._set_bound,
            complain=complain,
            tip="Pieces are cut until each piece's mean distortion is at most this; 4 is perfect. More is less seam: "
            + ", ".join(f"{name} ({value:g})" for name, value in BOUNDS.items())
            + ".",
        )
        self.bound.grid(row=2, column=0, columnspan=2, sticky="ew", pady=2)
        self.thickness = Field(
            self,
            "skin thickness",
            unit="mm",
            name="thickness",
            take=self._set_thickness,
            complain=complain,
            tip="The skin closes without stretching where the surface in its middle is flattened; 0 flattens the object's own.",
        )
        self.thickness.grid(row=3, column=0, columnspan=2, sticky="ew", pady=2)
        self._depth = 0.0
        self.usual = ttk.Button(self, name="usual", command=lambda: self._thicken(self._depth))
        self.usual.grid(row=4, column=0, columnspan=2, sticky="e", pady=2)
        self.text = tk.StringVar(self)
        ttk.Label(self, textvariable=self.text, style="Faint.TLabel", wraplength=px(self, 290), justify="left").grid(
            row=5, column=0, columnspan=2, sticky="w"
        )

    def refresh(self) -> None:
        """Show the document's settings."""
        skin = self._session.skin
        if skin is None:
            return
        self.printer.set(skin.printer)
        self.material.set(skin.material)
        self.bound.show(f"{skin.max_distortion:g}")
        self.thickness.show(f"{skin.thickness:g}")
        self._offer(skin)
        low, high = skin.object.bbox
        size = " x ".join(f"{x:.1f}" for x in high - low)
        self.text.set(f"{size} mm, {len(skin.mesh.F)} triangles, read in {skin.source.units} x {skin.source.scale:g}")

    def _choice(self, row: int, what: str, names: list[str], load: Callable[[str], object]) -> tk.StringVar:
        value = tk.StringVar(self)
        ttk.Label(self, text=what).grid(row=row, column=0, sticky="w", pady=2)
        box = ttk.Combobox(self, textvariable=value, values=[*names, _OWN], state="readonly", name=what)
        box.grid(row=row, column=1, sticky="ew", padx=4, pady=2)
        box.bind("<<ComboboxSelected>>", lambda event: self._take_profile(what, value.get(), load))
        return value

    def _take_profile(self, what: str, name: str, load: Callable[[str], object]) -> None:
        skin = self._session.skin
        if skin is None:
            return
        if name == _OWN:
            # The document finds it again by its absolute path.
            chosen = filedialog.askopenfilename(parent=self, title=f"A {what} profile", filetypes=[("profile", "*.toml")])
            name = str(Path(chosen).resolve()) if chosen else getattr(skin, what)
        try:
            load(name)
        except SkinfabError as fault:
            self._complain(str(fault))
            name = getattr(skin, what)
        if name != getattr(skin, what):
            self._session.do(f"other {what}", replace(skin, printer=name) if what == "printer" else replace(skin, material=name))
        self.refresh()

    def _set_thickness(self, text: str) -> None:
        value = number(text, "the thickness")
        if value < 0:
            raise InputError(f"the thickness is {value:g} mm; it must be 0 or more")
        self._thicken(value)

    def _thicken(self, value: float) -> None:
        self._make_thick(value)
        # Until it lies flat, and where nothing comes of it, the field says what still is.
        self.after_idle(self.refresh)

    def _offer(self, skin: Skin) -> None:
        """The thickness that the material pours, with which what would fold is rounded off."""
        try:
            self._depth = load_material(skin.material).depth
        except SkinfabError:  # the problems list says so
            self._depth = 0.0
        self.usual.configure(text=f"Take {self._depth:g} mm, as the material pours")
        self.usual.state(["!disabled" if self._depth not in (0.0, skin.thickness) else "disabled"])

    def _set_bound(self, text: str) -> None:
        skin = self._session.skin
        if text in BOUNDS:
            value = BOUNDS[text]
            self.after_idle(self.refresh)  # shows the number once the name is taken
        else:
            value = number(text, "the bound")
        if not value > 4:
            raise InputError(f"the bound is {value:g}; it must be above 4, which is a perfect flattening")
        if skin is not None and value != skin.max_distortion:
            self._session.do("other bound", replace(skin, max_distortion=value))


def bundled(package: str, folder: str) -> list[str]:
    """Names of the profiles that come with a package.

    Examples
    --------
    >>> "generic-grbl" in bundled("gcode", "profiles")
    True
    """
    return sorted(f.name.removesuffix(".toml") for f in (resources.files(package) / folder).iterdir() if f.name.endswith(".toml"))
