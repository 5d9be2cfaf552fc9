"""What holds for every pattern there is, a new one included: each test runs over a hundred random sets and more of parameters."""

import dataclasses
import math
import re
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_patterns import fault_of, mended, parameter_sets, patterns

from skinfab.drawings.catalogue import catalogue
from skinfab.errors import InputError
from skinfab.paths import Arc, Line
from skinfab.patterns.base import Pattern, PatternError
from skinfab.patterns.registry import PATTERNS, make_pattern, parameters
from skinfab.placement.check import own_clearance
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import CLEARANCE_MM, PARAMETER_STEP_MM

every_pattern = pytest.mark.parametrize("kind", PATTERNS)
some = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
many = settings(max_examples=110, deadline=None, suppress_health_check=[HealthCheck.too_slow])

#: Parts that each arc is sampled in; a line has its ends.
PARTS = 256
ALONG_ARC, ALONG_LINE = np.linspace(0, 1, PARTS + 1), np.array([0.0, 1.0])


def sampled(segment: Line | Arc) -> np.ndarray:
    return segment.point_at(ALONG_ARC if isinstance(segment, Arc) else ALONG_LINE)


def numeric_length(segment: Line | Arc) -> float:
    """Sums of chords, extrapolated: halving the step quarters their error."""
    points = sampled(segment)
    fine = float(np.hypot(*np.diff(points, axis=0).T).sum())
    return (4 * fine - float(np.hypot(*np.diff(points[::2], axis=0).T).sum())) / 3 if len(points) > 2 else fine


@every_pattern
@many
@given(data=st.data())
def test_length_is_what_sampling_measures(kind: str, data: st.DataObject) -> None:
    pattern = data.draw(patterns(kind))
    assert pattern.length == pytest.approx(sum(map(numeric_length, pattern.path().segments)), rel=1e-9)


@every_pattern
@many
@given(data=st.data(), angle=st.floats(-7, 7))
def test_the_box_is_exact_at_any_angle(kind: str, data: st.DataObject, angle: float) -> None:
    path = data.draw(patterns(kind)).printed_path().transformed(angle=angle, shift=(0.0, 0.0))
    points = np.vstack([sampled(s) for s in path.segments])
    low, high = path.bbox
    assert (points >= low - 1e-9).all() and (points <= high + 1e-9).all()
    # A sample is at most half a part from the extreme point of its arc.
    arcs = [s for s in path.segments if isinstance(s, Arc)]
    missed = max((s.radius * (1 - np.cos(s.sweep / (2 * PARTS))) for s in arcs), default=0.0) + 1e-9
    assert (points.min(axis=0) <= low + missed).all() and (points.max(axis=0) >= high - missed).all()


@every_pattern
@many
@given(data=st.data())
def test_pads_are_squares_of_ink_at_the_terminals(kind: str, data: st.DataObject) -> None:
    pattern = data.draw(patterns(kind))
    path, printed = pattern.path(), pattern.printed_path()
    if not pattern.pad:
        assert printed.length == path.length
        return
    # Rows at most a bead apart, all of them as long as the square is wide, and the way from the first to the last.
    reach = pattern.pad - pattern.bead
    rows = max(math.ceil(reach / pattern.bead - 1e-9), 1) + 1
    assert printed.length == pytest.approx(pattern.length + 2 * (rows + 1) * reach, rel=1e-9)
    count = (len(printed.segments) - len(path.segments)) // 2
    assert printed.segments[count].start == pytest.approx(path.start) and printed.segments[-count - 1].end == pytest.approx(path.end)
    for strokes, terminal, outward in ((printed.segments[:count], path.start, -1), (printed.segments[-count:], path.end, 1)):
        corners = np.vstack([s.bbox for s in strokes])
        low, high = corners.min(axis=0), corners.max(axis=0)
        # With half a bead all round it is `pad` wide; it begins at the terminal and grows away from the other one.
        np.testing.assert_allclose(high - low + pattern.bead, pattern.pad, rtol=1e-9)
        np.testing.assert_allclose([high[0], (low if outward > 0 else high)[1]], terminal, atol=1e-7)


#: Numbers that somebody may type: the wrong sign, the wrong unit, next to nothing.
EXTREMES = st.sampled_from([-1e300, -7, -1e-9, 0, 1e-300, 1e-9, 0.05, 999.999, 1000, 1001, 1e6, 1e300])


@every_pattern
@many
@given(data=st.data())
def test_any_numbers_are_drawn_or_refused_by_name(kind: str, data: st.DataObject) -> None:
    params = data.draw(parameter_sets(kind))
    numbers = [name for name, value in params.items() if not isinstance(value, bool)]
    for name in data.draw(st.sets(st.sampled_from(numbers), min_size=1)):
        params[name] = data.draw(EXTREMES)
    fault = failure(kind, params)
    if fault is None:
        pattern = make_pattern(kind, params)
        assert math.isfinite(pattern.length) and np.isfinite(pattern.printed_path().bbox).all()
    elif isinstance(fault, PatternError):
        assert fault.parameter in params and str(fault).startswith(f"{kind}: {fault.parameter} is ")
        # The nearest value keeps this bound, though others may be broken as well.
        after = failure(kind, {**params, fault.parameter: fault.nearest})
        assert after is None or str(after).split("; the nearest")[0] != str(fault).split("; the nearest")[0]
    else:
        # No value of this parameter would do on any bed: it is named, and so is what to do.
        assert re.match(rf"{kind}: ({'|'.join(params)}) would have to be at least .* make the other parameters smaller", str(fault))


