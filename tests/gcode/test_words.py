"""Tokens of any G-code, and one sentence for what is none."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcode.words import LINE_LIMIT, read_commands, read_text
from skinfab.errors import InputError


@pytest.mark.parametrize(
    ("text", "code", "words"),
    [
        ("G02 X1.5 Y-.5 I+2. J0", "G2", {"X": 1.5, "Y": -0.5, "I": 2.0, "J": 0.0}),
        ("n12 g1x1y2e3*97", "G1", {"X": 1.0, "Y": 2.0, "E": 3.0}),
        ("G28 X Y", "G28", {"X": None, "Y": None}),
        ("G28 XY", "G28", {"X": None, "Y": None}),
        ("G1 X1 (a note) Y2", "G1", {"X": 1.0, "Y": 2.0}),
        ("M117 Printing... 50% done!", "M117", {}),
        ("M104 T0 S200", "M104", {"T": 0.0, "S": 200.0}),
        ("M302P1", "M302", {"P": 1.0}),
        ("G38.2 Z-5", "G38.2", {}),
        ("X10 Y5", "X", {"X": 10.0, "Y": 5.0}),
        ("n7 y-.5F300", "X", {"Y": -0.5, "F": 300.0}),
        ("F1000", "F", {"F": 1000.0}),
        ("S500", "F", {"S": 500.0}),
        ("G1 X1e5", "G1", {"X": 1.0, "E": 5.0}),  # as Marlin reads it: E is an axis, never an exponent
    ],
)
def test_tokens(text: str, code: str, words: dict) -> None:
    (command,) = read_commands(text)
    assert (command.code, command.words) == (code, words)


def test_lines_count_over_any_line_end_and_comments_stay() -> None:
    found = list(read_commands("\r\n; pattern C1\rG0 X1 ; go\n%\n\nG0 X2"))
    assert [(c.line, c.code, c.comment) for c in found] == [(2, "", "pattern C1"), (3, "G0", "go"), (6, "G0", "")]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("G0 X1\nG1 XNaN", "line 2: cannot read 'XNaN'"),
        ("G1 X1.2.3", "line 1: cannot read '.3'"),
        ("G1 X--5", "line 1: cannot read '--5'"),
        ("G1 X" + 400 * "9", "line 1: X is not a finite number"),
        ("G1 X1 X2", "line 1: a second X"),
        ("G1 X1 G1 Y2", "line 1: a second G"),
        ("X10 Y10 hello", "line 1: cannot read 'hello'"),
        ("X10 G1", "line 1: a second G"),
        ("P500", "line 1: cannot read 'P500'"),
        ("hello", "line 1: cannot read 'hello'"),
        ("G1 X" + LINE_LIMIT * "1", "line 1 is .* characters long"),
        ("G999999 X1", "line 1: cannot read"),
    ],
)
def test_unreadable_lines_are_named(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        list(read_commands(text))


@given(st.text() | st.text("G0123XYZIJREFMN.-+;() \n", max_size=60))
def test_any_text_gives_commands_or_one_sentence(text: str) -> None:
    try:
        list(read_commands(text))
    except InputError as fault:
        said = str(fault)
        assert "\n" not in said and said.startswith("line ")


def test_files_that_are_no_text(tmp_path: Path) -> None:
    binary = tmp_path / "a.gcode"
    binary.write_bytes(b"G1 X1\n\0\1\2")
    with pytest.raises(InputError, match="binary"):
        read_text(binary)
    with pytest.raises(InputError, match=r"cannot read .*No such file"):
        read_text(tmp_path / "absent.gcode")
    huge = tmp_path / "huge.gcode"
    with huge.open("wb") as out:
        out.truncate(300 * 2**20)  # a hole: takes no disk and is never read
    with pytest.raises(InputError, match="larger than"):
        read_text(huge)


def test_a_folder_names_a_file_to_give_instead(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is a folder; give one G-code file, there is none in it"):
        read_text(tmp_path)
    (tmp_path / "gcode").mkdir()
    for name in ("P2.gcode", "P1.gcode"):
        (tmp_path / "gcode" / name).write_text("")
    for folder in (tmp_path, tmp_path / "gcode"):
        with pytest.raises(InputError, match=r"is a folder; give one G-code file, such as .*/gcode/P1\.gcode"):
            read_text(folder)


def test_old_comments_are_read(tmp_path: Path) -> None:
    (tmp_path / "a.gcode").write_bytes("G1 X1 ; Düse\n".encode("latin-1"))
    (tmp_path / "b.gcode").write_bytes("\ufeffG1 X1 ; Düse\n".encode())
    assert read_text(tmp_path / "a.gcode") == read_text(tmp_path / "b.gcode") == "G1 X1 ; Düse\n"
