"""Vicon's CSV export: its headings in all their forms, gaps, other sections, and what is wrong by line."""

from pathlib import Path

import numpy as np
import pytest
from captures import positions, vicon_text

from calibration.mocap.markers import read_markers
from skinfab.errors import InputError

DEVICES = "Devices\n1000\n,,Force,,\nFrame,Sub Frame,Fx,Fy,Fz\n,,N,N,N\n1,0,1,2,3\n\n"
MODEL = "\nModel Outputs\n100\n,,Anna:RFinger,,\nFrame,Sub Frame,X,Y,Z\n,,deg,deg,deg\n1,0,10,20,30\n"


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
@pytest.mark.parametrize("residuals", [False, True])
def test_markers(tmp_path: Path, delimiter: str, residuals: bool) -> None:
    made = positions()
    made["PIP"][20:30] = np.nan
    (tmp_path / "a.csv").write_text(vicon_text(made, delimiter=delimiter, residuals=residuals))
    read = read_markers(tmp_path / "a.csv")
    assert (read.rate_hz, list(read.positions), read.notes) == (100.0, ["Anna:MCP", "Anna:PIP", "Anna:DIP"], ())
    for name, at in made.items():
        assert np.allclose(read.marker(name), at, rtol=1e-5, equal_nan=True)
        assert np.array_equal(read.marker(f"Anna:{name}"), read.marker(name), equal_nan=True)


def test_other_sections_units_and_line_ends(tmp_path: Path) -> None:
    text = DEVICES + vicon_text({name: at / 10 for name, at in positions(5).items()}, unit="cm") + MODEL
    (tmp_path / "a.csv").write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    read = read_markers(tmp_path / "a.csv")
    assert len(read.time) == 5 and np.allclose(read.marker("DIP"), positions(5)["DIP"], rtol=1e-5)


def test_a_decimal_comma(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(vicon_text(positions(5), delimiter=";").replace(".", ","))
    assert np.allclose(read_markers(tmp_path / "a.csv").marker("DIP"), positions(5)["DIP"], rtol=1e-5)


def test_a_frame_that_was_left_out_is_a_gap_in_time(tmp_path: Path) -> None:
    lines = vicon_text(positions(50)).splitlines(keepends=True)
    (tmp_path / "a.csv").write_text("".join(lines[:15] + lines[25:]))
    time = read_markers(tmp_path / "a.csv").time
    assert len(time) == 40 and np.isclose(time[10] - time[9], 0.11)


def test_cut_off_within_the_last_line(tmp_path: Path) -> None:
    text = vicon_text(positions(50))
    (tmp_path / "a.csv").write_text(text[: text.rindex(",")])
    read = read_markers(tmp_path / "a.csv")
    assert len(read.time) == 49 and any("cut off within its last line" in note for note in read.notes)


TEXT = vicon_text(positions(5))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no section 'Trajectories'"),
        ("time,angle\n0,1\n", "no section 'Trajectories'"),
        (DEVICES, "no section 'Trajectories'"),
        ("Trajectories\n100\n", "ends within the headings"),
        (vicon_text(positions(5), rate="fast"), "line 2: 'fast' is no rate"),
        (vicon_text(positions(5), rate="0"), "line 2: '0' is no rate"),
        (TEXT.replace("Anna:DIP", "Anna:MCP"), "two markers are called 'Anna:MCP'"),
        (TEXT.replace(",X,Y,Z", ",A,B,C"), "no label stands over"),
        (vicon_text(positions(5), unit="deg"), "'deg'"),
        (TEXT.replace("\n3,0,", "\n3,0,oops"), "frame 3, marker 'Anna:MCP'.*oops"),
        (TEXT.replace("\n3,0,", "\n1,0,"), "do not go up"),
        ("\n".join(TEXT.splitlines()[:5]) + "\n\n", "no frame"),
    ],
)
def test_what_is_wrong_is_said(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(InputError, match=says) as fault:
        read_markers(tmp_path / "a.csv")
    assert "\n" not in str(fault.value)


def test_garbage(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    for k in range(30):
        (tmp_path / "a.csv").write_bytes((b"Trajectories\n100\n" if k % 2 else b"") + rng.bytes(500))
        with pytest.raises(InputError) as fault:
            read_markers(tmp_path / "a.csv")
        assert "\n" not in str(fault.value)
