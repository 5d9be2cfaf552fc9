"""Foreign text followed as Marlin follows it."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcode.geometry import Curve
from gcode.moves import Finding, Move
from gcode.printer import load_printer
from gcode.trace import homed_axes, trace
from skinfab.errors import InputError

START = "G21\nG90\nM83\nM302 P1\nG0 X0 Y0 Z1 F600\n"


def last(text: str) -> Move:
    return trace(START + text).moves[-1]


def test_absolute_relative_and_renamed_places() -> None:
    assert last("G91\nG1 X2 Y3\nG1 X2").end == (4.0, 3.0, 1.0)
    assert last("G1 X5\nG92 X0\nG1 X2").end == (7.0, 0.0, 1.0)
    assert last("G92 X10\nG92 X20\nG1 X21").end == (1.0, 0.0, 1.0)
    assert last("G20\nG1 X1 F60").end == (25.4, 0.0, 1.0)
    assert last("G20\nG1 X1 F60").speed == pytest.approx(25.4)


def test_ink_is_a_difference_in_absolute_mode() -> None:
    t = trace("M302 P1\nG0 X0 Y0 F60\nG1 X1 E2\nG1 X2 E5\nG92 E0\nG1 X3 E1\nM83\nG1 X4 E1")
    assert [m.e for m in t.moves] == [0.0, 2.0, 3.0, 1.0, 1.0]
    assert not t.faults


@pytest.mark.parametrize(("code", "radius", "middle"), [("G2", 5, 1), ("G3", 5, -1), ("G2", -5, 9), ("G3", -5, -9)])
def test_radius_form_takes_the_side_that_marlin_takes(code: str, radius: float, middle: float) -> None:
    t = trace(START + f"{code} X6 Y0 R{radius}")
    shape = t.moves[-1].shape
    assert isinstance(shape, Curve)
    assert shape.point_at(0.5) == pytest.approx((3, middle))
    assert ["R form" in f.what for f in t.faults] == [True]


@given(st.floats(0.1, 50), st.floats(-3, 3), st.floats(0.1, 3.0))
def test_both_forms_of_an_arc_agree(radius: float, start: float, sweep: float) -> None:
    p, q = ((radius * math.cos(a), radius * math.sin(a)) for a in (start, start + sweep))
    head = f"M302 P1\nG0 X{p[0]:.9f} Y{p[1]:.9f} F60\nG3 X{q[0]:.9f} Y{q[1]:.9f} "
    by_centre = trace(head + f"I{-p[0]:.9f} J{-p[1]:.9f}").moves[-1].shape
    by_radius = trace(head + f"R{radius:.9f}").moves[-1].shape
    assert isinstance(by_centre, Curve) and isinstance(by_radius, Curve)
    assert by_radius.length == pytest.approx(by_centre.length, rel=1e-3)


def test_places_nobody_knows() -> None:
    t = trace("G28\nG0 Z5 F60\nG0 X1 Y2")
    assert t.moves[0].end == (None, None, 5.0) and t.moves[0].shape is None
    assert t.moves[1].end == (1.0, 2.0, 5.0)
    assert [homed_axes(c) for c in t.commands if c.code == "G28"] == ["XYZ"]
    assert homed_axes(trace("G28 Y X").commands[0]) == "XY"


def test_findings_of_one_kind_differ_by_numbers_only() -> None:
    fast, faster, other = (Finding(k, what, "") for k, what in enumerate(("F480.0 is above F-1.", "F7 is above F9", "E7 is above F9")))
    assert fast.kind == faster.kind != other.kind


def test_patterns_are_named_by_comments() -> None:
    t = trace("; pattern C7\nG0 X0 Y0 F60")
    assert t.moves[0].pattern == "C7"


def faults(text: str) -> list[tuple[int, str]]:
    return [(f.line, f.what) for f in trace(text).faults]


def test_g90_after_m83_is_found_where_ink_follows() -> None:
    (found,) = faults(START + "G90\nG0 X1\nG1 X2 E1\nG1 X3 E1")
    assert found[0] == 6 and "E from line 8" in found[1]
    assert not faults(START + "G90\nM83\nG1 X2 E1")
    assert not faults(START + "G1 X2 E1\nG90\nG0 X3")
    assert faults(START + "G91\nG90\nG1 X2 E1")  # the usual trap of a lift in between


def test_ink_without_m302() -> None:
    (found,) = faults("M83\nG0 X0 Y0 F60\nG1 X1 E1\nG1 X2 E1")
    assert found[0] == 3 and "M302" in found[1]
    assert faults("M302 P0\nM83\nG1 E1 F60")
    assert not faults("M302 S0\nM83\nG1 E1 F60")


def test_long_lines_and_z_on_arcs() -> None:
    assert "96 bytes" in faults(START + "G1 X1." + 90 * "0")[0][1]
    assert not faults(START + "G1 X1." + 89 * "0" + " ; " + 90 * "x")
    assert "Z on an arc" in faults(START + "G2 X2 Y0 Z2 I1")[0][1]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("G2 X1 Y1 I1 J0", "line 1: an arc begins at an unknown place"),
        (START + "G2 X1 Y1", "line 6: G2 has neither I nor J"),
        (START + "G2 X1 Y1 I0 J0", "line 6: the arc's centre is its start"),
        (START + "G2 X0 Y0 R5", "line 6: an arc by R"),
        (START + "G1 X", "line 6: X has no number"),
        (START + "G1 X1 F0", "line 6: F is 0"),
        (START + "G1 X1 F-5", "line 6: F is -5"),
        (START + "G18", "line 6: G18 is not supported"),
        (START + "G5 X1 Y1 I0 J0 P0 Q0", "line 6: G5 is not supported"),
        (START + "G92", "line 6: G92 without an axis"),
    ],
)
def test_motions_that_cannot_be_followed(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        trace(text)


words = st.builds(
    "{}{}".format, st.sampled_from("XYZIJREFPS"), st.sampled_from(["", "0", "1", "-1", "1e999", "NaN", "1.5", "999999999", "-.0001"])
)
lines = st.builds(
    "{} {}".format,
    st.sampled_from(["G0", "G1", "G2", "G3", "G4", "G5", "G20", "G21", "G28", "G90", "G91", "G92", "M82", "M83", "M302", "M104"]),
    st.lists(words, max_size=5).map(" ".join),
)


@given(st.lists(lines, max_size=12))
def test_hostile_text_gives_moves_or_one_sentence(text: list[str]) -> None:
    try:
        t = trace("\n".join(text))
    except InputError as fault:
        said = str(fault)
        assert "\n" not in said and said.startswith("line ")
    else:
        assert all(math.isfinite(v) for m in t.moves for v in (*m.end, m.e) if v is not None)


SPINDLE = load_printer("generic-grbl").spindle


def test_grbl_goes_on_with_the_last_motion() -> None:
    t = trace("X1 Y2 Z3 F60\nG1 X5\nY4 F120\nF600\nX0\nG3 X2 Y4 I1 J0\nX4 I1 J0\nG4 P1\nG28.1\nX6 I1 J0", spindle=SPINDLE)
    assert [c.code for c in t.commands] == ["G0", "G1", "G1", "F", "G1", "G3", "G3", "G4", "G28.1", "G3"]
    assert [m.end for m in t.moves[:4]] == [(1.0, 2.0, 3.0), (5.0, 2.0, 3.0), (5.0, 4.0, 3.0), (0.0, 4.0, 3.0)]
    assert [m.speed for m in t.moves] == [None, 1.0, 2.0, 10.0, 10.0, 10.0, 10.0]  # F of the G0 is kept
    assert [m.centre for m in t.moves[4:]] == [(1.0, 4.0), (3.0, 4.0), (5.0, 4.0)] and not t.faults


def test_grbl_takes_s_on_any_line() -> None:
    spelt = trace("G1 X0 Y0 F60\nM3 S100\nG1 X2\nM3 S200\nG1 X4\nM4 S200\nG1 X6\nM5\nG1 X8", spindle=SPINDLE).moves
    short = trace("G1 X0 Y0 F60\nS100\nM3\nX2\nS200\nX4\nM4\nX6\nM5\nX8 S300", spindle=SPINDLE).moves
    assert [m.e for m in short] == [m.e for m in spelt] == [0.0, 2.0, 4.0, -4.0, 0.0]
    faults = trace("G1 X0 Y0 F60\nM3\nG1 X2 S2000", spindle=SPINDLE).faults
    assert [f.what for f in faults] == ["S2000 is not within 0 and the spindle's 1000"]


@pytest.mark.parametrize("cancels", ["G80", "G38.2 Z-5"])
def test_no_motion_to_go_on_with(cancels: str) -> None:
    with pytest.raises(InputError, match="line 3: there is no motion to go on with"):
        trace(f"G1 X0 Y0 F60\n{cancels}\nX5", spindle=SPINDLE)


def test_marlin_is_said_to_pass_a_line_of_words_over() -> None:
    t = trace(START + "G1 X1\nX2 E1\nF300\nX3")
    assert [(f.line, "passes it over" in f.what) for f in t.faults] == [(7, True), (8, True), (9, True)]
    assert [m.end[0] for m in t.moves] == [0.0, 1.0, 2.0, 3.0] and t.moves[-1].speed == 5.0
    assert [f.line for f in trace("X2 Y2\nG0 X1 F60").faults] == [1]


def test_g0_of_grbl_goes_as_fast_as_the_machine() -> None:
    grbl = load_printer("generic-grbl")  # 25 mm/s in X and Y, 5 in Z
    t = trace("G0 Z10\nG0 X30 Y40 F60\nG0 X0 Y0 Z0\nG1 X6", spindle=grbl.spindle, motion=grbl.motion)
    assert [m.rapid for m in t.moves] == [True, True, True, False]
    assert [m.speed for m in t.moves] == pytest.approx([25.0, 25.0, math.hypot(50, 10) / 2, 1.0])
    assert [m.speed for m in trace("G0 X0 Y0 Z0\nG0 Z1", spindle=grbl.spindle, motion=grbl.motion).moves] == [25.0, 5.0]


def test_marlin_s_g0_has_its_f() -> None:
    assert [(m.speed, m.rapid) for m in trace("G0 X1\nG0 X2 F60\nG0 X3").moves] == [(None, False), (1.0, False), (1.0, False)]
