"""Profiles: the bundled ones are sound, and every way to get one wrong is told by name."""

from pathlib import Path

import pytest

from gcode.printer import load_printer
from gcode.profile import bundled_printers
from skinfab.errors import InputError

SOURCE = (Path(__file__).parents[2] / "gcode/profiles/ender5plus-vipro.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", bundled_printers())
def test_bundled_profiles_load(name: str) -> None:
    printer = load_printer(name)
    assert printer.name and printer.pump.prime == printer.pump.retract
    assert printer.park is not None and printer.park.x < 10 and printer.park.y > printer.bed.size[1] - 10  # the rear left corner


def test_the_default_is_the_papers_machine() -> None:
    printer = load_printer()
    assert (printer.bed_size, printer.bed.height) == ((350.0, 350.0), 400.0)
    assert printer.heights.print_min == 1.5 <= printer.heights.print <= printer.heights.print_max == 1.7
    assert printer.pump.e_per_mm3 * 0.484 == pytest.approx(4.0)  # its extrusion factor, mm of E per mm


def test_a_file_of_ones_own(tmp_path: Path) -> None:
    own = tmp_path / "mine.toml"
    own.write_text(SOURCE + "\n[cleaning]\nx = 5\ny = 6\nseconds = 3\ninitial_extrude = 2.5\n", encoding="utf-8")
    cleaning = load_printer(own).cleaning
    assert cleaning is not None and (cleaning.x, cleaning.initial_extrude) == (5.0, 2.5)


@pytest.mark.parametrize(("x", "y"), [(351, 6), (5, 350.5), (-1, 6)])
def test_the_cleaning_place_is_on_the_bed(tmp_path: Path, x: float, y: float) -> None:
    own = tmp_path / "mine.toml"
    own.write_text(SOURCE + f"\n[cleaning]\nx = {x}\ny = {y}\nseconds = 3\ninitial_extrude = 2.5\n", encoding="utf-8")
    says = "cleaning, x is -1" if x < 0 else f"cleaning, {'x' if x > 350 else 'y'} is {max(x, y)}, and bed, size is 350 x 350 mm"
    with pytest.raises(InputError, match=says):
        load_printer(own)


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ("height = 12", "cleaning, height is 12 mm, and heights, travel is 10 mm: .* at most 10, or raise travel"),
        ("height = -1", "cleaning, height is -1; it must be a number, zero or more"),
        ("height = 'low'", "cleaning, height is 'low'; it must be a number"),
        ("wipe = 10", "cleaning, wipe is 10 mm, and there is no height: it would wipe nothing; say height under .cleaning. in mine.toml"),
        ("height = 5\nwipe = 346", "cleaning, wipe is 346 and cleaning, x is 5, so the nozzle is wiped up to x = 351, .* at most 4"),
    ],
)
def test_the_cleaning_height_is_the_machines(tmp_path: Path, more: str, says: str) -> None:
    own = tmp_path / "mine.toml"
    own.write_text(SOURCE + f"\n[cleaning]\nx = 5\ny = 6\nseconds = 3\ninitial_extrude = 2.5\n{more}\n", encoding="utf-8")
    with pytest.raises(InputError, match=says):
        load_printer(own)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("travel_speed = 100", "travelspeed = 100", "motion: unknown field 'travelspeed'"),
        ("travel_speed = 100", "", "motion: field 'travel_speed' is missing"),
        ("travel_speed = 100", "travel_speed = '100'", "travel_speed is '100'; it must be a number"),
        ("travel_speed = 100", "travel_speed = nan", "travel_speed is nan"),
        ("travel_speed = 100", "travel_speed = 0", "travel_speed is 0; it must be more than zero"),
        ("travel_speed = 100", "travel_speed = true", "travel_speed is True"),
        ("arcs = true", "arcs = 1", "arcs is 1; it must be true or false"),
        ('home = "xy"', 'home = "zyx"', "home is 'zyx'; it must be one of xyz, xy, none"),
        ('home = "xy"', "home = 3", "home is 3; it must be a text"),
        ("size = [350, 350]", "size = [350]", "two numbers"),
        ("size = [350, 350]", "size = [350, -1]", "bed, size is -1"),
        ("[bed]", "bed = 3\n[bad]", "unknown field 'bad'"),
        ("retract = 0.2", "retract = 0.4", "make them equal"),
        ("travel = 10", "travel = 1.65", "heights"),
        (
            "flow_min = 0.5",
            "flow_min = 50",
            "pump, flow_min is 50, above pump, flow_max is 3 mm^3/s; say flow_min under [pump] in mine.toml",
        ),
        ("y = 345", "y = 351", "park, y is 351, and bed, size is 350 x 350 mm; say y under [park] in mine.toml: at most 350"),
        ("x = 5 ", "x = -5 ", "park, x is -5"),
        ("[bed]", "[bed", "not a TOML file"),
    ],
)
def test_wrong_profiles_say_where(tmp_path: Path, old: str, new: str, says: str) -> None:
    assert old in SOURCE
    own = tmp_path / "mine.toml"
    own.write_text(SOURCE.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError) as fault:
        load_printer(own)
    assert says in str(fault.value)


def test_the_park_may_be_left_out(tmp_path: Path) -> None:
    own = tmp_path / "mine.toml"
    own.write_text(SOURCE.partition("[park]")[0], encoding="utf-8")
    assert load_printer(own).park is None


def test_a_table_that_is_none(tmp_path: Path) -> None:
    own = tmp_path / "mine.toml"
    own.write_text("cleaning = 3\n" + SOURCE, encoding="utf-8")
    with pytest.raises(InputError, match="must be a table"):
        load_printer(own)


def test_unknown_names_list_the_known(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there are ender5plus-vipro, generic-grbl, generic-marlin"):
        load_printer("ender3")
    with pytest.raises(InputError, match="no printer profile at"):
        load_printer(tmp_path / "absent.toml")
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(InputError, match="cannot read"):
        load_printer(tmp_path / "folder.toml")
