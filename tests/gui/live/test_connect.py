from pathlib import Path

import pytest

from gui.live.choices import LogChoice, PortChoice, SimulatorChoice
from gui.live.connect import ConnectRow


@pytest.fixture
def row(root):
    told = {"connect": [], "complain": []}
    made = ConnectRow(root, ask_log=lambda: Path("/tmp/a.mcap"), connect=told["connect"].append, complain=told["complain"].append)
    made.pack(fill="x")
    made.told = told
    root.update()
    return made


def chosen(row, kind):
    row.kind.set(kind)
    row.show()
    row.update()


def press(row):
    row.button.invoke()
    return row.told["connect"][-1] if row.told["connect"] else None


def test_each_kind_shows_its_own_fields(row):
    for kind, name in (("Port", "port_row.port"), ("Log", "log_row.log"), ("Simulator", "simulator_row.simulator")):
        chosen(row, kind)
        assert row.nametowidget(name).winfo_ismapped()
        assert sum(row.nametowidget(each).winfo_ismapped() for each in ("port_row", "log_row", "simulator_row")) == 1


def test_what_is_chosen_is_what_is_connected(row):
    assert press(row) == SimulatorChoice("hand on a cube")
    chosen(row, "Port")
    row.port.set("/dev/ttyACM0")
    row.baud.set("115200")
    row.nametowidget("port_row.port").focus_force()
    row.nametowidget("port_row.port").event_generate("<Return>")
    assert row.told["connect"][-1] == PortChoice("/dev/ttyACM0", 115200)
    chosen(row, "Log")
    row.nametowidget("log_row.find").invoke()
    assert press(row) == LogChoice(Path("/tmp/a.mcap"))


def test_connected_the_button_disconnects(row):
    row.connected(True)
    assert row.button["text"] == "Disconnect" and press(row) is None and row.told["connect"] == [None]


@pytest.mark.parametrize(("kind", "baud", "says"), [("Port", "9600", "no port"), ("Port", "fast", "baud"), ("Log", "", "no log")])
def test_what_is_missing_is_said(row, kind, baud, says):
    chosen(row, kind)
    row.baud.set(baud)
    row.port.set("" if "port" in says else "/dev/x")
    press(row)
    assert row.told["connect"] == [] and says in row.told["complain"][0]


@pytest.mark.parametrize("choice", [PortChoice("/dev/ttyACM7", 9600), LogChoice(Path("/tmp/b.csv")), SimulatorChoice("robot finger")])
def test_what_was_chosen_elsewhere_is_in_the_fields(row, choice):
    row.tell(choice)
    assert row.choice() == choice
