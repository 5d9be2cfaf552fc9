"""The row in which a source is chosen."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable
from pathlib import Path
from tkinter import ttk

from gui.live.choices import SIMULATORS, Choice, LogChoice, PortChoice, SimulatorChoice, ports
from skinfab.errors import InputError
from skinfab.readout.serial_port import BAUD

KINDS = ("Port", "Log", "Simulator")
_BAUDS = (9600, 115200, 230400, 460800, BAUD, 2000000)


class ConnectRow(ttk.Frame):
    """Kind of source, which one, and a button.

    Parameters
    ----------
    master : widget
    ask_log : callable
        Asks for a log's path; None where none was given.
    connect : callable
        Called by the button, or Enter, with the choice, or with None to disconnect.
    complain : callable
        Called with a sentence on what is wrong with the choice.
    """

    def __init__(
        self,
        master: tk.Misc,
        *,
        ask_log: Callable[[], Path | None],
        connect: Callable[[Choice | None], object],
        complain: Callable[[str], object],
    ) -> None:
        super().__init__(master, name="connect", padding=(4, 4, 4, 2))
        self._ask_log, self._connect, self._complain = ask_log, connect, complain
        self.kind = tk.StringVar(self, value=KINDS[2])
        kinds = ttk.Combobox(self, textvariable=self.kind, values=KINDS, state="readonly", width=9, name="kind")
        kinds.pack(side="left")
        kinds.bind("<<ComboboxSelected>>", lambda event: self.show())
        self.button = ttk.Button(self, text="Connect", command=self._press, name="button", style="Tool.TButton")
        self.button.pack(side="right")
        self.port, self.baud = tk.StringVar(self), tk.StringVar(self, value=str(BAUD))
        self.log, self.simulator = tk.StringVar(self), tk.StringVar(self, value=SIMULATORS[0])
        self._rows = {"Port": self._port_row(), "Log": self._log_row(), "Simulator": self._simulator_row()}
        self._connected = False
        self.show()

    def show(self) -> None:
        """The fields of the chosen kind."""
        for row in self._rows.values():
            row.pack_forget()
        self._rows[self.kind.get()].pack(side="left", fill="x", expand=True, padx=4)

    def tell(self, choice: Choice) -> None:
        """Say in the fields what was chosen, wherever that was."""
        if isinstance(choice, PortChoice):
            self.kind.set("Port")
            self.port.set(choice.port)
            self.baud.set(str(choice.baud))
        elif isinstance(choice, LogChoice):
            self.kind.set("Log")
            self.log.set(str(choice.path))
        else:
            self.kind.set("Simulator")
            self.simulator.set(choice.kind)
        self.show()

    def connected(self, connected: bool) -> None:
        """What the button does from now on."""
        self._connected = connected
        self.button.configure(text="Disconnect" if connected else "Connect")

    def choice(self) -> Choice:
        """What the fields say.

        Raises
        ------
        InputError
            Something is missing or is no number.
        """
        kind = self.kind.get()
        if kind == "Simulator":
            return SimulatorChoice(self.simulator.get())
        if kind == "Log":
            if not self.log.get().strip():
                raise InputError("no log is named; choose one by the button beside the field")
            return LogChoice(Path(self.log.get().strip()).expanduser())
        baud = self.baud.get().strip()
        if not self.port.get().strip():
            raise InputError("no port is named; plug the device in and choose it from the list")
        if not (baud.isascii() and baud.isdecimal() and int(baud) > 0):
            raise InputError(f"{baud!r} is no baud rate; give one such as {BAUD}")
        return PortChoice(self.port.get().strip(), int(baud))

    def _press(self) -> None:
        if self._connected:
            self._connect(None)
            return
        try:
            choice = self.choice()
        except InputError as fault:
            self._complain(str(fault))
            return
        self._connect(choice)

    def _port_row(self) -> ttk.Frame:
        row = ttk.Frame(self, name="port_row")
        box = ttk.Combobox(row, textvariable=self.port, width=14, name="port")
        box.configure(postcommand=lambda: box.configure(values=ports()))
        box.pack(side="left", fill="x", expand=True)
        rate = ttk.Combobox(row, textvariable=self.baud, values=[str(each) for each in _BAUDS], width=8, name="baud")
        rate.pack(side="left", padx=(4, 2))
        ttk.Label(row, text="baud", style="Faint.TLabel").pack(side="left")
        for each in (box, rate):
            each.bind("<Return>", lambda event: self._press())
        return row

    def _log_row(self) -> ttk.Frame:
        row = ttk.Frame(self, name="log_row")
        entry = ttk.Entry(row, textvariable=self.log, name="log", width=14)
        entry.pack(side="left", fill="x", expand=True)
        entry.bind("<Return>", lambda event: self._press())
        ttk.Button(row, text="\N{HORIZONTAL ELLIPSIS}", command=self._find, style="Tool.TButton", name="find").pack(
            side="left", padx=(4, 0)
        )
        return row

    def _simulator_row(self) -> ttk.Frame:
        row = ttk.Frame(self, name="simulator_row")
        box = ttk.Combobox(row, textvariable=self.simulator, values=SIMULATORS, state="readonly", width=20, name="simulator")
        box.pack(side="left", fill="x", expand=True)
        return row

    def _find(self) -> None:
        path = self._ask_log()
        if path is not None:
            self.log.set(str(path))
