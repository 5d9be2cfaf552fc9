"""Labels: what is written is read, trials are cut out where they are, and what does not fit is said."""

import contextlib
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.fingertip.nail.labels import Label, read_labels, read_trials, write_labels
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs.log import write_log

STREAM = Stream("nail", tuple(Channel(name, "G", low=-4, high=4) for name in ("Az", "Ay", "Ax")), 1400.0, simulated=True)


@pytest.fixture
def table(tmp_path: Path) -> Path:
    values = np.arange(300.0)[:, None] / 100 + np.array([0.0, 0.1, 0.2])
    values[120, 0], values[130, 1] = np.nan, 9.0
    write_log(Recording.of_values(STREAM, values, device_time=5 + np.arange(300) / 1400), tmp_path / "a.csv")
    labels = [
        Label("a.csv", 0.0, 100 / 1400, "none", "Ann", "1", "train"),
        Label("a.csv", 100 / 1400, 200 / 1400, "pin", "Ann", "2", x_mm=3.0),
    ]
    write_labels(tmp_path / "labels.csv", labels, simulated=True)
    return tmp_path / "labels.csv"


def test_what_is_written_is_read(table: Path) -> None:
    labels, simulated = read_labels(table)
    assert simulated and [each.label for each in labels] == ["none", "pin"]
    assert labels[1].x_mm == 3.0 and math.isnan(labels[1].angle_deg) and labels[0].part == "train" and labels[1].part == ""


def test_trials_are_where_they_are(table: Path) -> None:
    trials, simulated, notes = read_trials(table)
    assert simulated and notes == [] and [len(each.values) for each in trials] == [100, 100]
    second = trials[1]
    assert second.rate_hz == pytest.approx(1400) and second.values[0, :3].tolist() == pytest.approx([1.2, 1.1, 1.0])  # in our order
    assert np.isnan(second.values[:, 3:]).all() and np.isnan(second.values[20, 2])
    assert second.saturated[30].tolist() == [False, True, False, False, False, False]


def test_a_trial_given_twice_counts_once_also_by_a_copy_of_the_log(table: Path) -> None:
    labels, _ = read_labels(table)
    (table.parent / "copy.csv").write_bytes((table.parent / "a.csv").read_bytes())
    write_labels(table, [*labels, labels[0], replace(labels[1], log="copy.csv")], simulated=True)
    trials, _, notes = read_trials(table)
    assert [each.label for each in trials] == labels and notes == ["labels.csv: 2 rows are there twice, and count once"]
    write_labels(table, [*labels, replace(labels[1], log="copy.csv", part="test")], simulated=True)
    with pytest.raises(InputError, match=r"a\.csv and copy\.csv \(the same log\) has .* twice, with part '' and 'test'"):
        read_trials(table)


def test_columns_in_any_order_and_of_any_spreadsheet(tmp_path: Path) -> None:
    (tmp_path / "l.csv").write_text("label;end_s;start_s;log;mine\nedge;2;1;a.csv;x\n")
    (only,), simulated = read_labels(tmp_path / "l.csv")
    assert (only.label, only.start_s, only.end_s, simulated) == ("edge", 1.0, 2.0, False)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("log,start_s,end_s\na,0,1\n", "no column 'label'"),
        ("log,start_s,end_s,label\n", "headings and no rows"),
        ("log,start_s,end_s,label\na,,1,x\n", "line 2: log, start_s, label must all be there"),
        ("log,start_s,end_s,label,part\na,0,1,x,train\na,1,2,x,holdout\n", "line 3: part 'holdout' is neither train nor test"),
        ("log,start_s,end_s,label\na,1,1,x\n", "start must be before the end"),
        ("log,start_s,end_s,label\na,-1,1,x\n", "no time of a log"),
        ("# simulated: true\nlog,start_s,end_s,label\na,0,soon,x\n", "line 3, end_s: 'soon' is no number"),
        ("log,start_s,end_s,label\na,0,inf,x\n", "'inf' is no number"),
        ('log,start_s,end_s,label\n"a,0,1,x\n', "not a CSV file"),
    ],
)
def test_a_table_that_cannot_be_used(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "l.csv").write_text(text)
    with pytest.raises(InputError, match=says):
        read_labels(tmp_path / "l.csv")


