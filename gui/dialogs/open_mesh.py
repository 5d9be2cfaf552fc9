"""What a mesh file holds, before it is taken: its faults, its unit, what repair would change."""

from __future__ import annotations

import tkinter as tk
from dataclasses import dataclass
from tkinter import ttk

from gui.dialogs.question import make_modal
from gui.jobs.tasks import MeshFacts
from gui.panels.field import number
from skinfab.errors import InputError
from skinfab.mesh.units import MM_PER_UNIT


@dataclass(frozen=True)
class MeshChoice:
    """How a mesh file is to be read.

    Parameters
    ----------
    units : "mm", "cm", "m" or "in"
    repair : bool
        Mend faults that change the surface.
    wrap_mm : float
        Skin the outside alone: bridge what a ball of this diameter cannot enter; 0 to take the surface as it is.
    """

    units: str
    repair: bool
    wrap_mm: float = 0.0


def ask_how_to_open(master: tk.Misc, facts: MeshFacts) -> MeshChoice | None:
    """Show what was found and ask; None where the file is not to be opened."""
    return _OpenMesh(master, facts).choice


class _OpenMesh(tk.Toplevel):
    def __init__(self, master: tk.Misc, facts: MeshFacts) -> None:
        super().__init__(master, name="open_mesh", background=ttk.Style(master).lookup(".", "background"))
        self.title(f"Open {facts.file}")
        self.resizable(False, False)
        self.choice: MeshChoice | None = None
        self._units = tk.StringVar(self, value=facts.units)
        self._repair = tk.BooleanVar(self, value=not facts.usable and bool(facts.repair_does))
        self._wrapped, self._ball, self._fault = tk.BooleanVar(self), tk.StringVar(self, value="8"), tk.StringVar(self)
        body = ttk.Frame(self, padding=16, name="body")
        body.pack(fill="both", expand=True)
        ttk.Label(body, text=facts.headline, style="Title.TLabel", wraplength=620).pack(anchor="w")
        self._ask_units(body, facts)
        self._list(body, "What reading it mends", facts.cleaning_does)
        self._list(body, "What is left then" if facts.cleaning_does else "What was found", facts.found)
        if facts.repair_does:
            ttk.Checkbutton(body, text="Repair it:", variable=self._repair, name="repair").pack(anchor="w", pady=(8, 0))
            self._list(body, "", facts.repair_does)
        self._ask_wrap(body)
        buttons = ttk.Frame(body, name="buttons")
        ttk.Label(buttons, textvariable=self._fault, style="Error.TLabel").pack(side="left", padx=(0, 10))
        buttons.pack(anchor="e", pady=(14, 0))
        ttk.Button(buttons, text="Open", command=self._take, default="active", name="open").pack(side="left", padx=6)
        ttk.Button(buttons, text="Cancel", command=self.destroy, name="cancel").pack(side="left")
        self.bind("<Return>", lambda event: self._take())
        self.bind("<Escape>", lambda event: self.destroy())
        make_modal(self, master, buttons.nametowidget("open"))

    def _ask_units(self, body: ttk.Frame, facts: MeshFacts) -> None:
        ttk.Label(body, text=facts.unit_reason, wraplength=620, style="TLabel" if facts.unit_sure else "Warning.TLabel").pack(
            anchor="w", pady=(8, 2)
        )
        row = ttk.Frame(body, name="units")
        row.pack(anchor="w")
        for units, factor in MM_PER_UNIT.items():
            text = f"{units}: {_length(facts.extent * factor)} long"
            ttk.Radiobutton(row, text=text, value=units, variable=self._units, name=units).pack(side="left", padx=(0, 10))

    def _ask_wrap(self, body: ttk.Frame) -> None:
        row = ttk.Frame(body, name="wrap")
        row.pack(anchor="w", pady=(8, 0))
        text = "Skin the outside alone; bridge holes and gaps that a ball this wide cannot enter:"
        ttk.Checkbutton(row, text=text, variable=self._wrapped, name="on").pack(side="left")
        ttk.Entry(row, textvariable=self._ball, width=5, justify="right", name="ball").pack(side="left", padx=4)
        ttk.Label(row, text="mm", style="Faint.TLabel").pack(side="left")

    def _list(self, body: ttk.Frame, heading: str, lines: tuple[str, ...]) -> None:
        if lines:
            shown = [*lines[:8], *([f"and {len(lines) - 8} more"] if len(lines) > 8 else [])]
            text = "\n".join([*([heading + ":"] if heading else []), *(f"  • {line}" for line in shown)])
            ttk.Label(body, text=text, wraplength=620, justify="left").pack(anchor="w", pady=(6, 0))

    def _take(self) -> None:
        wrap = 0.0
        if self._wrapped.get():
            try:
                wrap = number(self._ball.get().replace(",", "."), "the ball's diameter")
            except InputError:
                wrap = -1.0
            if wrap <= 0:
                self._fault.set("The ball's diameter must be a number above 0; 8 mm is a fingertip.")
                return
        self.choice = MeshChoice(self._units.get(), self._repair.get(), wrap)
        self.destroy()


def _length(mm: float) -> str:
    """A length in the unit that people say it in.

    Examples
    --------
    >>> _length(40.0), _length(90000.0), _length(0.0004), _length(12345.6)
    ('40 mm', '90 m', '0.0004 mm', '12.35 m')
    """
    shown, unit = (mm / 1000, "m") if mm >= 10000 else (mm, "mm")
    return f"{float(f'{shown:.4g}'):,.10g} {unit}".replace(",", " ")
