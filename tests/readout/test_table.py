"""Logs of many hands are read: separators, decimal commas, dates, units, holes; what cannot be read is named."""

from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.readout.table import read_table


def written(tmp_path: Path, text: str, *, encoding: str = "utf-8") -> Path:
    path = tmp_path / "log.csv"
    path.write_text(text, encoding=encoding)
    return path


@pytest.mark.parametrize(
    ("text", "time"),
    [
        ("time,U\n1.5,2\n1.6,\n1.7,4\n", [0, 0.1, 0.2]),
        ("Time (ms),U\n1500,2\n1600,nan\n1700,4\n", [0, 0.1, 0.2]),
        ("U\ttime_us\n2\t0\nNA\t100000\n4\t200000\n", [0, 0.1, 0.2]),
        ("Zeit;U\n0,0;2,0\n0,1;\n0,2;4,0\n", [0, 0.1, 0.2]),
        ("Zeit\tU\n0,0\t2,0\n0,1\t\n0,2\t4,0\n", [0, 0.1, 0.2]),
        ("Time,U\n2026-01-31 12:00:00.000+00:00,2\n2026-01-31 12:00:00.100+00:00,\n2026-01-31 12:00:00.200+00:00,4\n", [0, 0.1, 0.2]),
        ("# made by: hand\n\ntime,U\n\n0,2\n0.1,-\n0.2,4\n", [0, 0.1, 0.2]),
    ],
)
def test_shapes_of_logs(text: str, time: list[float], tmp_path: Path) -> None:
    table = read_table(written(tmp_path, text))
    np.testing.assert_allclose(table.time, time, atol=1e-9)
    np.testing.assert_array_equal(table.column("U"), [2, np.nan, 4])


def test_remarks_and_a_byte_order_mark(tmp_path: Path) -> None:
    table = read_table(written(tmp_path, "# simulated: true\n# rate: 100\ntime,U\n0,1\n", encoding="utf-8-sig"))
    assert table.simulated and table.remarks["rate"] == "100" and len(table.sha256) == 64
    assert not read_table(written(tmp_path, "time,U\n0,1\n")).simulated


def test_a_last_line_cut_off_is_left_out_and_said(tmp_path: Path) -> None:
    table = read_table(written(tmp_path, "time,U,V\n0,1,1\n0.1,2,2\n0.2,3"))
    assert table.column("U").tolist() == [1, 2] and table.notes == ("log.csv: the last line is cut off and was left out",)
    assert not read_table(written(tmp_path, "time,U,V\n0,1,1\n")).notes


def test_a_column_of_words_is_no_fault_until_it_is_asked_for(tmp_path: Path) -> None:
    table = read_table(written(tmp_path, "time,U,task\n0,1,flex\n0.1,2,flex\n"))
    with pytest.raises(InputError, match="'task' holds no number"):
        table.column("task")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "does not begin with a line of headings"),
        ("0,1\n1,2\n", "does not begin with a line of headings"),
        ("time,U\n", "headings and no rows"),
        ("a,b\n0,1\n", "no column of times among 'a', 'b'"),
        ("time,U,U\n0,1,2\n", "two columns are called 'U'"),
        ("time,U\n0,1\n0.1\n0.2,3\n", "line 3: 1 cells under 2 headings"),
        ("time,U\n0,1\n0.1,x\n", r"row 2 \(line 3 or so\): 'x' is no number"),
        ("time,U\n0,1\n,2\n", "row 2: the time is missing"),
        ("time,U\nnoon,1\n", "'noon' is no time"),
        ("time,U\n2026-01-31 12:00:00,1\n2026-01-31 12:00:01+00:00,1\n", "let all or none do so"),
        ('time,U\n0,"1\n', "is not a CSV file"),
        ('time,U\n0,"1,5"\n1,"2,5"\n', r"column 'U', row 1 \(line 2 or so\): '1,5' has a decimal comma, and commas part the columns"),
        ('time,U\n"0,0",1\n"0,1",2\n', r"column 'time', row 1 .*'0,0' has a decimal comma"),
        ("time,U\n0,0,1,5\n0,1,2,5\n", r"line 2: 4 cells under 2 headings; if these are decimal commas"),
    ],
)
def test_what_cannot_be_read(text: str, says: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=says):
        read_table(written(tmp_path, text))


def test_no_text_and_no_file(tmp_path: Path) -> None:
    (tmp_path / "b.csv").write_bytes(bytes(range(256)))
    with pytest.raises(InputError, match="is not a text file"):
        read_table(tmp_path / "b.csv")
    with pytest.raises(InputError, match="No such file"):
        read_table(tmp_path / "none.csv")


def test_a_column_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no column 'V'; it has 'U'"):
        read_table(written(tmp_path, "time,U\n0,1\n")).column("V")
