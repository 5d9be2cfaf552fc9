"""Patterns and placement where the plain methods fail: each test shows that they do, and what is done instead."""

import dataclasses
import itertools
import math
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import shapely

from skinfab.errors import InputError, RefusedError
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.paths import Arc, PathError
from skinfab.patterns.base import Pattern, PatternError
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.registry import make_pattern, parameters
from skinfab.patterns.strain_lines import StrainLines
from skinfab.patterns.strain_neck import StrainNeck
from skinfab.pieces import Piece
from skinfab.placement.check import check_sensor, edge_curves, own_clearance, validate
from skinfab.placement.distance import Curves, distance
from skinfab.placement.requested import place_from_file
from skinfab.placement.sensor import Sensor
from skinfab.tolerances import ARC_RADIUS_MM, CLEARANCE_MM

MATERIAL = load_material()
BEAD, GAP = MATERIAL.ink.bead_width, MATERIAL.gap


def square(side: float, *, turn: float = 0.0, hole: tuple[float, float, float] | None = None, step: float = 1.0) -> tuple[Mesh, Piece]:
    """A flat square about the origin, turned; `hole` is a square one, (x, y, half of its side)."""
    n = round(side / step)
    x, y = (c.ravel() for c in np.meshgrid(np.linspace(-side / 2, side / 2, n + 1), np.linspace(-side / 2, side / 2, n + 1)))
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    F = np.concatenate([np.column_stack([a, a + 1, a + n + 2]), np.column_stack([a, a + n + 2, a + n + 1])])
    flat = np.column_stack([x, y])
    if hole is not None:
        F = F[~(np.abs(flat[F].mean(axis=1) - hole[:2]) < hole[2]).all(axis=1)]
    used, F = np.unique(F, return_inverse=True)
    F, flat = F.reshape(-1, 3), flat[used] @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    mesh = Mesh(np.column_stack([flat, np.zeros(len(flat))]), F, "square")
    return mesh, Piece("P1", np.arange(len(F)), np.arange(len(flat)), F, flat)


def outline(piece: Piece) -> shapely.Polygon:
    rim, *holes = (piece.UV[loop] for loop in piece.topology.boundary_loops)
    return shapely.Polygon(rim, holes)


def chords(sensor: Sensor, tolerance: float) -> shapely.LineString:
    return shapely.LineString(sensor.printed_path.to_polyline(tolerance=tolerance))


# -- arcs that are none -------------------------------------------------------------------------------------------------


def test_a_lead_that_stops_at_the_circles_box_starts_no_arc_of_that_circle() -> None:
    # The peer (TSDF) leads to x = l and begins the arc there: a strict interpreter refuses an arc off its circle.
    seed = itertools.product((15.0, 22.0, 32.0, 45.0), (1.7, 2.4, 3.2), (1.5, 3.0, 5.0, 8.0))
    off, ours = [], []
    for s, x, b in seed:
        if ContactSpiral.half_turns_max(s=s, x=x, pitch_min=BEAD + GAP) < 1 or b > s - 2 * x:
            continue
        off.append(math.dist((5.0, 0.0), (5.0 + s / 2, b / 2)) - s / 2)
        arcs = [p for p in ContactSpiral(n=1, x=x, b=b, l=5.0, s=s).path().segments if isinstance(p, Arc)]
        ends = np.array([[np.hypot(*np.round(e - a.centre, 4)) for e in (a.start, a.end)] for a in arcs])
        ours.append(np.abs(ends[:, 1] - ends[:, 0]).max())
    assert len(off) >= 40 and min(off) > ARC_RADIUS_MM  # every one of them
    assert max(ours) <= ARC_RADIUS_MM


# -- chords, and points ---------------------------------------------------------------------------------------------


