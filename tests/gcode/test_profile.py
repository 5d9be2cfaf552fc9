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
    assert {read_profile(name).data["name"] for name in bundled_printers()} == {load_printer(name).name for name in bundled_printers()}


LARGE = 'extends = "generic-marlin"\n[bed]\nsize = [300, 300]\nheight = 300\n[heights]\ntravel = 250\n'
CLEANS = LARGE + "[cleaning]\nx = 280\ny = 20\nseconds = 3\ninitial_extrude = 1\nheight = 5\nwipe = 15\n"


@pytest.mark.parametrize(
    ("parent", "own", "says"),
    [
        (
            'extends = "generic-marlin"',
            "[bed]\nsize = [150, 150]",
            "park, y is 195 (taken over from generic-marlin), and bed, size is 150 x 150 mm; "
            "say y under [park] in own.toml: at most 150, on the bed and beside the largest mould",
        ),
        (
            'extends = "ender5plus-vipro"\n[park]\nx = 300',
            "[bed]\nsize = [150, 400]",
            "park, x is 300 (taken over from FOLDER/parent.toml), and bed, size is 150 x 400 mm; "
            "say x under [park] in own.toml: at most 150",
        ),
        (
            CLEANS,
            "[bed]\nsize = [200, 200]",
            "cleaning, x is 280 (taken over from FOLDER/parent.toml), and bed, size is 200 x 200 mm; say x under [cleaning] in own.toml",
        ),
        (
            CLEANS,
            "[bed]\nsize = [290, 300]",
            "cleaning, wipe is 15 (taken over from FOLDER/parent.toml) and cleaning, x is 280 (taken over from FOLDER/parent.toml), "
            "so the nozzle is wiped up to x = 295, and bed, size is 290 x 300 mm; say x under [cleaning] in own.toml: at most 275",
        ),
        (CLEANS, "[heights]\ntravel = 4", "cleaning, height is 5 (taken over from FOLDER/parent.toml) mm, and heights, travel is 4 mm"),
        (LARGE, "[bed]\nheight = 100", "heights, travel is 250 (taken over from FOLDER/parent.toml) mm, and bed, height is 100 mm"),
        (LARGE, "[heights]\nprint = 5", "heights, print is 5 mm, and heights, print_max is 3 (taken over from generic-marlin) mm"),
        (LARGE, "[pump]\nflow_max = 0.05", "pump, flow_min is 0.1 (taken over from generic-marlin), above pump, flow_max is 0.05 mm^3/s"),
        (LARGE, "[pump]\nprime = 0.1", "pump, prime is 0.1 and pump, retract is 0.5 (taken over from generic-marlin) mm^3;"),
        (LARGE, "[spindle]\ns_per_flow = 1\ns_max = 9", "home is 'xy' (taken over from generic-marlin); GRBL homes by $H"),
        (
            LARGE,
            'home = "none"\n[spindle]\ns_per_flow = 1\ns_max = 9',
            "pump, max_e is 200 (taken over from generic-marlin); a pump that is a spindle has no E axis",
        ),
        (
            'extends = "generic-grbl"',
            "[spindle]\ns_max = 255",
            "pump, flow_max is 10 (taken over from generic-grbl) mm^3/s, which asks for S1000 as spindle, s_per_flow is 100 "
            "(taken over from generic-grbl), and spindle, s_max is 255; say flow_max under [pump] in own.toml: at most 2.55",
        ),
        (LARGE + "[motion]\nz_speed = 0", "", "motion, z_speed is 0 (taken over from FOLDER/parent.toml); it must be more than zero"),
        (LARGE + "[motion]\nz_speed = '5'", "", "motion, z_speed is '5' (taken over from FOLDER/parent.toml); it must be a number"),
        (LARGE + "[motion]\nzspeed = 5", "", "motion: unknown field 'zspeed' (taken over from FOLDER/parent.toml); it knows"),
        ('extends = "generic-marlin"\nbed = 3', "", "bed: it is 3 (taken over from FOLDER/parent.toml); it must be a table"),
    ],
)
def test_a_contradiction_says_which_profile_each_value_was_taken_over_from(tmp_path: Path, parent: str, own: str, says: str) -> None:
    write(tmp_path / "parent.toml", parent)
    top = 'extends = "parent.toml"\n'
    with pytest.raises(InputError) as fault:
        load_printer(write(tmp_path / "own.toml", top + own))
    assert says.replace("FOLDER", str(tmp_path)) in str(fault.value)
    assert str(fault.value).startswith(f"printer profile {tmp_path / 'own.toml'}")
