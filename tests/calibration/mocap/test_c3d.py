"""C3D: what ezc3d wrote comes back in mm, gaps of every kind are gaps, and damaged files end in one line."""

import resource
import signal
import subprocess
from pathlib import Path

import ezc3d
import numpy as np
import pytest
from captures import positions, write_c3d

from calibration.mocap import c3d_process
from calibration.mocap.markers import read_markers
from skinfab.errors import InputError

REAL = Path(__file__).resolve().parents[4] / "shared/data/mocap_c3d"


@pytest.mark.parametrize(("unit", "scale"), [("mm", 1.0), ("m", 1e-3), ("cm", 0.1)])
def test_positions_in_mm(tmp_path: Path, unit: str, scale: float) -> None:
    made = positions()
    write_c3d(tmp_path / "a.c3d", made, unit=unit, scale=scale)
    read = read_markers(tmp_path / "a.c3d")
    assert (read.rate_hz, list(read.positions), read.notes) == (200.0, ["MCP", "PIP", "DIP"], ())
    assert np.allclose(read.time, np.arange(200) / 200)
    for name, at in made.items():
        assert np.allclose(read.marker(name), at, rtol=1e-6)  # float32 in the file


@pytest.mark.parametrize("missing", [np.nan, 0.0, -16512.0])
def test_a_gap_is_a_gap(tmp_path: Path, missing: float) -> None:
    made = positions()
    made["PIP"][50:60] = missing
    made["DIP"][0] = missing
    write_c3d(tmp_path / "a.c3d", made)
    read = read_markers(tmp_path / "a.c3d")
    assert np.flatnonzero(np.isnan(read.marker("PIP")).any(axis=1)).tolist() == list(range(50, 60))
    assert np.flatnonzero(np.isnan(read.marker("DIP")).any(axis=1)).tolist() == [0]
    assert np.isfinite(read.marker("MCP")).all()


def test_with_and_without_analog_channels(tmp_path: Path) -> None:
    write_c3d(tmp_path / "with.c3d", positions())
    file = ezc3d.c3d(str(tmp_path / "with.c3d"))
    assert not file["parameters"]["ANALOG"]["LABELS"]["value"]
    # The group taken out of the file itself, by another name that nobody asks for.
    data = (tmp_path / "with.c3d").read_bytes()
    assert data.count(b"ANALOG") == 1
    (tmp_path / "without.c3d").write_bytes(data.replace(b"ANALOG", b"UNUSED"))
    read = read_markers(tmp_path / "without.c3d")
    assert np.allclose(read.marker("MCP"), read_markers(tmp_path / "with.c3d").marker("MCP"))
    analog = ezc3d.c3d(str(tmp_path / "with.c3d"))
    analog["parameters"]["ANALOG"]["RATE"]["value"] = [400.0]
    analog["parameters"]["ANALOG"]["LABELS"]["value"] = ("force",)
    analog["data"]["analogs"] = np.ones((1, 1, 400))
    analog.write(str(tmp_path / "analog.c3d"))
    assert np.allclose(read_markers(tmp_path / "analog.c3d").marker("DIP"), read.marker("DIP"))


def test_a_file_without_a_unit_is_taken_for_mm_and_that_is_said(tmp_path: Path) -> None:
    write_c3d(tmp_path / "a.c3d", positions(), unit="")
    assert any("no unit" in note for note in read_markers(tmp_path / "a.c3d").notes)
    write_c3d(tmp_path / "b.c3d", positions(), unit="ell")
    with pytest.raises(InputError, match="'ell'"):
        read_markers(tmp_path / "b.c3d")


def test_a_file_that_was_cut_off_gives_its_whole_frames(tmp_path: Path) -> None:
    made = positions()
    write_c3d(tmp_path / "a.c3d", made)
    data = (tmp_path / "a.c3d").read_bytes()
    header = 512 * (int.from_bytes(data[16:18], "little") - 1)
    (tmp_path / "a.c3d").write_bytes(data[: header + 100 * 3 * 16 + 7])
    assert ezc3d.c3d(str(tmp_path / "a.c3d"))["data"]["points"].shape[2] == 100  # the library says nothing of it
    read = read_markers(tmp_path / "a.c3d")
    assert len(read.time) == 100 and any("100 of 200 frames are whole" in note for note in read.notes)
    assert np.allclose(read.marker("DIP"), made["DIP"][:100], rtol=1e-6)
    (tmp_path / "a.c3d").write_bytes(data[: header + 7])
    with pytest.raises(InputError, match=r"no C3D file that can be read|before its first frame"):
        read_markers(tmp_path / "a.c3d")