def failure(kind: str, params: dict[str, Any]) -> InputError | None:
    try:
        make_pattern(kind, params)
    except InputError as fault:
        return fault
    return None


@every_pattern
@many
@given(data=st.data())
def test_advice_works_and_is_the_nearest(kind: str, data: st.DataObject) -> None:
    params = data.draw(parameter_sets(kind))
    fault = fault_of(kind, params)
    mended(kind, params)
    if fault is None:
        return
    name, given_value, nearest = fault.parameter, params[fault.parameter], fault.nearest
    assert str(fault).startswith(f"{kind}: {name} is {given_value!r}; ")
    # What is printed is what is meant, to the last digit.
    printed = re.search(r"the nearest value that works is (\S+)$", str(fault))
    assert printed and float(printed[1]) == nearest
    then = fault_of(kind, {**params, name: nearest})
    assert then is None or (then.parameter, then.nearest) != (name, nearest)
    # A step and a bit back towards what was given breaks the bound again.
    back = nearest + math.copysign(1.001 * PARAMETER_STEP_MM, given_value - nearest)
    if isinstance(given_value, float) and abs(back - nearest) < abs(given_value - nearest):
        again = fault_of(kind, {**params, name: back})
        assert again is not None and again.parameter == name


@every_pattern
@many
@given(data=st.data())
def test_what_is_left_out_breaks_no_bound(kind: str, data: st.DataObject) -> None:
    params = data.draw(parameter_sets(kind))
    own = sorted(set(params) - set(PATTERNS[kind].required()))
    left_out = data.draw(st.sets(st.sampled_from(own)))
    given = {name: value for name, value in params.items() if name not in left_out}
    fault = fault_of(kind, given)
    # The common three have values of their own, which a given one may not go with: a pad narrower than two given beads.
    assert fault is None or fault.parameter in {*given, "pad"}, str(fault)
    if fault is None:
        made = parameters(make_pattern(kind, given))
        assert made.items() >= given.items()
        assert make_pattern(kind, made) == make_pattern(kind, given)


@every_pattern
def test_every_parameter_is_described(kind: str) -> None:
    entry = next(entry for entry in catalogue() if entry.kind == kind)
    for p in entry.parameters:
        assert p.meaning != p.name and p.bounds, f'{p.name}: write "Meaning; bounds." in the class\'s Parameters'
        assert p.required or p.default != "", f'{p.name}: end its description with "Unless given: what then."'


@every_pattern
@settings(some, max_examples=40)
@given(data=st.data())
def test_a_pattern_keeps_off_itself(kind: str, data: st.DataObject) -> None:
    pattern = data.draw(patterns(kind))
    need = pattern.pitch_min
    assert own_clearance(Sensor("C1", "P1", pattern, 0.0, 0.0, 0.0, 0), need=need) >= need - CLEARANCE_MM


@every_pattern
@some
@given(data=st.data())
def test_frame_and_terminals(kind: str, data: st.DataObject) -> None:
    pattern = data.draw(patterns(kind))
    path = pattern.path()
    np.testing.assert_allclose(path.start, (0, 0), atol=1e-9)
    # Where an arc meets a lead as a tangent, its end keeps half of the digits.
    assert path.end[0] == pytest.approx(0, abs=1e-7) and path.end[1] >= pattern.pitch_min - 1e-7
    first, last = path.segments[0], path.segments[-1]
    for lead, outer in ((first, first.end), (last, last.start)):
        assert isinstance(lead, Line) and outer[0] > 0 and np.ptp(lead.bbox[:, 1]) < 1e-7
    low, high = path.bbox
    assert low[0] >= -1e-7 and 0 < pattern.span <= high[0] - low[0] + 1e-7
    assert (pattern.middle >= low - 1e-9).all() and (pattern.middle <= high + 1e-9).all()
    assert make_pattern(kind, parameters(pattern)) == pattern


@every_pattern
@some
@given(data=st.data())
def test_dimensions_measure_their_parameters(kind: str, data: st.DataObject) -> None:
    pattern = data.draw(patterns(kind))
    for name, start, end in pattern.dimensions():
        assert np.hypot(*np.subtract(end, start)) == pytest.approx(getattr(pattern, name), abs=1e-7)


@every_pattern
def test_the_example_is_a_pattern(kind: str) -> None:
    cls = PATTERNS[kind]
    own = {f.name for f in dataclasses.fields(cls)} - {f.name for f in dataclasses.fields(Pattern)}
    assert own & set(cls.example) == set(cls.example)
    pattern = make_pattern(kind, cls.example)
    assert pattern.senses in ("contact", "strain") and re.fullmatch("[a-z]+(-[a-z]+)*", kind)
    # Counts and switches have no length to show; everything else has.
    lengths = {f.name for f in dataclasses.fields(cls) if f.name in own and f.type == "float"}
    assert {name for name, _, _ in pattern.dimensions()} in (lengths, set())
