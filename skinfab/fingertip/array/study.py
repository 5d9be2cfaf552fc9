"""The seed's experiments on simulated arrays: every way of finding a place or a direction, on the same readings."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.array.force import angle_by_split
from skinfab.fingertip.array.geometry import Geometry, wrapped
from skinfab.fingertip.array.interpolate import SINC, on_grid
from skinfab.fingertip.array.layer import LayerDevice
from skinfab.fingertip.array.learn import learn
from skinfab.fingertip.array.line_fit import LineFinder
from skinfab.fingertip.array.logs import of_recording
from skinfab.fingertip.array.matched import ArrayModel, Matcher
from skinfab.fingertip.array.orientation import Orientation, SpanFinder, combined, folded
from skinfab.fingertip.array.parabola import log_parabola
from skinfab.fingertip.array.peak import PeakFinder
from skinfab.fingertip.array.protocols import FRAMES, PRESS_N, ROD_N, presses, pushes, twirl
from skinfab.fingertip.array.simulator import Device
from skinfab.fingertip.array.spot_fit import SpotFinder
from skinfab.fingertip.array.tracking import KINDS, Place, Tracker, centre_of_pressure, matched_events

FloatArray = NDArray[np.float64]

#: The seed's steps: 0.25 mm along a stripe, 3 degrees around a ring.
ALONG_MM, AROUND_DEG = 0.25, 3.0
PUBLISHED, IMPROVED, SPLIT = "sinc", "matched", "odd and even"
#: Directions of the rod, degrees.
LINES_DEG = tuple(range(0, 91, 10))

#: mm and rad of a frame.
Locate = Callable[[FloatArray], tuple[float, float]]
Turn = Callable[[FloatArray], Orientation]


def locators(geometry: Geometry, model: ArrayModel | None = None) -> dict[str, Locate]:
    """Every way of finding a place, by name; the matched one with this model, or with the array as drawn."""
    matcher = Matcher(model or ArrayModel.nominal(geometry))

    def by_peak(finder: PeakFinder) -> Locate:
        def locate(Z: FloatArray) -> tuple[float, float]:
            x, y, *_ = finder.tactels(Z)
            return geometry.from_tactels(x, y)

        return locate

    def by_match(Z: FloatArray) -> tuple[float, float]:
        x, s, *_ = matcher.one(Z)
        return x, wrapped(s / geometry.core_radius)

    found = {name: by_peak(PeakFinder(geometry, name)) for name in (PUBLISHED, "bspline", "gaussian")}
    return found | {"log-parabola": lambda Z: geometry.from_tactels(*log_parabola(Z)), IMPROVED: by_match}


def turners(geometry: Geometry, model: ArrayModel | None = None) -> dict[str, Turn]:
    """Both ways of finding a rod's direction, by name."""
    finder = LineFinder(model or ArrayModel.nominal(geometry))

    def by_fit(Z: FloatArray) -> Orientation:
        line = finder(Z)
        return Orientation(math.nan, 1.0, False) if line is None else line.orientation

    return {"span": SpanFinder(geometry), IMPROVED: by_fit}


@dataclass(frozen=True, eq=False)
class Scan:
    """A tip moved over the array in steps.

    Parameters
    ----------
    axis : str
        ``along`` (mm) or ``around`` (degrees).
    true : (n,) float
    Z : (n, rings, stripes) float
        As read.
    """

    axis: str
    true: FloatArray
    Z: FloatArray

    def errors(self, locate: Locate) -> FloatArray:
        """Found less true, (n,)."""
        k = 0 if self.axis == "along" else 1
        found = np.array([locate(Z)[k] for Z in self.Z])
        if self.axis == "along":
            return found - self.true
        return np.degrees([wrapped(value) for value in found - np.radians(self.true)])


