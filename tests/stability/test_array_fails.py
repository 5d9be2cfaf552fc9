"""Where reading a tactel array fails: what the usual way does there, so that the case is real, and what the project's does."""

import math

import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.array.analyser import Analyser
from skinfab.fingertip.array.contours import contour
from skinfab.fingertip.array.force import point_force
from skinfab.fingertip.array.geometry import Geometry, wrapped
from skinfab.fingertip.array.interpolate import SINC, kernel, on_grid, surface_at
from skinfab.fingertip.array.line_fit import LineFinder
from skinfab.fingertip.array.logs import of_recording
from skinfab.fingertip.array.matched import ArrayModel, Matcher
from skinfab.fingertip.array.orientation import SpanFinder, folded
from skinfab.fingertip.array.parabola import log_parabola
from skinfab.fingertip.array.peak import PeakFinder
from skinfab.fingertip.array.protocols import presses
from skinfab.fingertip.array.simulator import Device, Rubber, Skin
from skinfab.fingertip.array.tracking import Place, Tracker
from skinfab.readout.frame import Recording

SEED = Geometry()
SKIN = Skin(SEED)
FIND, MATCH = PeakFinder(SEED), Matcher(ArrayModel.nominal(SEED), noise=2e-4)
READ = Analyser(ArrayModel.nominal(SEED), noise=2e-4)


def bare_newton(Z: np.ndarray, x: float, y: float, steps: int = 20) -> tuple[float, float, bool]:
    """The seed's equation 9 as it stands; the end, and whether its equation 8 is met there."""
    fxx = fyy = math.nan
    for _ in range(steps):
        _, fx, fy, fxx, fxy, fyy = surface_at(Z, SINC, x, y)
        D = fxx * fyy - fxy * fxy
        if D == 0 or not math.isfinite(D):
            return x, y, False
        dx, dy = -(fyy * fx - fxy * fy) / D, -(fxx * fy - fxy * fx) / D
        x, y = x + dx, y + dy
        if math.hypot(dx, dy) < 0.01:
            break
    return x, y, bool(fxx < 0 and fyy < 0)


def test_the_printed_window_erases_the_readings() -> None:
    """The seed's equation 5, read from each sample on, is zero at the sample: its surface is zero wherever it was measured."""
    Z = SKIN.pressed(0.5, axial_mm=11.1, angle_rad=0.0)

    def window(n: float) -> float:
        return 0.5 * (1 - math.cos(2 * math.pi * n / 7)) if 0 <= n <= 7 else 0.0

    at_peak = sum(Z[i, j] * np.sinc(3 - i) * np.sinc(j) * window(3 - i) * window(-j) for i in range(8) for j in range(8))
    assert at_peak == pytest.approx(0, abs=1e-12)
    assert surface_at(Z, SINC, 3.0, 0.0)[0] == pytest.approx(Z[3, 0]) and kernel(SINC, 0.0)[0] == 1


def test_equation_8_takes_a_saddle_for_a_peak() -> None:
    """Both second derivatives are negative along the axes, and the determinant is not positive: two contacts askew."""
    Z = np.zeros((8, 8))
    for k, height in ((0, 1.0), (1, 0.55), (2, 1.0)):
        Z[3 + k, 3 + k] = height
    x, y = np.meshgrid(np.linspace(3, 5, 41), np.linspace(3, 5, 41), indexing="ij")
    taken = []
    for a, b in zip(x.ravel(), y.ravel(), strict=True):
        p, q, accepted = bare_newton(Z, float(a), float(b))
        if accepted and 3 < p < 5:
            _, _, _, fxx, fxy, fyy = surface_at(Z, SINC, p, q)
            taken.append(fxx * fyy - fxy * fxy < 0)
    assert any(taken)
    assert FIND(Z).state == "peak" and FIND(Z).height > 0.95
    for peak in FIND.all(Z):
        _, _, _, fxx, fxy, fyy = surface_at(Z, SINC, *SEED.to_tactels(peak.axial_mm, peak.angle_rad))
        assert fxx < 0 and fxx * fyy - fxy**2 > 0


def test_bare_newton_leaves_the_array() -> None:
    """A weak contact in noise: steps of any length, along slopes that bend up."""
    rng, device = np.random.default_rng(0), Device()
    lost = 0
    for _ in range(200):
        Z = device.noisy(SKIN.pressed(0.01, axial_mm=rng.uniform(0, 25.9), angle_rad=rng.uniform(-3, 3)), rng)
        i, j = np.unravel_index(int(Z.argmax()), Z.shape)
        x, y, accepted = bare_newton(Z, float(i), float(j))
        lost += not accepted or abs(x - i) > 1.5 or abs(y - j) > 1.5
        peak = FIND(Z)
        assert 0 <= peak.axial_mm < 25.91 and abs(peak.axial_mm / 3.7 - i) <= 1.5
        assert peak.state in ("peak", "edge") or (peak.state == "flat" and (Z > 0.9 * Z.max()).sum() >= 3)
    assert lost > 0


