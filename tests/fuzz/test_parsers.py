"""Whatever a file holds, its parser gives a result that holds together, or one sentence; `make fuzz` searches for longer."""

import re
from pathlib import Path

import numpy as np
import pytest
import seeds
from hostile import ANYWHERE, NESTED, hostile, mutants
from parsers import PARSERS, Parser, run

from gcode.check import judge
from gcode.parse import parse
from gcode.printer import load_printer
from skinfab.errors import InputError

#: Of each parser's hostile files so many are tried here, evenly chosen, and so many of each whole file's mutants.
HOSTILE, MUTANTS = 40, 10


@pytest.mark.parametrize("name", PARSERS)
def test_whole_files_are_read(tmp_path: Path, name: str) -> None:
    parser = PARSERS[name]
    said = [run(parser, seed, tmp_path) for seed in parser.seeds()]
    assert "" in said and sum(map(bool, said)) <= 1


@pytest.mark.parametrize("name", PARSERS)
def test_broken_files_give_a_result_or_one_sentence(tmp_path: Path, name: str) -> None:
    parser, rng = PARSERS[name], np.random.default_rng(1)
    whole = parser.seeds()
    always = len(ANYWHERE) + len(NESTED.get(parser.suffix, ()))
    tried = list(hostile(whole, parser.suffix))
    said = [run(parser, data, tmp_path) for data in [*tried[:always], *tried[always :: max(1, len(tried) // HOSTILE)]]]
    said += [run(parser, data, tmp_path) for seed in whole for data in mutants(seed, rng, MUTANTS)]
    assert any(said) or name == "frames", "nothing was refused: nothing was broken"  # of frames, what is hurt is counted


PROGRAM = b"G28\nG90\nM83\nG0 Z5 F600\nG1 X10 Y10 E1 F600\n"
CAPTURE = b"Trajectories\n%s\n,,%s,,\nFrame,Sub Frame,X,Y,Z\n,,mm,mm,mm\n1,0,1,2,3\n%s,0,1,2,3\n"


@pytest.mark.parametrize(
    ("name", "data", "says"),
    [
        ("printer", b"a = " + b"[" * 20_000, "nested too deep"),
        ("printer", b".".join([b"a"] * 2000) + b" = 1", "tables within tables"),
        ("printer", b"a = " + b"9" * 5000, "is not a TOML file"),
        ("printer", b'extends = "a\\u0000b.toml"', "no printer profile can be named"),
        ("printer", b'extends = "' + b"x" * 5000 + b'"', "extends 'xxx.* or give a .toml file"),
        ("material", b"ink = 1\n", r"\[ink\] is 1; it must be a table"),
        ("material", b"layers = 1\n", "must be a list of tables"),
        ("sensors", b"a = " + b"9" * 5000, "is not a TOML file"),
        ("plan", b"a = " + b"9" * 5000, "is not a TOML file"),
        ("sensors", b"[auto]\nsizes = [" + b"9" * 400 + b"]", "has more than 64 bits"),
        ("plan", b"[limits]\ntime_s = " + b"9" * 400, "has more than 64 bits"),
        ("fingertip-json", b'{"kind": "force liquid", "facts": {"pieces": 1e999}}', "1e999 is too large a number"),
        ("fingertip-json", b'{"kind": "force shape", "facts": {"misfit_limits": {}}}', "is not one of a model"),
        ("plan", b" " * 1_000_001, "more than 1 MB"),
        ("calibration", b"9" * 5000, "is no JSON file"),
        ("ply", b"ply\nelement vertex " + b"9" * 5000 + b"\nend_header\n", "is cut off"),
        ("vicon", CAPTURE % (b"100", b"", b"2"), "no label stands over"),
        ("vicon", CAPTURE % (b"1e-320", b"A", b"2"), "make no times"),
        ("vicon", CAPTURE % (b"100", b"A", b"9" * 400), "make no times"),
        ("targets", b"image,offset_mm,angle_deg\n" + b"x" * 5000 + b",1,2\n", "which no file can be called"),
        ("targets", "\ufeffimage,offset_mm,angle_deg\na\0b,1,2\n".encode("utf-16-le"), "is not a text file"),
        *((name, b"a" * 200_000, "field larger than field limit") for name in ("targets", "events", "places", "force-labels")),
        ("gcode", PROGRAM.replace(b"X10", b"X9223372036854775808"), "X is 9.22e[+]18, which is no number for a printer"),
        ("gcode", PROGRAM + b"G3 X12 Y10 I9223372036854775808 J1 E1\n", "I is 9.22e[+]18"),
    ],
)
def test_what_a_search_found(tmp_path: Path, name: str, data: bytes, says: str) -> None:
    if name == "gcode":
        assert re.search(says, judge(data.decode(), load_printer("generic-marlin")).broken_off)
    else:
        assert re.search(says, run(PARSERS[name], data, tmp_path))


def test_a_checksum_of_thousands_of_digits_is_wrong() -> None:
    assert "its checksum is 999" in str(judge(f"N1 G28*{'9' * 5000}", load_printer("generic-marlin")).findings[0])


def test_no_speed_is_none() -> None:
    text = seeds.programs()[1].decode()
    with pytest.raises(InputError, match="F0 is no speed"):
        parse(re.sub(r"F\d[\d.]*", "F0", text))


def test_a_superscript_is_no_frame(tmp_path: Path) -> None:
    assert run(PARSERS["vicon"], CAPTURE.replace(b"%s,0", b"\xc2\xb2,0") % (b"100", b"A"), tmp_path) == ""


@pytest.mark.parametrize(
    "read", [lambda path: int(path.read_text()), lambda path: 1 // 0, lambda path: (_ for _ in ()).throw(InputError(""))]
)
def test_a_parser_that_fails_otherwise_is_found(tmp_path: Path, read: object) -> None:
    with pytest.raises((ValueError, ZeroDivisionError, AssertionError)):
        run(Parser(read, list, ".txt"), b"x", tmp_path)  # type: ignore[arg-type]
