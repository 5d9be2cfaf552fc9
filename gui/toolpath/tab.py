"""The tab "Tool path": what will be printed on one piece, moment by moment."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from dataclasses import dataclass
from tkinter import ttk

import numpy as np

from gcode.emit import Arcs
from gcode.piece import PieceProgram, piece_program
from gui.jobs.background import Background
from gui.jobs.worker import Outcome
from gui.state.problem import Problem
from gui.state.profiles import ProfileShelf
from gui.state.selection import Target
from gui.state.session import Session
from gui.theme import Theme
from gui.toolpath.choice import ARCS, ArcsChoice
from gui.toolpath.findings import SOURCE, problems_of
from gui.toolpath.listing import Listing
from gui.toolpath.marks import warm
from gui.toolpath.picture import PathPicture, Scene, colours
from gui.toolpath.settings_list import SettingsList
from gui.toolpath.timeline import Instant, Timeline, legend, timeline
from gui.toolpath.transport import Transport, clock
from skinfab.placement.check import validate
from skinfab.skin import Skin

#: So long after the last change the path is planned anew, ms: not at every step of a drag.
_WAIT_MS = 250

#: Entries of the legend side by side.
_COLUMNS = 4


@dataclass(frozen=True, eq=False)
class Planned:
    """What is shown: the program of a piece of a document, laid out over time."""

    skin: Skin
    program: PieceProgram
    line: Timeline


class ToolPathTab(ttk.Frame):
    """Shows the program of a piece, by the document as it is; planned only while it is seen.

    Parameters
    ----------
    master : widget
    session : Session
    theme : Theme
    shelf : ProfileShelf
    background : Background
        Plans and checks.
    arcs : ArcsChoice
    export : callable
        Writes the G-code.
    """

    def __init__(
        self,
        master: tk.Misc,
        session: Session,
        theme: Theme,
        shelf: ProfileShelf,
        background: Background,
        *,
        arcs: ArcsChoice,
        export: Callable[[], object],
        name: str = "toolpath",
    ) -> None:
        super().__init__(master, name=name)
        self._session, self._theme, self._shelf, self._background, self._arcs = session, theme, shelf, background, arcs
        self.planned: Planned | None = None
        self._wanted: tuple[Skin, str, Arcs | None] | None = None
        self._timer: str | None = None
        self.piece, self.facts, self.message = tk.StringVar(self), tk.StringVar(self), tk.StringVar(self)
        self._build(export)
        session.listen("skin", self._changed)
        session.listen("selection", self._follow)
        arcs.listen(self._arcs_chosen)
        self.bind("<Map>", lambda event: self.refresh() if event.widget is self else None)
        self.bind("<Unmap>", lambda event: self.transport.stop() if event.widget is self else None)
        self.bind("<Destroy>", self._stop)

    def restyle(self, theme: Theme) -> None:
        """Other colours."""
        self._theme = theme
        self.picture.restyle(theme)
        self.listing.restyle(theme)
        self._show_legend()

    def refresh(self) -> None:
        """Plan the program anew if something it follows from has changed."""
        self._cancel_timer()
        skin = self._session.skin
        pieces = [p.id for p in skin.pieces if skin.sensors_on(p.id)] if skin is not None else []
        self.choice.configure(values=pieces)
        if skin is None or not pieces:
            self.piece.set("")
            self._wanted = None
            self._clear("Nothing to print yet: place a sensor on a flat piece.")
            return
        if self.piece.get() not in pieces:
            self.piece.set(self._selected(skin) if self._selected(skin) in pieces else pieces[0])
        wanted = (skin, self.piece.get(), self._arcs.arcs)
        if self._wanted is not None and self._wanted[0] is skin and self._wanted[1:] == wanted[1:]:
            return
        self._wanted = wanted
        self.message.set("planning …")
        self._background.ask("toolpath", lambda: _plan(self._shelf, *wanted), lambda outcome: self._take(wanted, outcome))

    def seek_line(self, line: int) -> None:
        """Look at the moment when a line of the text is done."""
        if self.planned is not None:
            self.seek_step(self.planned.line.step_of_line(line))

    def seek_step(self, step: int) -> None:
        """Look at the end of a step."""
        if self.planned is not None:
            path = self.planned.line
            # Just before the next one begins, so that this is the one that is told of.
            end = float(path.start[step + 1]) if step + 1 < len(path) else path.end
            self.transport.seek(max(float(np.nextafter(end, 0.0)), float(path.start[step])) if step + 1 < len(path) else end)

    def check(self) -> None:
        """Judge the program by all rules; what is found goes to the problems list."""
        planned = self.planned
        if planned is None:
            return
        self.message.set("checking …")
        self._background.ask("toolpath check", lambda: _judge(planned, self._shelf), lambda outcome: self._judged(planned, outcome))

    # How it is put together

    def _build(self, export: Callable[[], object]) -> None:
        top = ttk.Frame(self, name="top", padding=(6, 4))
        ttk.Label(top, text="Piece").pack(side="left")
        self.choice = ttk.Combobox(top, textvariable=self.piece, state="readonly", width=5, name="piece")
        self.choice.pack(side="left", padx=(4, 10))
        self.choice.bind("<<ComboboxSelected>>", lambda event: self.refresh())
        ttk.Label(top, text="Arcs").pack(side="left")
        self.arcs = ttk.Combobox(top, values=list(ARCS.values()), state="readonly", width=13, name="arcs")
        self.arcs.set(ARCS[self._arcs.arcs])
        self.arcs.pack(side="left", padx=(4, 10))
        self.arcs.bind("<<ComboboxSelected>>", lambda event: self._arcs.choose(list(ARCS)[self.arcs.current()]))
        self.check_button = ttk.Button(top, text="Check", command=self.check, name="check", style="Tool.TButton")
        self.check_button.pack(side="left")
        ttk.Button(top, text="Export G-code", command=export, name="export", style="Tool.TButton").pack(side="left", padx=4)
        top.pack(side="top", fill="x")
        self.legend = tk.Frame(self, name="legend")
        below = ttk.Notebook(self, name="below", height=int(118 * self.winfo_fpixels("1i") / 96))
        self.listing = Listing(below, self._theme, on_line=self.seek_line)
        self.settings = SettingsList(below)
        below.add(self.listing, text="G-code")
        below.add(self.settings, text="Printer and process")
        self.transport = Transport(self, on_time=self._look)
        below.pack(side="bottom", fill="x")
        ttk.Label(self, textvariable=self.facts, name="facts", padding=(8, 0), justify="left").pack(side="bottom", anchor="w", fill="x")
        self.transport.pack(side="bottom", fill="x")
        said = ttk.Label(self, textvariable=self.message, name="message", style="Faint.TLabel", padding=(8, 0))
        said.pack(side="bottom", anchor="w", fill="x")
        said.bind("<Configure>", lambda event: said.configure(wraplength=event.width - 16))
        self.legend.pack(side="bottom", fill="x", padx=8)
        self.picture = PathPicture(self, self._theme, on_step=self.seek_step)
        self.picture.widget.pack(side="top", fill="both", expand=True)
        self.transport.bind_keys(self.picture.widget)
        self._show_legend()

    def _show_legend(self) -> None:
        theme, drawn_as = self._theme, colours(self._theme)
        for child in self.legend.winfo_children():
            child.destroy()
        self.legend.configure(background=theme.panel)
        entries = legend(self.planned.line) if self.planned is not None else []
        for k, (role, words) in enumerate(entries):
            column = 2 * (k % _COLUMNS)
            line = tk.Label(self.legend, text="━", foreground=drawn_as[role], background=theme.panel, borderwidth=0, pady=0)
            line.grid(row=k // _COLUMNS, column=column, sticky="w")
            said = tk.Label(self.legend, text=words, foreground=theme.text, background=theme.panel, borderwidth=0, pady=0)
            said.grid(row=k // _COLUMNS, column=column + 1, sticky="w", padx=(2, 12))

    # What happens

    def _changed(self) -> None:
        if self.winfo_ismapped():
            self._cancel_timer()
            self._timer = self.after(_WAIT_MS, self.refresh)

    def _follow(self) -> None:
        """Show the piece that is selected, by itself or by one of its sensors."""
        skin = self._session.skin
        if skin is None or not (piece := self._selected(skin)) or piece == self.piece.get() or not skin.sensors_on(piece):
            return
        self.piece.set(piece)
        if self.winfo_ismapped():
            self.refresh()

    def _selected(self, skin: Skin) -> str:
        selected = self._session.selected
        owner = next((s.piece for s in skin.sensors if s.id == selected.sensor), "")
        return owner or selected.piece

    def _arcs_chosen(self) -> None:
        self.arcs.set(ARCS[self._arcs.arcs])
        if self.winfo_ismapped():
            self.refresh()

    def _take(self, wanted: tuple[Skin, str, Arcs | None], outcome: Outcome) -> None:
        if self._wanted is not wanted:
            return
        if outcome.sentence:
            self._clear(outcome.sentence)
            self._session.report("toolpath", [Problem(outcome.sentence, "toolpath", target=Target(piece=wanted[1]))])
            return
        planned: Planned = outcome.result
        self.planned = planned
        for source in ("toolpath", SOURCE):
            self._session.report(source, [])  # what was found there is of another program
        self.message.set("; ".join(planned.program.warnings))
        program = planned.program
        outline = program.mould.piece.UV[program.mould.piece.topology.E[program.mould.piece.topology.is_boundary]]
        self.transport.show(planned.line)
        now = planned.line.at(self.transport.time)
        self.picture.show(Scene(planned.line, outline + np.asarray(program.mould.offset), program.printer), now)
        self.listing.show(planned.line.lines)
        self.settings.show(program.printer, planned.skin.printer)
        self.check_button.state(["!disabled"])
        self._show_legend()
        self._tell(now)

    def _clear(self, why: str) -> None:
        self.planned = None
        self.message.set(why)
        self.facts.set("")
        self.transport.show(None)
        self.picture.show(None, None)
        self.listing.show(())
        self.check_button.state(["disabled"])
        self._show_legend()

    def _look(self, time: float) -> None:
        if self.planned is not None:
            now = self.planned.line.at(time)
            self.picture.seek(now)
            self._tell(now)

    def _tell(self, now: Instant) -> None:
        assert self.planned is not None
        path = self.planned.line
        self.listing.mark(now.line)
        place = " ".join(f"{axis}{value:.2f}" for axis, value in zip("XYZ", now.at, strict=True) if np.isfinite(value))
        speed = f" at {now.speed:.3g} mm/s" if now.speed else ""
        self.facts.set(
            f"{clock(now.time)} of {clock(path.end)}   line {now.line} of {len(path.lines)}   ink {now.ink:.1f} of {path.ink[-1]:.1f} mm³\n"
            f"{now.role}{f' {now.pattern}' if now.pattern else ''}{speed}   {place}"
        )

    def _judged(self, planned: Planned, outcome: Outcome) -> None:
        if self.planned is not planned:
            return
        self.message.set("")
        found = [Problem(outcome.sentence, SOURCE)] if outcome.sentence else problems_of(planned.program, outcome.result)
        self._session.report(SOURCE, found)
        faults = 0 if outcome.sentence else len(outcome.result.findings)
        if faults and outcome.result.findings[0].line:
            self.seek_line(outcome.result.findings[0].line)
        said = f"{faults} fault{'s' * (faults > 1)}, the first is shown" if faults else "no fault found"
        self.message.set("not checked: see the problems" if outcome.sentence else f"checked: {said}")

    def _cancel_timer(self) -> None:
        if self._timer is not None:
            self.after_cancel(self._timer)
            self._timer = None

    def _stop(self, event: tk.Event) -> None:
        if event.widget is self:
            self._cancel_timer()
            self._wanted = self.planned = None  # answers that come later are for nobody


def _plan(shelf: ProfileShelf, skin: Skin, piece: str, arcs: Arcs | None) -> Planned:
    used = shelf.of(skin)
    program = piece_program(skin, piece, printer=used.printer, material=used.material, arcs=arcs)
    line = timeline(program)
    warm()
    return Planned(skin, program, line)


def _judge(planned: Planned, shelf: ProfileShelf) -> object:
    validate(planned.skin, shelf.of(planned.skin).material)
    return planned.program.judge()