def test_a_flat_top_has_no_peak() -> None:
    Z = np.zeros((8, 8))
    Z[2:6, 2:6] = 1.0
    x, y, accepted = bare_newton(Z, 2.0, 2.0)
    assert not accepted or math.hypot(x - 3.5, y - 3.5) > 1  # the corner's ringing, or nothing
    peak = FIND(Z)
    assert peak.state == "flat" and SEED.to_tactels(peak.axial_mm, peak.angle_rad) == pytest.approx((3.5, 3.5))
    assert READ.frame(0.0, 0.02 * Z).state == "wide"


def test_two_contacts_closer_than_the_array_can_part_have_one_peak() -> None:
    """1.2 tactels apart: one peak between them, where nothing touches."""
    Z = SKIN.points([(0.5, 0, 0)] * 2, [(10.0, 0.2), (10.0 + 1.2 * 3.7, 0.2)])
    (only,) = FIND.all(Z)
    assert min(abs(only.axial_mm - 10.0), abs(only.axial_mm - 14.44)) > 1.0
    found = MATCH(Z)
    assert found.state == "two" and sorted(c.axial_mm for c in found.contacts) == pytest.approx([10.0, 14.44], abs=0.1)
    assert READ.frame(0.0, Z).state in ("several", "line", "patch")  # and in no case a point


def test_a_contact_beyond_the_last_ring_is_drawn_in() -> None:
    Z = SKIN.pressed(0.5, axial_mm=-2.0, angle_rad=0.3)
    assert bare_newton(Z, 0.0, 0.0)[0] > -0.3 or not bare_newton(Z, 0.0, 0.0)[2]  # 0.54 tactels out
    assert FIND(Z).state == "edge"
    (only,) = MATCH(Z).contacts
    assert MATCH(Z).state == "edge" and only.axial_mm == pytest.approx(-2.0, abs=0.1)
    assert MATCH(SKIN.pressed(2.0, axial_mm=-3.7, angle_rad=0.3)).state == "past"
    assert MATCH(SKIN.pressed(2.0, axial_mm=25.9 + 3.7, angle_rad=0.3)).state == "past"


def test_an_axis_that_is_not_closed_loses_the_seam() -> None:
    """A contact between the last stripe and the first: a grid that ends there puts it on one of them."""
    Z = SKIN.pressed(0.5, axial_mm=11.1, angle_rad=-math.pi / 8)
    y = np.linspace(0, 7, 701)
    flat = map_coordinates(Z, [np.full(701, 3.0), y], order=3)
    assert min(abs(y[flat.argmax()] - 7.5), abs(y[flat.argmax()] + 0.5)) >= 0.5
    assert wrapped(FIND(Z).angle_rad + math.pi / 8) == pytest.approx(0, abs=0.01)


@pytest.mark.parametrize("axis", ["along", "around"])
def test_aliasing_not_noise_rules_interpolation(axis: str) -> None:
    """Without any noise at all the sinc errs by half a millimetre, and twelve degrees."""
    at = np.linspace(0, 1, 21)
    if axis == "along":
        frames = [(SKIN.pressed(0.5, axial_mm=11.1 + 3.7 * t, angle_rad=0.0), 11.1 + 3.7 * t) for t in at]
        naive = max(abs(FIND(Z).axial_mm - true) for Z, true in frames)
        ours = max(abs(MATCH(Z).contacts[0].axial_mm - true) for Z, true in frames)
        assert naive > 0.45 and ours < 0.01
    else:
        frames = [(SKIN.pressed(0.5, axial_mm=11.1, angle_rad=t * math.pi / 4), t * math.pi / 4) for t in at]
        naive = max(abs(wrapped(FIND(Z).angle_rad - true)) for Z, true in frames)
        ours = max(abs(wrapped(MATCH(Z).contacts[0].angle_rad - true)) for Z, true in frames)
        assert math.degrees(naive) > 10 and math.degrees(ours) < 0.1