def test_chords_hide_an_overhang() -> None:
    # A quarter of a millimetre of chord tolerance, and the bead's round edge as a polygon: common, and inside.
    _, piece = square(60)
    spiral = ContactSpiral(n=3, x=3.2, b=8, l=8, s=45, pad=0)
    no_margin = dataclasses.replace(MATERIAL, margin=0.0)
    hidden = []
    for angle in np.deg2rad(np.arange(0, 360, 10)):
        sensor = Sensor("C1", "P1", spiral, 0.0, 0.0, angle, 0)
        ink = chords(sensor, 0.25).buffer(BEAD / 2, quad_segs=2)
        # As far to the left as its chords allow.
        sensor = dataclasses.replace(sensor, x=-30 - ink.bounds[0] + 1e-9, y=-(ink.bounds[1] + ink.bounds[3]) / 2)
        assert outline(piece).contains(chords(sensor, 0.25).buffer(BEAD / 2, quad_segs=2))
        hidden.append(BEAD / 2 - distance(Curves.of_segments(sensor.printed_path.segments), edge_curves(piece)))
        if hidden[-1] > CLEARANCE_MM:
            (said,) = check_sensor(piece, sensor, (), material=no_margin)
            assert "C1 is " in said and "outside piece P1" in said
    assert max(hidden) > 0.1 and np.mean(np.array(hidden) > 0.01) > 0.5


def test_points_inside_are_no_path_inside() -> None:
    # All corners of the conductor lie on the piece; the line between two of them runs over a hole.
    _, piece = square(80, hole=(0.0, 0.0, 5.0))
    strain = Sensor("S1", "P1", StrainLines(l1=50, l2=40, b=6, pad=0), -25.0, -3.0, 0.0, 0)
    corners = [e for s in strain.path.segments for e in (s.start, s.end)]
    assert all(outline(piece).covers(shapely.Point(c)) for c in corners)
    assert any("outside piece P1" in said for said in check_sensor(piece, strain, (), material=MATERIAL))


def test_an_outline_without_its_holes_is_not_the_piece() -> None:
    # Inside the outermost turn and off every bead, but not by the margin: a filled outline sees nothing.
    _, piece = square(80, hole=(0.0, 0.0, 2.0))
    spiral = ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=22.0)
    sensor = Sensor("C1", "P1", spiral, *(-spiral.middle), 0.0, 0)
    assert shapely.Polygon(outline(piece).exterior).contains(chords(sensor, 1e-3).buffer(BEAD))
    (said,) = check_sensor(piece, sensor, (), material=MATERIAL)
    assert "outside piece P1" in said or "too close to the edge" in said


def test_verdicts_are_those_of_fine_chords_but_for_what_chords_cannot_tell() -> None:
    rng, fine = np.random.default_rng(4), 1e-4
    _, piece = square(70, hole=(8.0, 4.0, 3.0))
    room = outline(piece)
    patterns = [make_pattern(kind, {**params, "bead": BEAD, "gap": GAP}) for kind, params in FITTING.items()]
    judged = {True: 0, False: 0}
    for k in range(120):
        pattern = patterns[k % len(patterns)]
        x, y, angle = rng.uniform((-38, -38, 0), (38, 38, 2 * np.pi))
        sensor = Sensor("C1", "P1", pattern, x, y, angle, 0)
        line = chords(sensor, fine)
        apart = line.distance(room.boundary) if room.contains(line) else -1.0
        if abs(apart - BEAD / 2 - MATERIAL.margin) <= 2 * fine:
            continue
        fits = apart > BEAD / 2 + MATERIAL.margin
        assert (check_sensor(piece, sensor, (), material=MATERIAL) == []) == fits
        judged[fits] += 1
    assert min(judged.values()) > 20


FITTING = {
    "contact-spiral": {"n": 2, "x": 1.7, "b": 1.5, "l": 3, "s": 14},
    "strain-lines": {"l1": 20, "l2": 12, "b": 5},
    "strain-neck": {"l1": 5, "l2": 16, "l3": 11, "b1": 1.5, "b2": 10},
}


# -- right on the bound ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("margin", [0.0, 1.0])
def test_touching_is_allowed_at_any_angle(margin: float) -> None:
    # A spiral that touches the margin's line: by rounding, a plain comparison refuses it or not as the piece is turned.
    spiral = ContactSpiral(n=2, x=1.7, b=1.5, l=3, s=15)
    material = dataclasses.replace(MATERIAL, margin=margin)
    lowest = spiral.b / 2 - spiral.s / 2
    plain, ours, nearer = [], [], []
    for turn in np.linspace(0, 2 * np.pi, 40, endpoint=False):
        _, piece = square(60, turn=turn, step=60)

        def put(y: float, turn: float = turn) -> Sensor:
            c, s = np.cos(turn), np.sin(turn)
            return Sensor("C1", "P1", spiral, -5 * c - y * s, -5 * s + y * c, turn, 0)

        touching = put(-30 + BEAD / 2 + margin - lowest)
        plain.append(distance(Curves.of_segments(touching.printed_path.segments), edge_curves(piece)) >= BEAD / 2 + margin)
        ours.append(check_sensor(piece, touching, (), material=material) == [])
        nearer.append(check_sensor(piece, put(-30 + BEAD / 2 + margin - lowest - 2 * CLEARANCE_MM), (), material=material) == [])
    assert any(plain) and not all(plain)
    assert all(ours) and not any(nearer)


