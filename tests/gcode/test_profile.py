"""A profile takes over from another what it does not say; parents that are unknown or go in a circle are refused."""

from pathlib import Path

import pytest

from gcode.printer import load_printer
from gcode.profile import bundled_printers, read_profile
from skinfab.errors import InputError


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def test_what_is_not_said_is_the_parents(tmp_path: Path) -> None:
    parent = load_printer("generic-marlin")
    own = load_printer(
        write(tmp_path / "own.toml", 'extends = "generic-marlin"\nname = "mine"\n[bed]\nsize = [300, 310]\n[pump]\nflow_max = 4\n')
    )
    assert (own.name, own.bed.size, own.pump.flow_max) == ("mine", (300.0, 310.0), 4.0)
    assert own.bed.height == parent.bed.height and own.motion == parent.motion
    assert own.pump.prime == parent.pump.prime and own.nozzle == parent.nozzle


def test_a_grandparent_by_path_counts_from_the_file_that_names_it(tmp_path: Path) -> None:
    (tmp_path / "lab").mkdir()
    write(tmp_path / "lab/base.toml", 'extends = "ender5plus-vipro"\n[nozzle]\nouter_radius = 0.4\n')
    write(tmp_path / "middle.toml", 'extends = "lab/base.toml"\n[heights]\ntravel = 20\n')
    own = load_printer(write(tmp_path / "own.toml", 'extends = "middle.toml"\n[nozzle]\nclearance = 0.3\n'))
    assert (own.nozzle.outer_radius, own.nozzle.clearance, own.heights.travel, own.bed_size) == (0.4, 0.3, 20.0, (350.0, 350.0))


def test_a_new_table_may_be_added(tmp_path: Path) -> None:
    own = write(tmp_path / "own.toml", 'extends = "generic-marlin"\n[cleaning]\nx = 1\ny = 2\nseconds = 3\ninitial_extrude = 0\n')
    assert load_printer(own).cleaning is not None


@pytest.mark.parametrize(
    ("first", "second", "says"),
    [
        (
            'extends = "second.toml"',
            'extends = "first.toml"',
            "extend each other in a circle: .*first.toml -> .*second.toml -> .*first.toml",
        ),
        ('extends = "first.toml"', "", "in a circle: .*first.toml -> .*first.toml"),
        ('extends = "ender3"', "", "first.toml extends 'ender3': no printer profile named 'ender3'; there are"),
        ('extends = "gone.toml"', "", "first.toml extends .*gone.toml': no printer profile at"),
        ('extends = "second.toml"', "x = [", "first.toml extends .*second.toml': .* is not a TOML file"),
        ("extends = 3", "", "extends is 3; it must be the name of a profile in quotes"),
        ('extends = "generic-marlin"\n[bed]\nwidth = 3', "", "bed: unknown field 'width'"),
        ('extends = "generic-marlin"\nbed = 3', "", "bed: it is 3; it must be a table"),
    ],
)
def test_bad_parents_are_refused(tmp_path: Path, first: str, second: str, says: str) -> None:
    write(tmp_path / "second.toml", second)
    with pytest.raises(InputError, match=says):
        load_printer(write(tmp_path / "first.toml", first))


def test_every_bundled_profile_is_whole_by_name() -> None:
    assert bundled_printers() == ("ender5plus-vipro", "generic-grbl", "generic-marlin")
    assert {read_profile(name)["name"] for name in bundled_printers()} == {load_printer(name).name for name in bundled_printers()}
