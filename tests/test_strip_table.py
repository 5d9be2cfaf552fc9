"""Tables of strips as people and spreadsheets save them."""

from __future__ import annotations

from pathlib import Path

import pytest

from skinfab.errors import InputError
from skinfab.strip_table import read_strips


def test_reading_a_table(tmp_path: Path) -> None:
    table = tmp_path / "strips.csv"
    table.write_text("\ufeffsensor,r_kohm,length_mm\r\nL40-1,55.5,40\r\nL40-2,,40\r\nL160-1, 210 ,160\r\n", encoding="utf-8")
    strips = read_strips(table)
    assert strips.length_mm.tolist() == [40, 160] and strips.r_kohm.tolist() == [55.5, 210] and strips.unmeasured == ("line 3",)
    assert strips.names == ("L40-1 (line 2)", "L160-1 (line 4)")


@pytest.mark.parametrize(
    "text",
    [
        "sensor;length_mm;r_kohm\r\nL40-1;40,0;55,5\r\nL160-1;160;210\r\n",
        "\ufeffsensor;length_mm;r_kohm\r\nL40-1;40.0;55,5\r\n;;\r\nL160-1;160;210;;\r\n",
        'sensor,length_mm,r_kohm\n"L40-1","40,0","55,5"\nL160-1,160,210\n',
        "sensor\tLength_mm\tR_kohm\nL40-1\t40\t55,5\nL160-1\t160\t2,1e2\n",
    ],
    ids=["semicolons", "mark", "quoted", "tabs"],
)
def test_tables_from_spreadsheets(text: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(text, encoding="utf-8", newline="")
    strips = read_strips(tmp_path / "a.csv")
    assert strips.length_mm.tolist() == [40, 160] and strips.r_kohm.tolist() == [55.5, 210] and strips.unmeasured == ()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("length_mm,kohm\n40,3\n", "no column 'r_kohm'"),
        ("r_kohm,length_mm,r_kohm\n1,40,3\n", "more than one column 'r_kohm'"),
        ("", "no column 'length_mm'"),
        ("length_mm,r_kohm\n", "has headings but no strips"),
        ("length_mm,r_kohm\n40,\n160,\n", "is not filled in: the column r_kohm is empty for all 2 strips; measure each"),
        ("length_mm,r_kohm\n40,-3\n", "line 2, column r_kohm: r_kohm is '-3'"),
        ("length_mm,r_kohm\n40,inf\n", "line 2, column r_kohm: r_kohm is 'inf'"),
        ("length_mm,r_kohm\n40,55 k\n", "line 2, column r_kohm: r_kohm is '55 k'"),
        ("length_mm,r_kohm\n40,1_0\n", "line 2, column r_kohm: r_kohm is '1_0'"),
        ("length_mm,r_kohm\nforty,3\n", "line 2, column length_mm: length_mm is 'forty'"),
        # Blank lines count, as they do in an editor.
        ("length_mm,r_kohm\n\n40,3\n\n160,broken\n", "line 5, column r_kohm: r_kohm is 'broken'"),
        ("length_mm;r_kohm\n40;1.234,5\n", r"line 2, column r_kohm: r_kohm is '1\.234,5'"),
        ("sensor,length_mm,r_kohm\nL40-1,40,55,5\n", "line 2: 4 values under 3 headings; if that is a decimal comma"),
        ('length_mm,r_kohm\n"40,3\n', "is not a CSV file"),
        ("length_mm;r_kohm\n640;1.382\n40;55\n", "line 2: is '1.382' 1382 with a mark between thousands, or a little over 1"),
        ("length_mm;r_kohm\n40;55,5\n40;55.25\n640;1.382\n", "line 4: is '1.382' 1382"),
    ],
)
def test_tables_that_are_none(text: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(InputError, match=says):
        read_strips(tmp_path / "a.csv")


def test_points_that_cannot_part_thousands_are_decimal(tmp_path: Path) -> None:
    for text in ("length_mm,r_kohm\n40,55.125\n", "length_mm;r_kohm\n40;55.125\n40;55.25\n", "length_mm;r_kohm\n40;0.125\n"):
        (tmp_path / "a.csv").write_text(text)
        assert read_strips(tmp_path / "a.csv").r_kohm[0] in (55.125, 0.125)


def test_a_note_with_an_umlaut_and_excels_first_line(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("sep=;\nlength_mm;r_kohm;Anmerkung\n40;55,5;abgelöst\n", encoding="cp1252")
    assert read_strips(tmp_path / "a.csv").r_kohm.tolist() == [55.5]


def test_no_table(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        read_strips(tmp_path / "none.csv")
    (tmp_path / "large.csv").write_bytes(b"a" * 1_000_001)
    with pytest.raises(InputError, match="too large"):
        read_strips(tmp_path / "large.csv")
