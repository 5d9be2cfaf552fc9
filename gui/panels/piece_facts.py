"""A selected piece in numbers."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from gui.scale import px
from gui.state.derived import Derived
from gui.state.session import Session
from skinfab.skin import Skin


class PieceFacts(ttk.Frame):
    """Size, area, distortion and what lies on it."""

    def __init__(self, master: tk.Misc, session: Session, derived: Derived) -> None:
        super().__init__(master, name="piece")
        self._session, self._derived = session, derived
        self.text = tk.StringVar(self)
        ttk.Label(self, textvariable=self.text, justify="left", wraplength=px(self, 290), name="text").pack(anchor="w")

    def refresh(self) -> None:
        """Show the selected piece."""
        skin = self._session.skin
        if skin is not None:
            self.text.set("\n".join(self._lines(skin, self._session.selected.piece)))

    def _lines(self, skin: Skin, id: str) -> list[str]:
        piece = skin.piece(id)
        d = self._derived.distortion(skin.mesh, piece)
        sensors = [s.id for s in skin.sensors_on(id)]
        lines = [
            f"{piece.size[0]:.1f} x {piece.size[1]:.1f} mm, {piece.area:.0f} mm² flat, {len(piece.F)} triangles",
            f"distortion d: mean {d.mean:.4f}, p99 {d.p99:.3f}, max {d.max:.3f} (4 is perfect)",
            f"sensors: {', '.join(sensors)}" if sensors else "no sensors yet",
        ]
        if d.flipped:
            lines.insert(2, f"{d.flipped} triangles are turned over")
        if d.mean > skin.max_distortion:
            lines.insert(2, f"above the bound of {skin.max_distortion:g}: cut it further, or raise the bound")
        return lines
