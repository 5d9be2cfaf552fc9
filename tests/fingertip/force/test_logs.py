"""Logs of a six-axis sensor: read as they were written, and what is missing is told."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.fingertip.force.labels import require_labels, with_labels
from skinfab.fingertip.force.logs import WrenchLog, read_wrench, write_wrench
from skinfab.fingertip.force.simulator import MATERIALS, slide
from skinfab.fingertip.force.wrench import force_stream, require_nmm
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs.log import write_log


@given(st.lists(st.floats(-1e3, 1e3), min_size=12, max_size=12), st.booleans())
@settings(max_examples=20, deadline=None)
def test_reading_gives_back_what_was_written(tmp_path_factory: pytest.TempPathFactory, values: list[float], simulated: bool) -> None:
    path = tmp_path_factory.mktemp("log") / "a.csv"
    table = np.array(values).reshape(2, 6)
    made = WrenchLog("a.csv", np.array([0, 0.005]), table[:, :3], table[:, 3:], "towel", "3", {"pose": np.array([0.0, 1.0])}, simulated)
    write_wrench(made, path)
    read = read_wrench(path)
    assert read.force == pytest.approx(made.force, rel=1e-6) and read.moment == pytest.approx(made.moment, rel=1e-6)
    assert (read.label, read.group, read.simulated) == ("towel", "3", simulated) and read.others["pose"].tolist() == [0, 1]


def test_a_recording_of_the_readout_is_read_too(tmp_path: Path) -> None:
    log = slide(MATERIALS["towel"], seed=1)
    values = np.column_stack([log.force, log.moment])
    made = Recording.of_values(force_stream("tip", 200.0, simulated=True), values, device_time=log.time)
    write_log(made, tmp_path / "a.mcap")
    read = read_wrench(tmp_path / "a.mcap")
    assert read.simulated and read.force == pytest.approx(log.force) and not read.label


def test_rows_without_a_component_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time,Fx,Fy,Fz,Mx,My,Mz\n0,1,1,1,1,1,1\n0.1,1,,1,1,1,1\n0.2,2,2,2,2,2,2\n")
    read = read_wrench(tmp_path / "a.csv")
    assert read.force[:, 0].tolist() == [1, 2] and read.time.tolist() == [0, 0.2] and "1 of 3 rows" in read.notes[0]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("time,Fx,Fy,Fz,Mx,My\n0,1,1,1,1,1\n", "no column Mz; call the forces Fx, Fy, Fz"),
        ("time,Fx,Fy,Fz,Mx,My,Mz\n0,1,,1,1,1,1\n0.1,,1,1,1,1,1\n", "no row in which all"),
    ],
)
def test_what_is_no_log_of_the_sensor_is_refused(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(InputError, match=says):
        read_wrench(tmp_path / "a.csv")


def test_declared_units_are_converted(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("time,Fx (mN),Fy (N),Fz,Mx [N m],My (N.mm),Mz (mNm)\n0,1000,2,3,0.004,5,6\n")
    read = read_wrench(tmp_path / "a.csv")
    assert read.force.tolist() == [[1, 2, 3]] and read.moment.tolist() == [[4, 5, 6]] and read.units_said
    (tmp_path / "b.csv").write_text("time,Fx,Fy,Fz,Mx (lbf in),My,Mz\n0,1,1,1,1,1,1\n")
    with pytest.raises(InputError, match=r"Mx \(lbf in\) is in lbf in, which is not known"):
        read_wrench(tmp_path / "b.csv")


def test_a_ros_wrench_is_read(tmp_path: Path) -> None:
    parts = [(f".{vector}.{axis}", unit) for vector, unit in (("force", "N"), ("torque", "N m")) for axis in "xyz"]
    one = tuple(Channel("ft" + name, unit) for name, unit in parts)
    values = np.arange(12.0).reshape(2, 6)
    write_log(Recording.of_values(Stream("bag", one, 100.0), values, device_time=np.arange(2) / 100), tmp_path / "a.mcap")
    read = read_wrench(tmp_path / "a.mcap")
    assert read.force == pytest.approx(values[:, :3]) and read.moment == pytest.approx(1000 * values[:, 3:]) and not read.others
    both = (*one, *(Channel("other" + name, unit) for name, unit in parts))
    made = Recording.of_values(Stream("bag", both, 100.0), np.ones((2, 12)), device_time=np.arange(2) / 100)
    write_log(made, tmp_path / "b.mcap")
    with pytest.raises(InputError, match=r"ft.force.x and other.force.x are one component of two sensors"):
        read_wrench(tmp_path / "b.mcap")


def test_moments_in_n_m_that_nobody_declared_are_refused() -> None:
    log = slide(MATERIALS["towel"], seed=1)
    require_nmm(log.force, log.moment, reach_mm=20.0, least_force=0.3, where="a.csv")
    with pytest.raises(InputError, match="the moments are in N m"):
        require_nmm(log.force, log.moment / 1000, reach_mm=20.0, least_force=0.3, where="a.csv")
    require_nmm(np.zeros((5, 3)), np.zeros((5, 3)), reach_mm=20.0, least_force=0.3, where="a.csv")  # nothing touched: nothing known


LOG = WrenchLog("a.csv", np.zeros(1), np.zeros((1, 3)), np.zeros((1, 3)))


def test_labels_of_a_table_stand_above_those_of_the_log(tmp_path: Path) -> None:
    (tmp_path / "labels.csv").write_text("# simulated: true\nlog,label,group\na.csv,towel,T1\n")
    (labelled,) = with_labels([replace(LOG, label="paper")], tmp_path / "labels.csv")
    assert (labelled.label, labelled.group) == ("towel", "T1")
    require_labels([labelled])


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("log,label\na.csv,towel\n", "headings log,label,group"),
        ("log,label,group\nb.csv,towel,1\n", "no row for a.csv"),
        ("log,label,group\na.csv,towel,1\na.csv,paper,1\n", "two rows for 'a.csv'"),
    ],
)
def test_tables_of_labels_that_are_none(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "labels.csv").write_text(text)
    with pytest.raises(InputError, match=says):
        with_labels([LOG], tmp_path / "labels.csv")


def test_logs_without_labels_are_refused() -> None:
    with pytest.raises(InputError, match="does not say what it was taken of"):
        require_labels([LOG])
    with pytest.raises(InputError, match="must not be both learned from and judged on"):
        require_labels([replace(LOG, label="towel")])
