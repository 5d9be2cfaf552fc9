"""A simulated skin with tactels under it: as small as the seed's figures allow.

Each tactel reads the strain of an elastic half space at the skin's depth, averaged over its electrode (`response`), times a gain
of its own; the electronics turn that into a voltage (the seed's equation 3) with white noise. The finger is unrolled: angles are
kept, and lengths around it are those on the core. A rod that is pressed on lies on a springy bed: its contact is a straight line whose
pressure falls as a parabola to zero at its ends, longer and flatter the more it lies along the finger.

What it leaves out is in docs/array.md, and so is what each term of it changes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.array.geometry import TOP_V, Geometry
from skinfab.fingertip.array.response import add_force

FloatArray = NDArray[np.float64]

#: Voltage of an untouched tactel, and how much these differ.
REST_V, REST_SCATTER = 1.0, 0.05
#: By how much 2 N press a rod across the finger into the skin, mm (seed, section 6).
DENT_MM, DENT_N = 0.6, 2.0
#: Length of its contact over that of the cut. The one number chosen to fit: with it the seed's way of finding a rod's direction errs by
#: 20 degrees at 50, between two stripes, as the seed measured.
STRETCH = 1.5
#: A rod is no longer than the finger, mm.
LONGEST_MM = 25.0
#: Points that stand for a line of pressure.
_NODES = 16


@dataclass(frozen=True)
class Rubber:
    """What the skin is made of.

    Parameters
    ----------
    young : float, N/mm^2
        Assumed: the seed gives none. It scales readings and cancels in every place and angle.
    poisson : float
        0.5 is rubber; at 0 a tactel reads stress, as a soft electrode on the hard core would.
    """

    young: float = 0.4
    poisson: float = 0.5


@dataclass(frozen=True)
class Errors:
    """What no real array is free of.

    Parameters
    ----------
    noise : float
        Standard deviation of a reading, as a part of the gap: one percent of what 50 g read over a tactel.
    gain_scatter : float
        Standard deviation of the tactels' gains.
    """

    noise: float = 2e-4
    gain_scatter: float = 0.03


NO_ERRORS = Errors(0.0, 0.0)


def contact_line(force_n: float, line_rad: float, radius_mm: float) -> float:
    """Length of a rod's contact, mm.

    Across the finger (0) 2 N press it in by 0.6 mm, and the seed's equation 11 gives the width of what would be cut off; the skin
    yields beyond that (`STRETCH`). Turned by an angle g it lies on a curvature that is cos^2 g smaller, and the same force spreads
    over more of it: on a springy bed its length grows as cos(g)^(-2/3), up to the whole rod's.

    Examples
    --------
    >>> round(contact_line(2.0, 0.0, 12.7), 2), round(contact_line(2.0, math.pi / 4, 12.7), 2)
    (11.57, 14.58)
    """
    dent = min(DENT_MM * (max(force_n, 0.0) / DENT_N) ** (2 / 3), radius_mm)
    width = STRETCH * 2 * math.sqrt(dent * (2 * radius_mm - dent))
    return min(width * max(abs(math.cos(line_rad)), 1e-9) ** (-2 / 3), LONGEST_MM)


def line_nodes(length_mm: float, count: int = _NODES) -> tuple[FloatArray, FloatArray]:
    """Points along a line, mm from its middle, and the share of the force on each: Gauss-Jacobi for the parabola 1 - t^2."""
    from scipy.special import roots_jacobi

    t, w = roots_jacobi(count, 1, 1)
    return t * length_mm / 2, w / w.sum()


class Skin:
    """The tactels' answer to what touches the skin.

    Parameters
    ----------
    geometry : Geometry
    rubber : Rubber
    gains : (rings, stripes) float, optional
        1 where nothing is said.

    Examples
    --------
    >>> Z = Skin(Geometry()).pressed(0.5, axial_mm=11.1, angle_rad=0.0)
    >>> Z.shape, float(Z.max().round(4)), bool(np.allclose(Z[:, 1], Z[:, 7]))
    ((8, 8), 0.0216, True)
    """

    def __init__(self, geometry: Geometry, rubber: Rubber | None = None, *, gains: FloatArray | None = None) -> None:
        self.geometry, self.rubber = geometry, rubber or Rubber()
        self.gains = np.ones(geometry.shape) if gains is None else gains

    def pressed(self, force_n: float, *, axial_mm: float, angle_rad: float, shear_n: tuple[float, float] = (0.0, 0.0)) -> FloatArray:
        """Deflections of a force on one point, (rings, stripes); `shear_n` is its part along and around."""
        return self.points([(force_n, *shear_n)], [(axial_mm, angle_rad)])

    def points(self, forces: Sequence[tuple[float, float, float]], places: Sequence[tuple[float, float]]) -> FloatArray:
        """Deflections of several forces (normal, along, around; N) at places (mm, rad)."""
        g = self.geometry
        out = np.zeros(g.shape)
        for force, (axial, angle) in zip(forces, places, strict=True):
            # Compiled once, for floats: a force of 2 N and one of 2.0 N are the same.
            normal, along, around = map(float, force)
            place = (float(axial), float(angle) * g.core_radius)
            add_force(out, (normal, along, around), place, g.pitch, g.half, g.skin, self.rubber.poisson)
        return out * self.gains / self.rubber.young

    def lined(self, force_n: float, *, axial_mm: float, angle_rad: float, line_rad: float, length_mm: float | None = None) -> FloatArray:
        """Deflections of a rod; `line_rad` counts from across the finger, and `length_mm` is that of `contact_line` where left out."""
        length = contact_line(force_n, line_rad, self.geometry.finger_radius) if length_mm is None else length_mm
        along, share = line_nodes(length)
        places = [(axial_mm + t * math.sin(line_rad), angle_rad + t * math.cos(line_rad) / self.geometry.finger_radius) for t in along]
        return self.points([(force_n * w, 0.0, 0.0) for w in share], places)

    def plated(self, force_n: float, *, axial_mm: float, angle_rad: float, size_mm: float) -> FloatArray:
        """Deflections of an even pressure on a square of the skin, measured on the core."""
        t = (np.arange(_NODES) + 0.5) / _NODES - 0.5
        places = [(axial_mm + u * size_mm, angle_rad + v * size_mm / self.geometry.core_radius) for u in t for v in t]
        return self.points([(force_n / len(places), 0.0, 0.0)] * len(places), places)


@dataclass(frozen=True, eq=False)
class Device:
    """One array as it was built: a skin with gains of its own, and its electronics.

    Parameters
    ----------
    geometry : Geometry
    rubber : Rubber
    errors : Errors
    seed : int
        Of the gains and the voltages at rest.
    """

    geometry: Geometry = field(default_factory=Geometry)
    rubber: Rubber = Rubber()
    errors: Errors = Errors()
    seed: int = 0

    @cached_property
    def skin(self) -> Skin:
        """With this device's gains."""
        rng = np.random.default_rng((self.seed, 1))
        return Skin(self.geometry, self.rubber, gains=1 + self.errors.gain_scatter * rng.standard_normal(self.geometry.shape))

    @cached_property
    def rest_v(self) -> FloatArray:
        """V0 of each tactel."""
        rng = np.random.default_rng((self.seed, 2))
        return REST_V * (1 + REST_SCATTER * rng.standard_normal(self.geometry.shape))

    def noisy(self, Z: FloatArray, rng: np.random.Generator) -> FloatArray:
        """Deflections (..., rings, stripes) as they are read."""
        return Z + self.errors.noise * rng.standard_normal(Z.shape)

    def volts(self, Z: FloatArray, rng: np.random.Generator) -> FloatArray:
        """VS of deflections (..., rings, stripes): V0 / (1 - deflection), up to the end of the range."""
        out: FloatArray = np.minimum(self.rest_v / np.maximum(1 - self.noisy(Z, rng), REST_V / (2 * TOP_V)), TOP_V)
        return out

    def without(self, **terms: float) -> Device:
        """The same with other errors, for ablations."""
        return replace(self, errors=replace(self.errors, **terms))


def deflection(volts: FloatArray, rest_v: FloatArray) -> FloatArray:
    """1 - V0/VS (the seed's equation 3): NaN where there is no voltage.

    Parameters
    ----------
    volts : (..., rings, stripes) float
    rest_v : (rings, stripes) float

    Raises
    ------
    InputError
        A voltage at rest is not above zero.

    Examples
    --------
    >>> deflection(np.array([[1.25]]), np.array([[1.0]])).round(3)
    array([[0.2]])
    """
    if not (rest_v > 0).all():
        i, j = np.argwhere(~(rest_v > 0))[0]
        raise InputError(f"tactel r{i}s{j} reads {rest_v[i, j]:g} V at rest; a deflection needs a voltage above zero: look at its wires")
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(volts > 0, 1 - rest_v / volts, np.nan)