def test_three_tactels_are_not_enough_round_the_finger() -> None:
    """The cheapest way takes logarithms, and neighbours that read less than nothing have none."""
    Z = Device().noisy(SKIN.pressed(0.5, axial_mm=11.1, angle_rad=0.05), np.random.default_rng(1))
    assert (Z[3, [1, 7]] < 0).any()
    angle = SEED.from_tactels(*log_parabola(Z))[1]  # pinned to the stripe
    worst = []
    for t in np.linspace(-0.39, 0.39, 21):
        Z = SKIN.pressed(0.5, axial_mm=11.1, angle_rad=float(t))
        worst.append(abs(wrapped(SEED.from_tactels(*log_parabola(Z))[1] - t)) - abs(wrapped(MATCH(Z).contacts[0].angle_rad - t)))
    assert angle == 0.0 and max(worst) > math.radians(1.4)  # and with noise up to 6 degrees


def test_a_dead_tactel_moves_the_peak() -> None:
    Z = SKIN.pressed(0.5, axial_mm=12.2, angle_rad=0.3)
    Z[3, 0] = np.nan  # the highest but one
    assert abs(FIND(np.nan_to_num(Z)).axial_mm - 12.2) > 1
    assert FIND(Z).state == "flat" and abs(FIND(Z).axial_mm - 12.2) < 1  # where the summit may be missing, that is said
    (only,) = MATCH(Z).contacts
    assert (only.axial_mm, only.angle_rad) == pytest.approx((12.2, 0.3), abs=0.01)


def test_a_saturated_tactel_flattens_the_top() -> None:
    """Its reading is what the electronics can say, not what is there: here that of half of the highest deflection."""
    device = Device(seed=1)
    recording = presses(device, 12)
    values, log = recording.values.copy(), of_recording(recording, name="a")
    full = np.zeros(values.shape, dtype=bool)
    for k in log.touched():
        full[k, int(np.nanargmax(log.Z[k]))] = True
    rest = np.median(values[:15], axis=0)
    values[full] = np.broadcast_to(rest, values.shape)[full] / (1 - np.nanmax(log.Z, axis=(1, 2))[full.any(axis=1)] / 2)
    marked = Recording(
        recording.stream,
        recording.device_time,
        recording.host_time,
        recording.sequence,
        values,
        recording.valid,
        recording.saturated | full,
    )
    naive, cut = (
        of_recording(Recording.of_values(recording.stream, values, device_time=recording.device_time), name="a"),
        of_recording(marked, name="a"),
    )
    assert np.isnan(cut.Z[cut.saturated]).all() and cut.saturated.sum() == len(log.touched())
    match = Matcher(ArrayModel(SEED, Rubber(), device.skin.gains))
    errors = [
        (abs(match.one(naive.Z[k])[0] - log.truth["axial_mm"][k]), abs(match.one(cut.Z[k])[0] - log.truth["axial_mm"][k]))
        for k in log.touched()
    ]
    taken, left_out = np.median(errors, axis=0)
    assert left_out < 0.5 * taken


def test_the_integral_of_rubber_tells_no_force() -> None:
    """The seed's equation 10 on an array: the sum is next to nothing, whatever the force."""
    fine = Geometry(48, 48, 0.8, finger_radius=12.7, skin=2.0)
    hard = float(Skin(fine).pressed(1.0, axial_mm=18.8, angle_rad=0.0).sum())
    soft = float(Skin(fine, Rubber(poisson=0.0)).pressed(1.0, axial_mm=18.8, angle_rad=0.0).sum())
    assert abs(hard) < 0.2 * soft
    with pytest.raises(RefusedError, match="take the force of the matched contact"):
        point_force(SKIN.pressed(1.0, axial_mm=11.1, angle_rad=0.0), SEED, Rubber())
    for force in (0.2, 1.0, 3.0):
        assert MATCH(SKIN.pressed(force, axial_mm=11.1, angle_rad=0.2)).contacts[0].force_n == pytest.approx(force, rel=1e-3)


def test_equation_11_has_no_contour() -> None:
    """f = k and both slopes zero: on no line but at the peak itself."""
    Z = SKIN.pressed(0.5, axial_mm=12.0, angle_rad=0.3)
    points, closed = contour(Z, SINC, SEED, FIND(Z), part=0.5)
    slopes = [math.hypot(*surface_at(Z, SINC, *SEED.to_tactels(x, a))[1:3]) for x, a in points]
    assert closed and min(slopes) > 0.1 * FIND(Z).height