def scan(device: Device, axis: str, *, seed: int = 0) -> Scan:
    """The seed's figure 4 (along a stripe, over the middle of the finger) or 5 (around a ring): 50 g on a small tip."""
    g = device.geometry
    rng = np.random.default_rng((seed, 21 + (axis == "around")))
    stripe, ring = int(rng.integers(g.stripes)), int(rng.integers(g.rings // 3, g.rings - g.rings // 3))
    angle, axial = g.from_tactels(0, stripe)[1], ring * g.ring_pitch
    if axis == "along":
        length = (g.rings - 1) * g.ring_pitch
        true = np.arange(0.2 * length, 0.8 * length, ALONG_MM)
        Z = [device.skin.pressed(PRESS_N, axial_mm=float(x), angle_rad=angle) for x in true]
    else:
        true = np.arange(-180.0, 180.0, AROUND_DEG)
        Z = [device.skin.pressed(PRESS_N, axial_mm=axial, angle_rad=math.radians(a)) for a in true]
    return Scan(axis, true, device.noisy(np.array(Z), rng))


@dataclass(frozen=True, eq=False)
class Rods:
    """A rod laid on the array in all directions.

    Parameters
    ----------
    line_deg : (n,) float
    Z : (n, rings, stripes) float
    """

    line_deg: FloatArray
    Z: FloatArray

    def errors(self, turn: Turn) -> FloatArray:
        """Found less true, degrees, -90 to 90, (n,)."""
        return self.judged(turn)[0]

    def judged(self, turn: Turn) -> tuple[FloatArray, NDArray[np.bool_]]:
        """Errors, and which directions are called sure."""
        found = [turn(Z) for Z in self.Z]
        errors = [_off(one, line) for one, line in zip(found, self.line_deg, strict=True)]
        return np.array(errors), np.array([one.sure for one in found])


def _off(found: Orientation, line_deg: float) -> float:
    """Degrees off; a direction that was not found is off by half of all there are."""
    return math.degrees(folded(found.line_rad - math.radians(line_deg))) if math.isfinite(found.line_rad) else 45.0


def rods_on(device: Device, count: int, *, seed: int = 0, between: bool = False, line_deg: Sequence[float] = LINES_DEG) -> Rods:
    """The seed's figure 11: 2 N on a rod in each direction, `count` times.

    Parameters
    ----------
    device : Device
    count : int
    seed : int
    between : bool
        Only between two stripes, as the seed did by what it says ("in effect only 2 x 7 sensors"); else anywhere around.
    line_deg : sequence of float
    """
    g = device.geometry
    rng = np.random.default_rng((seed, 23))
    directions = np.repeat(np.asarray(line_deg, dtype=float), count)
    Z = []
    for line in directions:
        axial = rng.uniform(0.35, 0.65) * (g.rings - 1) * g.ring_pitch
        stripe = int(rng.integers(g.stripes)) + 0.5 if between else rng.uniform(0, g.stripes)
        angle = g.from_tactels(0, stripe)[1]
        Z.append(device.skin.lined(ROD_N, axial_mm=axial, angle_rad=angle, line_rad=math.radians(float(line))))
    return Rods(directions, device.noisy(np.array(Z), rng))


def tilts(devices: Sequence[Device], count: int, *, seed: int = 0) -> dict[str, FloatArray]:
    """Errors of a force's angle from the normal, degrees, (n, 2) along and around, by each way; NaN where a way finds none.

    The published way splits the profile of the sinc through its peak into its odd and even parts.
    """
    found: dict[str, list[tuple[float, float]]] = {SPLIT: [], IMPROVED: []}
    true: list[tuple[float, float]] = []
    for device in devices:
        recording = pushes(device, count, seed=seed + device.seed)
        log, names = of_recording(recording, name="pushes"), recording.stream.names
        normal, along, around = (recording.values[:, names.index(name)] for name in ("force_n", "along_n", "around_n"))
        model = ArrayModel.nominal(device.geometry)
        spots, finder = SpotFinder(model), Matcher(model)
        for k in log.touched()[::FRAMES]:
            true.append((math.atan2(along[k], normal[k]), math.atan2(around[k], normal[k])))
            x, s, force, *_ = finder.one(log.Z[k])
            found[IMPROVED].append(spots.push(log.Z[k], (x, s / device.geometry.core_radius, force)).tilt_rad)
            found[SPLIT].append(_split_angles(log.Z[k], model))
    return {name: np.degrees(np.array(each) - np.array(true)) for name, each in found.items()}


def _split_angles(Z: FloatArray, model: ArrayModel) -> tuple[float, float]:
    """The angle of a force along and around by the odd and even parts of the sinc's profiles, rad."""
    g, nu = model.geometry, model.rubber.poisson
    x, y, *_ = PeakFinder(g).tactels(Z)

    def kernel(at: FloatArray, P: float, Q: float) -> FloatArray:
        R = np.sqrt(at * at + g.skin**2)
        out: FloatArray = (P * g.skin + Q * at) * (3 * g.skin**2 / R**5 - 2 * nu / R**3)
        return out

    out = []
    for axis in (0, 1):

        def profile(at: FloatArray, axis: int = axis) -> FloatArray:
            along, around = (np.atleast_1d(value) for value in ((x + at / g.ring_pitch, y) if axis == 0 else (x, y + at / g.stripe_pitch)))
            return on_grid(Z, SINC, along, around).ravel()

        try:
            out.append(angle_by_split(profile, 0.0, kernel, g.skin))
        except InputError:
            out.append(math.nan)
    return out[0], out[1]


def on_a_layer(seeds: Sequence[int]) -> dict[str, dict[str, FloatArray]]:
    """Errors along (mm) and around (degrees) on arrays under another field than the matched ways know, by each way.

    ``learned`` is the matched way with a model learned from two logs of 40 presses on the same array.
    """
    out: dict[str, dict[str, list[FloatArray]]] = {"along": {}, "around": {}}
    for seed in seeds:
        device = LayerDevice(seed=seed)
        logs = [of_recording(presses(device, 40, seed=10 * seed + k), name=str(k)) for k in (0, 1)]
        ways = locators(device.geometry)
        ways["learned"] = locators(device.geometry, learn(logs, device.geometry).model)[IMPROVED]
        for axis, by in out.items():
            one = scan(device, axis, seed=seed)
            for name, locate in ways.items():
                by.setdefault(name, []).append(one.errors(locate))
    return {axis: {name: np.concatenate(each) for name, each in by.items()} for axis, by in out.items()}


def three_fingers(devices: Sequence[Device], count: int, *, seed: int = 0) -> dict[str, FloatArray]:
    """Errors, degrees, of the direction that three fingers tell together, by each way."""
    each = [rods_on(device, count, seed=10 * seed + k) for k, device in enumerate(devices)]
    ways = [turners(device.geometry) for device in devices]
    out = {}
    for name in ways[0]:
        found = [[way[name](Z) for Z in rods.Z] for way, rods in zip(ways, each, strict=True)]
        out[name] = np.array([_off(combined(those), line) for *those, line in zip(*found, each[0].line_deg, strict=True)])
    return out


def places_of(Z: FloatArray, time: FloatArray, model: ArrayModel, *, noise: float, published: bool) -> list[Place]:
    """Where a log's finger is touched in each frame: by the centre of pressure, or by the line that matches.

    Parameters
    ----------
    Z : (n, rings, stripes) float
    time : (n,) float, s
    model : ArrayModel
    noise : float
        Standard deviation of a reading; under five of them nothing touches.
    published : bool
    """
    floor = 5 * noise
    finder = LineFinder(model, floor=floor, noise=noise)
    unit = float(Matcher(model).reading_of(1.0))
    out = []
    for t, frame in zip(time.tolist(), Z, strict=True):
        if published:
            top = float(np.nanmax(frame))
            x, a = centre_of_pressure(frame, model.geometry) if top > floor else (math.nan, math.nan)
            out.append(Place(t, x, a, top / unit if top > floor else 0.0))
        elif (line := finder(frame)) is None:
            out.append(Place(t, math.nan, math.nan, 0.0))
        else:
            out.append(Place(t, line.axial_mm, line.angle_rad, line.force_n))
    return out


@dataclass(frozen=True)
class Counted:
    """How many events of a kind there were, were found rightly, and were found in all; the rms error of the right ones' distance, mm."""

    true: int
    right: int
    found: int
    off_mm: float


def twirls(seeds: Sequence[int], *, published: bool, device: Device | None = None) -> dict[str, Counted]:
    """Events found in the seed's twirling, one log a seed, by kind."""
    counts = {kind: [0, 0, 0] for kind in KINDS}
    off: dict[str, list[float]] = {kind: [] for kind in KINDS}
    for seed in seeds:
        own = Device(seed=seed) if device is None else Device(device.geometry, device.rubber, device.errors, seed)
        recording, truth = twirl(own, seed=seed)
        log = of_recording(recording, name="twirl")
        places = places_of(log.Z, log.time, ArrayModel.nominal(own.geometry), noise=log.noise, published=published)
        found = Tracker(own.geometry.finger_radius).follow(places)
        for kind, triple in counts.items():
            triple[0] += sum(event.kind == kind for event in truth)
            triple[2] += sum(event.kind == kind for event in found)
        for k, m in matched_events(truth, found, slack=2 / recording.stream.rate_hz):
            counts[truth[k].kind][1] += 1
            off[truth[k].kind].append(math.hypot(found[m].along_mm - truth[k].along_mm, found[m].around_mm - truth[k].around_mm))
    return {kind: Counted(triple[0], triple[1], triple[2], rms(np.array(off[kind] or [math.nan]))) for kind, triple in counts.items()}


def worst(errors: FloatArray) -> float:
    """Largest size of an error, of which none may be missing."""
    return float(np.abs(errors).max())


def rms(errors: FloatArray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(errors**2)))
