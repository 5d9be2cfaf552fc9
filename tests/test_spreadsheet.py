"""Tables of spreadsheets are read in their encodings; what is no text is refused in one sentence."""

from pathlib import Path

import pytest

from skinfab.errors import InputError
from skinfab.spreadsheet import read_csv_lines

TEXT = "Länge;r\n1;2\n"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_encodings(encoding: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(TEXT, encoding=encoding)
    assert read_csv_lines(tmp_path / "a.csv", max_bytes=999, wanted="x") == (["Länge;r", "1;2"], ";")


@pytest.mark.parametrize(("first", "mark"), [("sep=;", ";"), ('"sep=;"', ";"), ("SEP=,", ","), ("# a, b, c", ";")])
def test_lines_before_the_headings(first: str, mark: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(f"{first}\na{mark}b\n1{mark}2\n")
    lines, delimiter = read_csv_lines(tmp_path / "a.csv", max_bytes=999, wanted="x")
    assert delimiter == mark and lines[1:] == [f"a{mark}b", f"1{mark}2"] and len(lines) == 3


@pytest.mark.parametrize(
    ("data", "says"), [(bytes(range(256)), "is not a text file"), (b"\xff\xfe\x00", "is not a text file"), (b"a" * 1000, "too large")]
)
def test_no_text(data: bytes, says: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_bytes(data)
    with pytest.raises(InputError, match=f"{says}.*give a log"):
        read_csv_lines(tmp_path / "a.csv", max_bytes=999, wanted="a log")