def test_a_trial_beyond_the_end(table: Path) -> None:
    table.write_text("log,start_s,end_s,label\na.csv,0.1,0.5,x\n")
    with pytest.raises(InputError, match=r"a\.csv ends at 0\.214 s and a trial of it lasts from 0\.1 to 0\.5 s"):
        read_trials(table)
    table.write_text("log,start_s,end_s,label\ngone.csv,0.1,0.5,x\n")
    with pytest.raises(InputError, match=r"gone\.csv"):
        read_trials(table)


def test_a_log_of_other_channels(table: Path) -> None:
    (table.parent / "b.csv").write_text("time,U\n0,1\n1,2\n")
    table.write_text("log,start_s,end_s,label\nb.csv,0,1,x\n")
    with pytest.raises(InputError, match="none of the channels Ax, Ay"):
        read_trials(table)


@settings(deadline=None, max_examples=60)
@given(st.lists(st.lists(st.sampled_from(["a.csv", "0", "1", "-1", "nan", "inf", "x", "", '"', "1e400", "#"]), max_size=6), max_size=5))
def test_any_table_is_read_or_refused(tmp_path_factory: pytest.TempPathFactory, rows: list[list[str]]) -> None:
    path = tmp_path_factory.mktemp("l") / "l.csv"
    path.write_text("\n".join(["log,start_s,end_s,label,x_mm", *(",".join(row) for row in rows)]))
    labels: list[Label] = []
    with contextlib.suppress(InputError):
        labels, _ = read_labels(path)
    assert all(0 <= each.start_s < each.end_s and each.start_s < math.inf and each.log and each.label for each in labels)


def test_frames_without_a_time_are_none(table: Path) -> None:
    time = 5 + np.arange(300) / 1400
    time[[0, 7]] = np.nan
    write_log(Recording.of_values(STREAM, np.ones((300, 3)), device_time=time, host_time=np.zeros(300)), table.parent / "a.csv")
    trials, _, _ = read_trials(table)
    assert [len(each.values) for each in trials] == [100, 100] and np.flatnonzero(np.isnan(trials[0].values[:, 0])).tolist() == [6]


@pytest.mark.parametrize("counted", [True, False])
def test_lost_frames_keep_their_place(tmp_path: Path, counted: bool) -> None:
    time = np.arange(300) / 1400
    values = np.cos(2 * np.pi * 169 * time)[:, None] * np.ones(3)
    kept = np.random.default_rng(0).uniform(size=300) > 0.1
    kept[[0, 299]] = True
    if counted:
        all_of = Recording.of_values(STREAM, values, device_time=time)
        parts = (all_of.device_time, all_of.host_time, all_of.sequence, all_of.values, all_of.valid, all_of.saturated)
        write_log(Recording(STREAM, *(part[kept] for part in parts)), tmp_path / "a.csv")
    else:  # a plain table: times alone tell it
        rows = [f"{t:.6f},{v[0]:.6f},{v[1]:.6f},{v[2]:.6f}" for t, v in zip(time[kept], values[kept], strict=True)]
        (tmp_path / "a.csv").write_text("time_s,Ax,Ay,Az\n" + "\n".join(rows) + "\n")
    write_labels(tmp_path / "l.csv", [Label("a.csv", 0.0, 0.2, "pin")], simulated=True)
    ((trial,), _, notes) = read_trials(tmp_path / "l.csv")
    assert len(trial.values) == 280 and np.isnan(trial.values[:, 0]).tolist() == (~kept[:280]).tolist()
    assert trial.values[kept[:280], 0] == pytest.approx(values[:280][kept[:280], 0], abs=1e-5)
    assert any("frames are missing" in note for note in notes) == counted


