from pathlib import Path

import pytest

from calibration.contact.objects import OBJECTS
from gui.live.choices import HANDS, SIMULATORS, LogChoice, PortChoice, SimulatorChoice, ports, source_of
from skinfab.errors import InputError
from skinfab.readout.serial_port import SerialPort

LOGS = Path(__file__).resolve().parents[3] / "calibration" / "logs"


@pytest.mark.parametrize("kind", SIMULATORS)
def test_every_simulator_gives_frames_and_says_that_it_is_one(kind):
    source, notes = source_of(SimulatorChoice(kind))
    with source:
        frame = source.read(1.0)
    assert source.stream.simulated and frame is not None and len(frame.values) == len(source.stream.channels) and notes == ()


def test_there_is_a_hand_for_each_object():
    assert set(HANDS.values()) == set(OBJECTS)


def test_a_log_is_checked_when_it_is_opened():
    source, notes = source_of(LogChoice(LOGS / "contact_cube_1.csv"))
    assert source.stream.simulated and any("saturated" in note or "not valid" in note for note in notes)


def test_what_is_not_there_is_refused():
    with pytest.raises(InputError, match=r"nowhere\.csv"):
        source_of(LogChoice(Path("nowhere.csv")))
    with pytest.raises(InputError, match="no simulator 'dog'"):
        source_of(SimulatorChoice("dog"))


def test_ports_are_listed_and_opened_later():
    assert all(port.startswith("/dev/") for port in ports())
    source, notes = source_of(PortChoice("/dev/nowhere", 9600))
    assert isinstance(source, SerialPort) and source.baud == 9600 and notes == ()
