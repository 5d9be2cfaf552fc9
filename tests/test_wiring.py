"""The wiring table read back, numbered by hand, and refused where it contradicts itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinfab.electrical import resistance
from skinfab.errors import InputError
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source
from skinfab.wiring import Wire, board_of, read_wiring, wiring, write_wiring

MATERIAL = load_material()
SPIRAL = ContactSpiral(n=2, x=1.7, b=1.5, l=3, s=15)


def skin_with(channels: list[int]) -> Skin:
    V = np.array([[0.0, 0, 0], [400, 0, 0], [400, 400, 0], [0, 400, 0]])
    F = np.array([[0, 1, 2], [0, 2, 3]])
    piece = Piece("P1", np.arange(2), np.arange(4), F, V[:, :2])
    sensors = tuple(Sensor(f"C{c}", "P1", SPIRAL, 10.0 + 20 * k, 33.3333, np.pi / 7, c) for k, c in enumerate(channels))
    return Skin(Mesh(V, F, "plate"), Source("plate.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), np.int64), (piece,), sensors)


def test_round_trip_and_the_same_bytes(tmp_path: Path) -> None:
    skin = skin_with([3, 0, 17, 31])
    wires = wiring(skin, MATERIAL)
    for name in ("a.csv", "b.csv"):
        write_wiring(wires, tmp_path / name)
    assert read_wiring(tmp_path / "a.csv") == wires == wiring(replace(skin, sensors=skin.sensors[::-1]), MATERIAL)
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


def test_numbers_by_hand() -> None:
    wires = wiring(skin_with([3, 0, 17, 31]), MATERIAL)
    assert [(w.wire, w.lead, w.channel, w.board, w.board_input) for w in wires] == [
        ("C0-1", "signal", 0, 1, 0),
        ("C0-2", "return", 0, 1, 0),
        ("C3-1", "signal", 3, 1, 3),
        ("C3-2", "return", 3, 1, 3),
        ("C17-1", "signal", 17, 2, 1),
        ("C17-2", "return", 17, 2, 1),
        ("C31-1", "signal", 31, 2, 15),
        ("C31-2", "return", 31, 2, 15),
    ]
    first = wires[2]  # of the sensor at (10, 33.3333), whose lower lead begins at its own origin
    assert (first.x_mm, first.y_mm) == (10.0, 33.333)
    assert first.median == pytest.approx(resistance(SPIRAL.path().length, MATERIAL.ink).median, abs=5e-4)
    assert board_of(32) == (3, 0)  # a third board, where per_piece asks for more than two hold


def test_columns_and_rows_may_be_moved_and_added(tmp_path: Path) -> None:
    wires = wiring(skin_with([0, 1]), MATERIAL)
    write_wiring(wires, tmp_path / "a.csv")
    rows = [line.split(",") for line in (tmp_path / "a.csv").read_text().splitlines()]
    text = "\r\n".join(",".join([*row[::-1], "note"]) for row in [rows[0], *rows[:0:-1]])
    (tmp_path / "b.csv").write_text("\ufeff" + text + "\r\n\r\n", encoding="utf-8")  # as a spreadsheet saves it
    assert read_wiring(tmp_path / "b.csv") == wires


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("board_input", "input", "no column 'board_input'"),
        ("C0-1,C0,contact-spiral,P1,1", "C0-1,C0,contact-spiral,P1,one", r"line 2: terminal is 'one'; it must be a whole number"),
        ("C0-1,C0,contact-spiral,P1,1", "C0-1,C0,contact-spiral,P1,2", "sensor C0 has a wire at terminal 2, 2"),
        ("C0-1,C0,", "C0-1,,", "line 2: sensor is ''"),
        ("10.0", "nan", "x_mm is 'nan'; it must be a number"),
        (",1,1,1,kohm", ",1,1,2,kohm", "board 1 input 2 is channel 2"),
        (",1,1,1,kohm", ",0,1,0,kohm", "channel 0 is given to C0 and C1"),
        ("C1-2,C1", "C1-2,C9", "channel 1 is given to C1 and C9"),
        (",kohm", ",kohm,extra", "16 values under 15 headings"),
        ("wire,", '"wire,', "is not a CSV file"),
    ],
)
def test_a_table_that_cannot_be_is_refused(old: str, new: str, says: str, tmp_path: Path) -> None:
    write_wiring(wiring(skin_with([0, 1]), MATERIAL), tmp_path / "a.csv")
    text = (tmp_path / "a.csv").read_text()
    assert old in text
    (tmp_path / "a.csv").write_text(text.replace(old, new))
    with pytest.raises(InputError, match=says):
        read_wiring(tmp_path / "a.csv")


def test_files_that_are_none(tmp_path: Path) -> None:
    (tmp_path / "empty.csv").write_text("")
    with pytest.raises(InputError, match="no column 'wire'"):
        read_wiring(tmp_path / "empty.csv")
    (tmp_path / "raw.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not a CSV file"):
        read_wiring(tmp_path / "raw.csv")
    (tmp_path / "huge.csv").write_bytes(b"a" * 4_000_001)
    with pytest.raises(InputError, match="far smaller"):
        read_wiring(tmp_path / "huge.csv")
    with pytest.raises(InputError, match="No such file"):
        read_wiring(tmp_path / "none.csv")


def test_one_channel_for_two_sensors_is_refused() -> None:
    skin = skin_with([4, 5])
    doubled = replace(skin, sensors=(skin.sensors[0], replace(skin.sensors[1], channel=4)))
    with pytest.raises(InputError, match="channel 4 is given to"):
        wiring(doubled, MATERIAL)


def test_a_sensor_on_two_channels_is_refused(tmp_path: Path) -> None:
    wires = wiring(skin_with([0, 1]), MATERIAL)
    doubled: list[Wire] = [*wires[:2], *(replace(w, sensor="C0") for w in wires[2:])]
    write_wiring(doubled, tmp_path / "a.csv")
    with pytest.raises(InputError, match="more than one channel"):
        read_wiring(tmp_path / "a.csv")


def test_no_sensors_no_rows(tmp_path: Path) -> None:
    write_wiring(wiring(skin_with([]), MATERIAL), tmp_path / "a.csv")
    assert read_wiring(tmp_path / "a.csv") == ()
