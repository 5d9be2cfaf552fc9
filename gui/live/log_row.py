"""A log's place: scrub bar, play and pause, speed."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from gui.live.player import Player

#: Times as fast as recorded: faster, the window would have no time for anything else.
SPEEDS = ("0.2", "0.5", "1", "2", "5", "10", "20")


class LogRow(ttk.Frame):
    """Leads a player.

    Parameters
    ----------
    master : widget
    """

    def __init__(self, master: tk.Misc) -> None:
        super().__init__(master, name="log_place", padding=(4, 2))
        self.player: Player | None = None
        self._leads = False
        self.play = ttk.Button(self, text="Pause", width=6, command=self.toggle, style="Tool.TButton", name="play")
        self.play.pack(side="left")
        self.speed = tk.StringVar(self, value="1")
        speeds = ttk.Combobox(self, textvariable=self.speed, values=SPEEDS, state="readonly", width=4, name="speed")
        speeds.bind("<<ComboboxSelected>>", lambda event: self._speed())
        ttk.Label(self, text="x", style="Faint.TLabel").pack(side="right")
        speeds.pack(side="right", padx=(6, 2))
        self._time = ttk.Label(self, width=15, anchor="e", name="time")
        self._time.pack(side="right")
        self.scale = ttk.Scale(self, from_=0.0, to=1.0, command=self._scrub, name="scale", takefocus=True)
        self.scale.pack(side="left", fill="x", expand=True, padx=6)
        for key, by in (("<Left>", -1.0), ("<Right>", 1.0), ("<Shift-Left>", -10.0), ("<Shift-Right>", 10.0)):
            self.scale.bind(key, lambda event, by=by: self._move(by))  # type: ignore[misc]
        self.scale.bind("<space>", lambda event: self.toggle())

    def lead(self, player: Player | None) -> None:
        """Lead another player, or none."""
        self.player = player
        if player is not None:
            self.scale.configure(to=max(player.duration_s, 1e-3))
            self._speed()

    def toggle(self) -> None:
        """Play, or pause; from the end, from the start again."""
        if (player := self.player) is not None:
            player.pause(not (player.paused or player.at_end))
            self.follow()

    def follow(self) -> None:
        """Show where the player is."""
        player = self.player
        if player is None:
            return
        self._leads = True  # or moving the bar would be taken for the user's hand
        self.scale.set(player.position_s)
        self._leads = False
        self._time.configure(text=f"{player.position_s:.1f} of {player.duration_s:.1f} s")
        self.play.configure(text="Play" if player.paused or player.at_end else "Pause")

    def _scrub(self, value: str) -> None:
        if not self._leads and self.player is not None:
            self.player.seek(float(value))

    def _move(self, by: float) -> str:
        if (player := self.player) is not None:
            player.seek(min(max(player.position_s + by, 0.0), player.duration_s))
        return "break"

    def _speed(self) -> None:
        if self.player is not None:
            self.player.speed(float(self.speed.get()))