def test_a_count_is_not_lost_to_rounding() -> None:
    # Diameters that n half-turns fill exactly: written in decimals, the quotient falls just short of a whole number.
    plain_short, ours_short = 0, 0
    for n, x in itertools.product(range(1, 13), np.round(np.arange(1.4, 4.0, 0.1), 1)):
        s = round(2 * ((n + 1) * x + (BEAD + GAP) / 2), 3)
        plain_short += math.floor((s / 2 - (BEAD + GAP) / 2) / x) - 1 < n
        ours_short += ContactSpiral.half_turns_max(s=s, x=x, pitch_min=BEAD + GAP) < n
    assert plain_short > 20 and ours_short == 0


def test_a_pitch_that_is_the_sum_of_bead_and_gap_is_allowed() -> None:
    assert not 0.3 >= 0.1 + 0.2
    assert StrainLines(l1=20, l2=10, b=0.9, bead=0.1, gap=0.2, pad=0).b == 0.9


# -- parameters that cross themselves -------------------------------------------------------------------------------------


class _FreeSpiral(ContactSpiral):
    """Drawn as asked, whatever is asked."""

    def __post_init__(self) -> None: ...


class _FreeNeck(StrainNeck):
    def __post_init__(self) -> None: ...


class _FreeLines(StrainLines):
    def __post_init__(self) -> None: ...


SPIRAL = {"n": 3, "x": 2.0, "b": 3.0, "l": 6.0, "s": 22.0}
NECK = {"l1": 15.0, "l2": 40.0, "l3": 32.0, "b1": 2.0, "b2": 12.0}
LINES = {"l1": 60.0, "l2": 54.0, "b": 6.0}


@pytest.mark.parametrize(
    ("free", "checked", "params", "parameter"),
    [
        (_FreeSpiral, ContactSpiral, {**SPIRAL, "x": 0.7}, "x"),  # turns run into each other
        (_FreeSpiral, ContactSpiral, {**SPIRAL, "b": 1.0}, "b"),  # the leads touch
        (_FreeSpiral, ContactSpiral, {**SPIRAL, "l": 0.3}, "l"),  # the pads touch the turns
        (_FreeNeck, StrainNeck, {**NECK, "b1": 10.0}, "b2"),  # corners without room: the neck runs backwards
        (_FreeNeck, StrainNeck, {**NECK, "l3": 44.0}, "l2"),  # the loops run over the neck
        (_FreeNeck, StrainNeck, {**NECK, "l3": 2.0}, "l3"),  # the loops turn inside out
        (_FreeLines, StrainLines, {**LINES, "b": 3.0}, "b"),
    ],
)
def test_what_would_cross_itself_is_refused(free: type[Pattern], checked: type[Pattern], params: dict, parameter: str) -> None:
    drawn = Sensor("C1", "P1", free(**params), 0.0, 0.0, 0.0, 0)
    line = chords(drawn, 1e-3)
    need = BEAD + GAP
    assert not line.is_simple or own_clearance(drawn, need=need) < need - CLEARANCE_MM
    with pytest.raises(PatternError) as refused:
        checked(**params)
    assert refused.value.parameter == parameter
    mended = Sensor("C1", "P1", checked(**{**params, parameter: refused.value.nearest}), 0.0, 0.0, 0.0, 0)
    assert chords(mended, 1e-3).is_simple and own_clearance(mended, need=need) >= need - CLEARANCE_MM


@pytest.mark.parametrize("params", [{**SPIRAL, "n": 5}, {**SPIRAL, "n": 4, "s": 20.0}])
def test_a_turn_without_a_radius_is_refused_in_the_patterns_words(params: dict) -> None:
    with pytest.raises(PathError, match=r"^arc radius is -?\d+ mm"):
        _FreeSpiral(**params).path()
    with pytest.raises(PatternError, match=r"no more than \d half-turns? fits?; the nearest value that works is \d$"):
        ContactSpiral(**params)


