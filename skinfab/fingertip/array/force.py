"""How hard and how much from the side the skin is pressed, out of strains that are all normal to it.

A line of force on a plane (P pressing, Q along the surface, N/mm) strains what lies at depth d below it by

    e(y) = 2 (d^2 - nu y^2) (P d + Q y) / (pi E (y^2 + d^2)^2)

(the seed's equation 6 and its tangential companion). Its integral is P (1 - nu) / E, so the seed's equation 10, P = 2 E times the
integral, holds for nu = 0.5 alone. A force on a point is another matter: there the integral over the plane is
F (1 + nu) (1 - 2 nu) / E, which rubber (nu = 0.5) makes zero, and only the skin's own answer (`skinfab.fingertip.array.matched`)
tells its size.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.simulator import Rubber
from skinfab.tolerances import COMPRESSIBLE, SPLIT_UNEXPLAINED

FloatArray = NDArray[np.float64]

#: Tangential over normal force beyond which nothing sticks.
_STEEPEST = 2.0


def strain_under_line(y: FloatArray, *, depth: float, rubber: Rubber, normal: float, tangential: float = 0.0) -> FloatArray:
    """The strain at places y (mm) across a line of force (N/mm).

    Examples
    --------
    >>> y = np.linspace(-500, 500, 100_001)
    >>> e = strain_under_line(y, depth=3.8, rubber=Rubber(young=1.0, poisson=0.3), normal=1.0)
    >>> round(float(np.trapezoid(e, y)), 2)  # (1 - nu) / E
    0.7
    """
    rr = y * y + depth * depth
    return 2 * (depth**2 - rubber.poisson * y * y) * (normal * depth + tangential * y) / (math.pi * rubber.young * rr * rr)


def line_force(strain: FloatArray, step: float, rubber: Rubber) -> float:
    """Force a length (N/mm) of an even profile of strain, sampled every `step` mm: E / (1 - nu) times its integral.

    Examples
    --------
    >>> y = np.arange(-400, 400, 0.5)
    >>> e = strain_under_line(y, depth=3.8, rubber=Rubber(), normal=2.0)
    >>> round(line_force(e, 0.5, Rubber()), 1)
    2.0
    """
    return rubber.young / (1 - rubber.poisson) * float(np.sum(strain)) * step


def point_force(Z: FloatArray, geometry: Geometry, rubber: Rubber) -> float:
    """Force (N) on the array by the integral of its deflections: E / ((1 + nu) (1 - 2 nu)) times it.

    Raises
    ------
    RefusedError
        The skin hardly changes its volume: the integral is then next to zero whatever the force.

    Examples
    --------
    >>> from skinfab.fingertip.array.simulator import Skin
    >>> soft, fine = Rubber(poisson=0.0), Geometry(32, 32, 1.2, skin=2.0)
    >>> round(point_force(Skin(fine, soft).pressed(0.5, axial_mm=18.6, angle_rad=0.0), fine, soft), 2)
    0.5
    """
    left = (1 + rubber.poisson) * (1 - 2 * rubber.poisson)
    if left < COMPRESSIBLE:
        raise RefusedError(
            f"deflections over a skin with a Poisson's ratio of {rubber.poisson:g} sum up to nothing whatever the force; take the force of "
            "the matched contact instead"
        )
    return rubber.young / left * float(np.nansum(Z)) * geometry.ring_pitch * geometry.stripe_pitch


def split(profile: Callable[[FloatArray], FloatArray], centre: float, reach: float, step: float = 0.05) -> tuple[float, float]:
    """Largest even part, and largest odd part with its sign, of a profile about a centre.

    Examples
    --------
    >>> even, odd = split(lambda y: 1 / (1 + y**2) + 0.1 * np.sin(y), 0.0, 3.0)
    >>> round(even, 3), round(odd, 3)
    (1.0, 0.1)
    """
    y = np.arange(0.0, reach + step / 2, step)
    right, left = profile(centre + y), profile(centre - y)
    odd = (right - left) / 2
    return float(np.abs(right + left).max()) / 2, float(odd[np.abs(odd).argmax()])


def angle_by_split(
    profile: Callable[[FloatArray], FloatArray], peak: float, kernel: Callable[[FloatArray, float, float], FloatArray], depth: float
) -> float:
    """Angle of a force from the normal, rad, by the ratio of the largest odd to the largest even part of a profile.

    A force from the side moves the profile's peak away from the place where it acts, about which odd and even are meant. That place
    is taken for which the force that is found explains the profile best.

    Parameters
    ----------
    profile : callable
        Deflection at places (n,), mm.
    peak : float, mm
        Where it is largest.
    kernel : callable
        Deflection of a normal and a tangential force at (n,) from it: ``kernel(y, P, Q)``.
    depth : float, mm

    Raises
    ------
    InputError
        No angle fits: it is not the profile of one force.

    Examples
    --------
    >>> def line(y, P, Q): return strain_under_line(y, depth=3.8, rubber=Rubber(), normal=P, tangential=Q)
    >>> y = np.linspace(-5, 5, 100_001)
    >>> peak = y[line(y, 1.0, np.tan(0.3)).argmax()]
    >>> round(angle_by_split(lambda at: line(at, 1.0, np.tan(0.3)), peak, line, 3.8), 3)
    0.3
    """
    from scipy.optimize import minimize_scalar

    reach = 2 * depth
    y = np.arange(-reach, reach, 0.05)
    even, odd = float(kernel(y, 1.0, 0.0).max()), float(np.abs(kernel(y, 0.0, 1.0)).max())

    def ratio_at(centre: float) -> float:
        a, b = split(profile, centre, reach)
        return math.copysign(abs(b) * even / (a * odd), b)

    def left(centre: float) -> float:
        read, made = profile(centre + y), kernel(y, 1.0, ratio_at(centre))
        return float(np.sum((read - made * (read @ made) / (made @ made)) ** 2) / np.sum(read**2))

    places = peak + np.arange(-depth / 2, depth / 2, 0.2)
    k = int(np.argmin([left(place) for place in places]))
    found = minimize_scalar(left, bounds=(places[k] - 0.2, places[k] + 0.2), method="bounded", options={"xatol": 1e-4})
    ratio = ratio_at(float(found.x))
    if found.fun > SPLIT_UNEXPLAINED or abs(ratio) > _STEEPEST:
        raise InputError(
            f"no angle of force fits this profile: {100 * found.fun:.0f} % of it are left over; it is not that of one contact in the middle"
        )
    return math.atan(ratio)