def test_a_trial_in_a_hole_is_told(tmp_path: Path) -> None:
    time = np.concatenate([np.arange(300), np.arange(1400, 1700)]) / 1400
    rows = [f"{t:.6f},1,2,3" for t in time]
    (tmp_path / "a.csv").write_text("time_s,Ax,Ay,Az\n" + "\n".join(rows) + "\n")
    write_labels(tmp_path / "l.csv", [Label("a.csv", 0.4, 0.6, "pin")], simulated=True)
    with pytest.raises(InputError, match=r"has 0 of the 280 readings of its trial from 0.4 to 0.6 s; leave that row out"):
        read_trials(tmp_path / "l.csv")


def test_capitals_of_a_spreadsheet(tmp_path: Path) -> None:
    (tmp_path / "l.csv").write_text("log,start_s,end_s,label,part\na.csv,0,1,None,Test\na.csv,1,2,Edge,TRAIN\n")
    assert [(each.label, each.part) for each in read_labels(tmp_path / "l.csv")[0]] == [("none", "test"), ("Edge", "train")]


def test_without_an_end_a_trial_lasts_as_long_as_its_log(table: Path) -> None:
    table.write_text("log,start_s,end_s,label\na.csv,0.1,,pin\n")
    ((trial,), _, _) = read_trials(table)
    assert len(trial.values) == 160 and trial.label.end_s == pytest.approx(300 / 1400)
    write_labels(table, read_labels(table)[0], simulated=True)
    assert math.isinf(read_labels(table)[0][0].end_s)


def test_a_decimal_comma_behind_semicolons(tmp_path: Path) -> None:
    (tmp_path / "l.csv").write_text("log;start_s;end_s;label;x_mm\na,b.csv;0,365714286;0,7;pin, small;-1,5\n")
    (only,), _ = read_labels(tmp_path / "l.csv")
    assert (only.log, only.start_s, only.end_s, only.label, only.x_mm) == ("a,b.csv", 0.365714286, 0.7, "pin, small", -1.5)


def test_the_same_readings_in_another_file_count_once(tmp_path: Path) -> None:
    """Saved anew as a plain table with fewer decimals, from later on: another file, another start, the same readings."""
    values = np.random.default_rng(0).normal(size=(300, 3))
    values = np.round(values, 6)
    write_log(Recording.of_values(STREAM, values, device_time=np.arange(300) / 1400), tmp_path / "a.csv")
    rows = [f"{k / 1400:.5f},{v[2]:.4f},{v[1]:.4f},{v[0]:.4f}" for k, v in enumerate(values)][40:]
    (tmp_path / "b.csv").write_text("time_s,Ax,Ay,Az\n" + "\n".join(rows) + "\n")
    own, again = Label("a.csv", 100 / 1400, 0.2, "pin"), Label("b.csv", 60 / 1400, 0.2 - 40 / 1400, "pin")
    write_labels(tmp_path / "l.csv", [own, again, Label("a.csv", 0.0, 100 / 1400, "pin")], simulated=True)
    trials, _, notes = read_trials(tmp_path / "l.csv")
    assert [each.label.log for each in trials] == ["a.csv", "a.csv"]
    assert "l.csv: 1 row is there twice, and counts once (the same readings in another file)" in notes
    write_labels(tmp_path / "l.csv", [own, replace(again, part="test")], simulated=True)
    with pytest.raises(InputError, match="have the same readings, with part '' and 'test'; leave one of the rows out"):
        read_trials(tmp_path / "l.csv")
    write_labels(tmp_path / "l.csv", [own, replace(again, start_s=0.0, end_s=0.1)], simulated=True)
    with pytest.raises(InputError, match="of their readings in common, which would judge a model that knows them"):
        read_trials(tmp_path / "l.csv")
