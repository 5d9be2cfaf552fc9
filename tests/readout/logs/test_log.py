"""Logs: every format gives back what was put in, bit for bit, whatever the file is called; and a log becomes a table."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs.log import read_log, read_log_table, table_of, write_log
from skinfab.readout.table import read_table

KINDS = {"a.csv": "CSV", "a.mcap": "MCAP", "a.bag": "ROS 1 bag", "bag": "ROS 2 bag", "a.frames": "recording"}


def recording(n: int = 500, c: int = 3, *, simulated: bool = True) -> Recording:
    rng = np.random.default_rng(0)
    channels = tuple(Channel(f"S{k}", "V", "strain", 0.0, 3.3, f"S{k}", 1 + k // 16, k % 16) for k in range(c))
    values = rng.uniform(0.5, 3.0, (n, c))
    valid = rng.random((n, c)) > 0.1
    sequence = np.cumsum(rng.integers(1, 3, n)) + 2**40
    host = 1.7e9 + np.arange(n) / 97
    return Recording(Stream("finger", channels, 97.3, simulated), np.arange(n) / 97.3, host, sequence, values, valid, values > 2.9)


def same(a: Recording, b: Recording) -> bool:
    fields = ("device_time", "host_time", "sequence", "values", "valid", "saturated")
    equal = all(
        getattr(a, name).dtype == getattr(b, name).dtype and getattr(a, name).tobytes() == getattr(b, name).tobytes() for name in fields
    )
    return equal and a.stream == b.stream


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize(("n", "c"), [(500, 3), (1, 1), (0, 2), (3, 0), (2000, 32)])
def test_there_and_back(tmp_path: Path, name: str, n: int, c: int) -> None:
    if not c and name == "a.frames":
        pytest.skip("a live recording always has a channel")
    made = recording(n, c)
    write_log(made, tmp_path / name)
    log = read_log(tmp_path / name)
    assert same(log.recording, made)
    assert (log.kind, log.file, log.notes) == (KINDS[name], name, ())
    assert [p.name for p in tmp_path.iterdir()] == [name]


@st.composite
def recordings(draw: st.DrawFn) -> Recording:
    n, c = draw(st.integers(0, 5)), draw(st.integers(0, 3))
    names = draw(st.lists(st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=6), min_size=c, max_size=c, unique=True))
    number = st.floats(width=64, allow_nan=True)
    finite = st.floats(allow_nan=False, allow_infinity=False)
    low = draw(finite)
    channels = tuple(Channel(name, draw(st.sampled_from(["", "V", "kΩ"])), low=low) for name in names)
    stream = Stream(draw(st.text(st.characters(exclude_categories=["Cs"]), max_size=5)), channels, abs(draw(finite)), draw(st.booleans()))
    return Recording(
        stream,
        draw(arrays(float, n, elements=number)),
        draw(arrays(float, n, elements=number)),
        draw(arrays(np.int64, n)),
        draw(arrays(np.uint64, (n, c))).view(float),  # every pattern of bits, so every kind of NaN
        draw(arrays(bool, (n, c))),
        draw(arrays(bool, (n, c))),
    )


@pytest.mark.parametrize("name", [name for name in KINDS if name != "a.frames"])
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(made=recordings())
def test_whatever_it_holds(tmp_path: Path, name: str, made: Recording) -> None:
    import shutil

    path = tmp_path / name
    if path.is_dir():
        shutil.rmtree(path)
    write_log(made, path)
    assert same(read_log(path).recording, made)


def test_the_content_counts_not_the_name(tmp_path: Path) -> None:
    for name, kind in KINDS.items():
        write_log(recording(20), tmp_path / name)
        moved = (tmp_path / name).rename(tmp_path / f"{name.replace('.', '_')}.txt")
        assert read_log(moved).kind == kind


def test_an_unknown_suffix_is_refused_and_nothing_is_overwritten(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"\.xlsx is no log"):
        write_log(recording(2), tmp_path / "a.xlsx")
    write_log(recording(2), tmp_path / "bag")
    with pytest.raises(InputError, match="never overwritten"):
        write_log(recording(2), tmp_path / "bag")
    with pytest.raises(InputError, match="folder does not exist"):
        write_log(recording(2), tmp_path / "none" / "bag")


def test_a_folder_of_logs_is_no_bag(tmp_path: Path) -> None:
    """Two recordings of one board, read one behind the other, would pass for one log."""
    made = Recording.of_values(Stream("one", (Channel("U"),), 100.0), np.arange(9.0)[:, None], device_time=np.arange(9) / 100)
    folder = tmp_path / "day"
    folder.mkdir()
    (folder / "notes.txt").write_text("x")
    (folder / "a.csv").write_text("time,U\n0,1\n")
    with pytest.raises(InputError, match=r"no ROS 2 bag, as it has no .mcap or .db3 file in it; give one log, such as .*a\.csv"):
        read_log(folder)
    for name in ("trial.mcap", "other.mcap"):
        write_log(made, folder / name)
    with pytest.raises(InputError, match=r"has 2 logs in it, other.mcap and trial.mcap among them, which are not the parts of one bag"):
        read_log(folder)
    (folder / "other.mcap").rename(folder / "trial_1.mcap")
    assert read_log(folder).notes == ("day has no metadata.yaml: trial.mcap, trial_1.mcap were read as the parts of one bag",)


def test_a_recording_as_a_table(tmp_path: Path) -> None:
    made = recording(400)
    write_log(made, tmp_path / "a.mcap")
    log = read_log(tmp_path / "a.mcap")
    table = table_of(log)
    assert table.simulated and table.sha256 == log.sha256
    reading = table.column("S1")
    assert np.array_equal(np.isnan(reading), ~made.valid[:, 1] | made.saturated[:, 1])
    assert np.array_equal(reading[~np.isnan(reading)], made.values[:, 1][~np.isnan(reading)])
    assert np.array_equal(table.time, made.device_time - made.device_time[0])


def test_angles_in_rad_become_degrees(tmp_path: Path) -> None:
    made = Recording.of_values(Stream("a", (Channel("pip", "rad"),)), np.array([[0.0], [np.pi / 2], [1e308]]), device_time=np.arange(3.0))
    write_log(made, tmp_path / "a.csv")
    assert table_of(read_log(tmp_path / "a.csv")).column("pip").tolist() == [0, 90, np.inf]


def test_a_log_of_no_frames_is_no_table(tmp_path: Path) -> None:
    write_log(recording(0), tmp_path / "a.csv")
    with pytest.raises(InputError, match="no frame with a time"):
        read_log_table(tmp_path / "a.csv")


def test_a_csv_of_others(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("Time (ms),Channel 0 (pF),R_KNEE_FLX\n0,100.5,10\n10,,20\n20,101.5,30\n")
    log = read_log(path)
    assert [(c.name, c.unit) for c in log.recording.stream.channels] == [("Channel 0 (pF)", "pF"), ("R_KNEE_FLX", "")]
    assert log.recording.stream.rate_hz == 100 and not log.recording.stream.simulated
    assert log.recording.valid[:, 0].tolist() == [True, False, True]
    table, notes = read_log_table(path)
    assert notes == () and table.column("R_KNEE_FLX").tolist() == [10, 20, 30]


def test_our_csv_is_a_table_for_others_too(tmp_path: Path) -> None:
    write_log(recording(50), tmp_path / "a.csv")
    table = read_table(tmp_path / "a.csv")
    assert table.simulated and {"host_time", "sequence", "S0", "S1", "S2"} <= set(table.columns)
    assert np.allclose(table.time, np.arange(50) / 97.3)
