"""A wiring table on a readout's channels: names, what does not agree, and resistances beside the predicted ones."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.document import save_skin
from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs.log import read_log, write_log
from skinfab.readout.pty_server import PtyServer
from skinfab.skin import Skin, Source
from skinfab.wired import load_wiring, rests, unit_notes, wired
from skinfab.wiring import Wire, write_wiring


def wires(**channels: int) -> tuple[Wire, ...]:
    """Sensors by their channels, each of 50 to 500 kohm."""
    return tuple(
        Wire(f"{s}-{t}", s, "contact-spiral", "P1", t, "signal", 2.0, 3.0, c, c // 16 + 1, c % 16, "kohm", 50.0, 150.0, 500.0)
        for s, c in sorted(channels.items(), key=lambda each: each[1])
        for t in (1, 2)
    )


def stream(*units: str) -> Stream:
    return Stream("skin", tuple(Channel(f"ch{k + 1}", unit) for k, unit in enumerate(units)), 50.0)


def still(of: Stream, *levels: float) -> Recording:
    """Four seconds at rest with a little noise; NaN is a channel that says nothing."""
    noise = np.random.default_rng(0).standard_normal((200, len(levels)))
    return Recording.of_values(of, np.array(levels) * (1 + 1e-4 * noise), device_time=np.arange(200) / 50)


@pytest.fixture
def table(tmp_path: Path) -> Path:
    write_wiring(wires(C1=0, S1=1, C9=2), tmp_path / "wiring.csv")
    return tmp_path / "wiring.csv"


def test_channels_get_names_kinds_boards_and_inputs() -> None:
    got, notes = wired(stream(*["V"] * 18), wires(C1=0, C9=17))
    assert (got.names[0], got.names[1], got.names[17]) == ("C1", "ch2", "C9")
    last = got.channels[17]
    assert (last.sensor, last.kind, last.unit, last.board, last.board_input) == ("C9", "contact", "V", 2, 1)
    assert (got.channels[1].sensor, got.channels[16].board, got.channels[16].board_input) == ("", 2, 0)
    (note,) = notes
    assert note.startswith("skin has 18 channels and the wiring 2 sensors: nothing is wired to ch2, ch3,") and "ch18" not in note


def test_what_agrees_is_not_talked_about_and_a_name_that_is_taken_gives_way() -> None:
    assert wired(stream("V", "V"), wires(C1=0, C2=1))[1] == []
    named = Stream("skin", (Channel("A"), Channel("C1")))
    assert wired(named, wires(C1=0))[0].names == ("C1", "board 1 input 1")


def test_another_skins_table_is_refused() -> None:
    with pytest.raises(InputError, match=r"skin has 1 channel, but by the wiring C9 is channel 17 \(counted from 0: board 2, input 1\)"):
        wired(stream("V"), wires(C1=0, C9=17))
    says = replace(stream("V"), channels=(Channel("a", sensor="S4"),))
    with pytest.raises(InputError, match=r"channel 0 is sensor S4, the wiring that it is C1"):
        wired(says, wires(C1=0))
    assert wired(replace(says, channels=(Channel("a", sensor="C1"),)), wires(C1=0))[0].names == ("C1",)


def test_resistances_at_rest_beside_the_predicted_ones() -> None:
    table = wires(well=0, broken=1, touching=2, silent=3, volts=4)
    of, _ = wired(stream("kohm", "ohm", "kohm", "kohm", "V"), table)
    found = rests(still(of, 180.0, 9e6, 2.0, np.nan, 1.1), table)
    assert [each.sensor for each in found] == ["well", "broken", "touching", "silent"]
    assert [each.measured for each in found[:3]] == pytest.approx([180, 9000, 2], rel=1e-3)
    assert found[0].verdict == ""
    assert "above the 50 to 500 predicted: its line or a wire may be broken" in found[1].verdict
    assert "below the 50 to 500 predicted: two lines or wires may touch" in found[2].verdict
    assert found[3].verdict.startswith("silent reads nothing")
    (volts,) = rests(still(of, 180.0, 9e6, 2.0, np.nan, 1.1), table, known={"volts": 77.0})[4:]
    assert (volts.measured, volts.verdict) == (77.0, "")


def test_channels_without_a_unit_of_resistance_are_said() -> None:
    table = wires(a=0, b=1, c=2, d=3, e=4, f=5)
    known, _ = wired(stream("kohm", "kOhm", "k\u2126", "\u03a9", "V", "pF"), table)
    assert unit_notes(known, table) == []
    found = rests(still(known, 180.0, 180.0, 180.0, 18e4, 1.0, 9.0), table)
    assert [each.measured for each in found] == pytest.approx([180] * 4, rel=1e-3)
    (note,) = unit_notes(wired(stream("kohm", "V", "Mohm", "", "V", "V"), table)[0], table)
    assert note.startswith("c, d are not said to be in kohm or ohm, so their resistance") and note.endswith("in brackets: c[kohm]")
    (note,) = unit_notes(wired(stream(*[""] * 6), table)[0], table)
    assert note.startswith("a, b, c, d and 2 more are not said")


@pytest.mark.parametrize("command", ["replay", "contact"])
def test_headings_tell_the_unit_in_brackets(tmp_path: Path, table: Path, capsys: pytest.CaptureFixture[str], command: str) -> None:
    rows = still(stream("", "", ""), 180.0, 9000.0, 150.0).values
    for heads, noted in (("ch0_kohm,ch1_kohm,ch2_kohm", True), ("ch0[kohm],ch1 (kohm),ch2 [kOhm]", False)):
        lines = "".join(f"{k / 50:.2f},{','.join(f'{each:.4f}' for each in row)}\n" for k, row in enumerate(rows.tolist()))
        (tmp_path / "a.csv").write_text(f"time_s,{heads}\n{lines}")
        assert main([command, str(tmp_path / "a.csv"), "--wiring", str(table), "-o", str(tmp_path / "out")]) == 0
        err = capsys.readouterr().err
        assert ("C1, S1, C9 are not said to be in kohm or ohm" in err) == noted
        assert ("S1 reads 9000 kohm at rest" in err) != noted


def test_a_skin_document_in_place_of_the_table(tmp_path: Path) -> None:
    V, F = np.array([[0.0, 0, 0], [90, 0, 0], [90, 90, 0], [0, 90, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    sensor = Sensor("C5", "P1", ContactSpiral(n=2, x=1.7, b=1.5, l=3, s=15), 10.0, 30.0, 0.0, 5)
    piece = Piece("P1", np.arange(2), np.arange(4), F, V[:, :2])
    skin = Skin(Mesh(V, F, "plate"), Source("plate.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), np.int64), (piece,), (sensor,))
    save_skin(skin, tmp_path / "a.skin")
    assert [(w.sensor, w.channel) for w in load_wiring(tmp_path / "a.skin")] == [("C5", 5)] * 2
    save_skin(replace(skin, sensors=()), tmp_path / "bare.skin")
    with pytest.raises(InputError, match=r"bare.skin has no sensors"):
        load_wiring(tmp_path / "bare.skin")


def test_record_keeps_the_names_and_replay_takes_them(tmp_path: Path, table: Path, capsys: pytest.CaptureFixture[str]) -> None:
    of = stream("kohm", "kohm", "kohm", "kohm")
    with PtyServer(of, iter(still(of, 180.0, 9000.0, 150.0, 1.0))) as device:
        words = ["record", str(device.path), "--wiring", str(table), "-o", str(tmp_path / "a.frames"), "--seconds", "3", "--json"]
        assert main(words) == 0
    result = json.loads(capsys.readouterr().out)
    kept = read_log(tmp_path / "a.frames").recording.stream
    assert list(kept.names) == result["channels"] == ["C1", "S1", "C9", "ch4"] and kept.channels[2].board_input == 2
    assert [round(each["measured_kohm"], -1) for each in result["at_rest"]] == [180, 9000, 150]
    assert any("S1 reads" in note and "broken" in note for note in result["notes"])
    assert result["wiring_notes"] == ["skin has 4 channels and the wiring 3 sensors: nothing is wired to ch4"]


def test_replay_names_the_channels_of_any_log(tmp_path: Path, table: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_log(still(stream("kohm", "kohm", "kohm"), 180.0, 9000.0, 150.0), tmp_path / "a.csv")
    assert main(["replay", str(tmp_path / "a.csv"), "--wiring", str(table), "-o", str(tmp_path / "out")]) == 0
    out = capsys.readouterr()
    assert "S1 reads 9000 kohm at rest" in out.err
    assert any(line.split()[:2] == ["S1", "9000"] and line.endswith("OUTSIDE") for line in out.out.splitlines())
    assert (tmp_path / "out" / "replay.csv").read_text().startswith("time_s,C1,S1,C9\n")
    write_log(still(stream("kohm"), 180.0), tmp_path / "one.csv")
    assert main(["replay", str(tmp_path / "one.csv"), "--wiring", str(table)]) == 1
    assert "but by the wiring S1 is channel 1" in capsys.readouterr().err


def test_replay_reckons_resistances_from_voltages(tmp_path: Path, table: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_log(still(stream("V", "V", "V"), 2.0, 2.4, 2.2), tmp_path / "a.csv")
    words = ["replay", str(tmp_path / "a.csv"), "--wiring", str(table), "--json", "--bridge", "5", "100"]
    assert main(words) == 0
    result = json.loads(capsys.readouterr().out)
    assert {each["sensor"]: each["measured_kohm"] for each in result["at_rest"]} == result["r0_kohm"]


def test_contact_names_sensors(tmp_path: Path, table: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_log(still(stream("kohm", "kohm", "kohm"), 180.0, 9000.0, 150.0), tmp_path / "a.csv")
    assert main(["contact", str(tmp_path / "a.csv"), "--wiring", str(table), "-o", str(tmp_path / "out")]) == 0
    out = capsys.readouterr()
    assert "a.csv: S1 reads 9000 kohm at rest" in out.err and "  C9 " in out.out


@pytest.mark.parametrize("unit", ["kohm", ""])
def test_contact_names_the_sensors_of_a_port(tmp_path: Path, table: Path, capsys: pytest.CaptureFixture[str], unit: str) -> None:
    of, words = stream(unit, unit, unit), ["--wiring", str(table), "--seconds", "5", "--json", "-o", str(tmp_path / "out")]
    with PtyServer(of, iter(still(of, 180.0, 9000.0, 150.0))) as device:
        assert main(["contact", str(device.path), *words]) == 0
    result = json.loads(capsys.readouterr().out)
    (found,) = result["objects"].values()
    assert [each["channel"] for each in found["table"]] == ["C1", "S1", "C9"]
    assert any("S1 reads 9000 kohm" in note for note in result["notes"]) == bool(unit)
    assert any("are not said to be in kohm" in note for note in result["notes"]) != bool(unit)


def test_contact_refuses_a_port_of_another_skin(tmp_path: Path, table: Path, capsys: pytest.CaptureFixture[str]) -> None:
    of = stream("kohm")
    with PtyServer(of, iter(still(of, 180.0))) as device:
        assert main(["contact", str(device.path), "--wiring", str(table), "--seconds", "2", "-o", str(tmp_path / "out")]) == 1
    assert "but by the wiring S1 is channel 1" in capsys.readouterr().err
    assert main(["contact", "simulator", "--wiring", str(table), "-o", str(tmp_path / "out")]) == 2
    assert "--wiring is for logs and ports" in capsys.readouterr().err and not (tmp_path / "out").exists()