def test_a_lead_beyond_the_turns_would_lie_askew() -> None:
    lead = _FreeSpiral(**{**SPIRAL, "b": 19.0}).path().segments[-1]
    assert lead.start[1] != pytest.approx(lead.end[1], abs=0.1)
    with pytest.raises(PatternError, match=r"b is 19\.0; it must be at most 18 \(the upper lead must meet the outer turn"):
        ContactSpiral(**{**SPIRAL, "b": 19.0})
    lead = ContactSpiral(**{**SPIRAL, "b": 18.0}).path().segments[-1]
    assert lead.start[1] == pytest.approx(lead.end[1], abs=1e-7)


def test_no_pattern_takes_all_memory() -> None:
    for params in ({**SPIRAL, "n": 10**12}, {**SPIRAL, "s": 1e12, "n": 10**9}, {**SPIRAL, "s": 1e308}):
        with pytest.raises(PatternError):
            ContactSpiral(**params)
    with pytest.raises(InputError, match=r"b would have to be at least 1384998\.615 .* no bed is larger than 1000 mm; make the other"):
        StrainLines(**LINES, lines=10**6)
    # The longest there can be: the finest bead on the largest bed.
    finest = {"bead": 0.05, "gap": 0.0, "pad": 0.0}
    n = ContactSpiral.half_turns_max(s=1000.0, x=0.05, pitch_min=0.05)
    assert len(ContactSpiral(n=n, x=0.05, b=0.05, l=1.0, s=1000.0, **finest).path().segments) < 30_000


# -- larger than the piece --------------------------------------------------------------------------------------------------


def test_a_ring_round_the_piece_meets_no_edge() -> None:
    # "It crosses nothing" is true of a sensor with the whole piece inside one of its turns.
    _, piece = square(6, step=6)
    hairpin = StrainLines(l1=60, l2=50, b=40, lines=2)
    sensor = Sensor("S1", "P1", hairpin, -30.0, -20.0, 0.0, 0)
    assert distance(Curves.of_segments(sensor.printed_path.segments), edge_curves(piece)) > BEAD / 2 + MATERIAL.margin
    (said,) = check_sensor(piece, sensor, (), material=MATERIAL)
    assert "outside piece P1, which spans -3 to 3 x -3 to 3 mm" in said
    with pytest.raises(RefusedError, match="outside piece P1"):
        validate(SimpleNamespace(pieces=(piece,), sensors=(sensor,)), MATERIAL)


@pytest.fixture
def ask(tmp_path: Path) -> Callable[[tuple[Mesh, Piece], Pattern], Sensor]:
    def place(made: tuple[Mesh, Piece], pattern: Pattern) -> Sensor:
        own = {k: v for k, v in parameters(pattern).items() if not isinstance(v, bool)}
        table = ", ".join(f"{name} = {value}" for name, value in own.items())
        file = tmp_path / "sensors.toml"
        file.write_text(f'[[sensor]]\nkind = "{pattern.kind}"\nparams = {{ {table} }}\npose = "auto"\n')
        (sensor,), _ = place_from_file(file, made[0], [made[1]], material=MATERIAL)
        return sensor

    return place


@pytest.mark.parametrize("side", [1.0, 4.0, 30.0])
@pytest.mark.parametrize("pattern", [ContactSpiral(n=3, x=3.2, b=8, l=8, s=45), StrainLines(l1=60, l2=54, b=6), StrainNeck(**NECK)])
def test_a_pattern_larger_than_the_piece_is_refused(ask: Callable, side: float, pattern: Pattern) -> None:
    # Naming the size of the pattern's box would not do: 60 mm of strain sensor fit on the diagonal of a 50 mm square.
    with pytest.raises(RefusedError, match=r"it fits on no piece, whose largest free circle is \d+\.\d mm"):
        ask(square(side), pattern)


def test_a_pattern_longer_than_the_side_goes_on_the_diagonal(ask: Callable) -> None:
    made = square(52.0)
    strain = StrainLines(l1=54, l2=48, b=6)
    sensor = ask(made, strain)
    assert check_sensor(made[1], sensor, (), material=MATERIAL) == []
    assert strain.l1 + 2 * MATERIAL.margin + BEAD > 52.0