def test_the_arctangent_of_a_quotient_turns_back() -> None:
    """The seed's equation 12 has lost a quadrant: where fy changes sign its direction jumps, and the line is never closed."""
    Z = SKIN.pressed(0.5, axial_mm=12.0, angle_rad=0.3)
    points, _ = contour(Z, SINC, SEED, FIND(Z), part=0.5)
    printed, ours = [], []
    for x, a in points:
        _, fx, fy, *_ = surface_at(Z, SINC, *SEED.to_tactels(x, a))
        printed.append(-math.atan(fx / fy))
        ours.append(math.atan2(-fx, fy))
    assert np.abs(np.diff(printed)).max() > 2  # half a turn back
    assert np.abs([wrapped(step) for step in np.diff(ours)]).max() < 0.4


def test_the_span_of_a_contour_turns_across_the_finger() -> None:
    """Stripes lie farther apart than rings, so that contours are drawn out around the finger, whatever lies on it."""
    Z = SKIN.lined(2.0, axial_mm=13.0, angle_rad=math.pi / 8, line_rad=math.radians(50))
    off = math.degrees(folded(SpanFinder(SEED)(Z).line_rad - math.radians(50)))
    assert off < -10
    line = LineFinder(ArrayModel.nominal(SEED))(Z)
    assert line is not None and math.degrees(abs(folded(line.line_rad - math.radians(50)))) < 1


def test_a_round_contact_points_somewhere_to_the_naive() -> None:
    """A short rod in noise: its direction is a matter of chance, and is not called sure."""
    rng, device = np.random.default_rng(3), Device()
    lines = LineFinder(ArrayModel.nominal(SEED), noise=2e-4)
    naive, sure = [], []
    for _ in range(12):
        Z = device.noisy(SKIN.lined(0.3, axial_mm=13.0, angle_rad=math.pi / 8, line_rad=math.radians(45), length_mm=2.0), rng)
        naive.append(abs(math.degrees(folded(SpanFinder(SEED)(Z).line_rad - math.radians(45)))))
        line = lines(Z)
        assert line is not None
        if line.orientation.sure:
            sure.append(abs(math.degrees(folded(line.line_rad - math.radians(45)))))
    assert max(naive) > 30 and len(sure) <= 3


def test_aliasing_makes_a_rolling_contact_slip() -> None:
    """Round the finger the published peak stands over a stripe and jumps to the next: two slips where there is one roll."""
    angles = np.linspace(0.0, 2.2, 14)
    published, ours = [], []
    for k, angle in enumerate(angles.tolist()):
        Z = SKIN.pressed(1.0, axial_mm=13.0, angle_rad=angle)
        published.append(Place(k / 6, FIND(Z).axial_mm, FIND(Z).angle_rad, 1.0))
        contact = MATCH(Z).contacts[0]
        ours.append(Place(k / 6, contact.axial_mm, contact.angle_rad, contact.force_n))
    assert "slip" in [event.kind for event in Tracker(12.7).follow(published)]
    assert [event.kind for event in Tracker(12.7).follow(ours)] == ["touch", "roll"]


def test_a_log_that_begins_touched_has_no_rest() -> None:
    """Its first reading is taken for none: everything after is less than nothing."""
    recording = presses(Device(), 20)
    late = Recording.of_values(recording.stream, recording.values[15:], device_time=recording.device_time[15:])
    naive = 1 - late.values[0, :64] / late.values[3, :64]
    assert naive.min() < -3e-3  # pulled, by what let go
    with pytest.raises(InputError, match="leave the array untouched"):
        of_recording(late, name="late")


def test_a_skin_that_is_not_as_drawn() -> None:
    """A depth that is off by a fifth: the place hardly moves, and that no one contact explains the frame is seen."""
    Z = Skin(Geometry(skin=4.56, finger_radius=13.46)).pressed(1.0, axial_mm=12.0, angle_rad=0.2)
    axial, around, force, *_ = MATCH.one(Z)
    assert MATCH(Z).state != "one" and force == pytest.approx(1.0, abs=0.1)
    assert axial == pytest.approx(12.0, abs=0.2) and math.degrees(abs(around / SEED.core_radius - 0.2)) < 3


@pytest.mark.parametrize("seed", range(3))
def test_garbage_is_survived(seed: int) -> None:
    rng = np.random.default_rng(seed)
    for Z in (rng.standard_normal((8, 8)), 1e6 * rng.random((8, 8)), np.where(rng.random((8, 8)) < 0.5, np.nan, 0.01), -rng.random((8, 8))):
        reading = READ.frame(0.0, Z)
        assert reading.state in ("none", "point", "line", "patch", "several", "edge", "past", "wide", "pulled")
        assert math.isfinite(reading.place.axial_mm) == (reading.state not in ("none", "pulled"))
        assert on_grid(np.nan_to_num(Z), SINC, np.linspace(0, 7, 5), np.linspace(-9, 9, 5)).shape == (5, 5)
