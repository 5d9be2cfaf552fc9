"""The printer profile and its process settings, to be read: another profile is chosen in Properties."""

from __future__ import annotations

import tkinter as tk
from tkinter import ttk

from gcode.printer import Printer
from gui.toolpath.settings import GROUPS, Setting, profile_name, settings


class SettingsList(ttk.Frame):
    """A list of fields, values and units, by table."""

    def __init__(self, master: tk.Misc) -> None:
        super().__init__(master, name="settings")
        self._shown: tuple[Setting, ...] = ()
        self.title = tk.StringVar(self)
        ttk.Label(self, textvariable=self.title, style="Faint.TLabel", name="title").pack(anchor="w", padx=6)
        rows = ttk.Frame(self)
        rows.pack(fill="both", expand=True)
        self.list = ttk.Treeview(rows, columns=("value", "unit"), show="tree", height=5, selectmode="browse", name="list")
        self.list.column("#0", width=230)
        self.list.column("value", width=90, anchor="e", stretch=False)
        self.list.column("unit", width=110, stretch=False)
        bar = ttk.Scrollbar(rows, command=self.list.yview)
        self.list.configure(yscrollcommand=bar.set)
        bar.pack(side="right", fill="y")
        self.list.pack(side="left", fill="both", expand=True)

    def show(self, printer: Printer | None, named: str = "") -> None:
        """Show a profile, and the name by which the document finds it."""
        new = () if printer is None else settings(printer)
        self.title.set("" if printer is None else f"{profile_name(named)}; another is chosen in Properties")
        if new == self._shown:
            return
        self._shown = new
        self.list.delete(*self.list.get_children())
        for group, title in GROUPS.items():
            mine = [setting for setting in new if setting.group == group]
            if mine:
                self.list.insert("", "end", iid=f"/{group}", text=title, open=True)
            for setting in mine:
                self.list.insert(f"/{group}", "end", iid=f"{group}/{setting.name}", text=setting.name, values=(setting.value, setting.unit))