def test_damaged_files_crash_nothing(tmp_path: Path) -> None:
    """Of damaged headers the library itself crashes on a few: it runs in a process of its own."""
    write_c3d(tmp_path / "a.c3d", positions(20))
    data, rng = (tmp_path / "a.c3d").read_bytes(), np.random.default_rng(0)
    lines = []
    for k in range(12):
        broken = bytearray(data if k % 2 else data[: int(rng.integers(2, len(data)))])
        for at in rng.integers(2, min(len(broken), 1500), 6):
            broken[at] = int(rng.integers(256))
        (tmp_path / "x.c3d").write_bytes(broken)
        try:
            read_markers(tmp_path / "x.c3d")
        except InputError as fault:
            lines.append(str(fault))
    assert lines and not any("\n" in line for line in lines)


@pytest.mark.parametrize("name", ["sample_probing_acromion_R.c3d", "walkingOptiTrack.c3d"])
def test_real_captures(name: str) -> None:
    if not (REAL / name).exists():
        pytest.skip(f"{REAL / name} is not here")
    read = read_markers(REAL / name)
    peer = ezc3d.c3d(str(REAL / name))
    labels = peer["parameters"]["POINT"]["LABELS"]["value"]
    assert list(read.positions) == labels and read.notes == ()
    scale = 1000 if peer["parameters"]["POINT"]["UNITS"]["value"] == ["m"] else 1
    gaps = 0
    for k, label in enumerate(labels):
        theirs = peer["data"]["points"][:3, k].T * scale
        seen = np.isfinite(read.positions[label]).all(axis=1)
        gaps += int(np.count_nonzero(~seen))
        assert np.allclose(read.positions[label][seen], theirs[seen])
    assert gaps == {"sample_probing_acromion_R.c3d": 2, "walkingOptiTrack.c3d": 2996}[name]


def test_a_calibration_py_of_the_users_does_no_harm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_c3d(tmp_path / "a.c3d", positions(10))
    (tmp_path / "calibration.py").write_text("raise SystemExit('this is the user own script')\n")
    monkeypatch.chdir(tmp_path)
    assert len(read_markers("a.c3d").time) == 10


def test_parameters_cut_off_are_refused_before_the_library_reads_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It would do so for ever: found by a search."""
    write_c3d(tmp_path / "a.c3d", positions(5))
    (tmp_path / "a.c3d").write_bytes((tmp_path / "a.c3d").read_bytes()[:799])
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: pytest.fail("the library was asked"))
    with pytest.raises(InputError, match="its parameters are cut off"):
        read_markers(tmp_path / "a.c3d")


@pytest.mark.parametrize(
    ("code", "says"), [(signal.SIGXCPU, "takes longer than a file of its size"), (signal.SIGSEGV, "library crashed on it")]
)
def test_a_process_that_was_ended_says_why(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int, says: str) -> None:
    write_c3d(tmp_path / "a.c3d", positions(5))
    monkeypatch.setattr(subprocess, "run", lambda command, **_: subprocess.CompletedProcess(command, -code, b"", b""))
    with pytest.raises(InputError, match=says):
        read_markers(tmp_path / "a.c3d")


def test_memory_and_time_are_by_the_files_size(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def claim(_: str) -> dict[str, object]:
        raise MemoryError

    (tmp_path / "a.c3d").write_bytes(bytes(5_000_000))
    limits: dict[int, tuple[int, int]] = {}
    monkeypatch.setattr(resource, "setrlimit", limits.__setitem__)
    monkeypatch.setattr(c3d_process, "contents", claim)
    assert c3d_process.main(str(tmp_path / "a.c3d")) == 1
    assert "claims more than a file of its size holds" in capsys.readouterr().err
    most = (1 << 30) + 40 * 5_000_000
    assert limits == {resource.RLIMIT_AS: (most, most), resource.RLIMIT_CPU: (15, 15), resource.RLIMIT_CORE: (0, 0)}
