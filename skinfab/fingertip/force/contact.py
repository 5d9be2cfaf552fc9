"""Where a fingertip is touched, from the force and the moment that its six-axis sensor reads.

A contact at a point p pushes with f, and the sensor reads m = p x f: p lies on a line along f, and where that line enters
the fingertip's surface is the contact (Bicchi et al. 1993; the seed's eq. 1 and 2 with the pseudoinverse written out).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.errors import InputError
from skinfab.fingertip.force.wrench import RADIUS_MM, SensorNoise

if TYPE_CHECKING:
    from skinfab.fingertip.force.contact_mesh import TipMesh

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Below this force, N, a contact point is mostly noise: 1.8 mm at the usual sensor (docs/force.md has the chart).
LEAST_FORCE_N = 0.3
#: A moment about the force's own line of so many standard deviations is none of noise (1 sample in 16 000).
TORSION_SD = 4.0

#: What flags mean, by bit, in the order of their weight.
FLAGS = {
    1: "not a number",
    2: "no contact",
    4: "the force's line misses the surface",
    8: "a moment about the force's own line: no single point contact",
    16: "the force's line enters the surface more than once",
    32: "the force's line enters by the face that the fingertip is mounted with",
}
_INVALID, _NO_CONTACT, _MISSED, TORSION, _AMBIGUOUS, _MOUNTED = FLAGS


@dataclass(frozen=True)
class Hemisphere:
    """A fingertip that is half a ball; the seed's is half of a table tennis ball.

    Parameters
    ----------
    radius : float, mm
    centre : (3,) float, mm
        In the sensor's frame.
    axis : (3,) float
        From the centre to the pole; its length does not matter.

    Raises
    ------
    InputError
        The radius is not positive, or centre or axis are no vectors.
    """

    radius: float = RADIUS_MM
    centre: tuple[float, float, float] = (0.0, 0.0, 0.0)
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        if not (np.isfinite(self.radius) and self.radius > 0):
            raise InputError(f"a hemisphere with a radius of {self.radius:g} mm is none; give it in mm, above 0")
        for name in ("centre", "axis"):
            value = np.asarray(getattr(self, name), dtype=float)
            if value.shape != (3,) or not np.isfinite(value).all() or (name == "axis" and not value.any()):
                raise InputError(f"a hemisphere's {name} is {getattr(self, name)}; give three numbers" + ", not all 0" * (name == "axis"))

    @property
    def frame(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Centre, unit axis, and a unit vector across it."""
        axis = np.asarray(self.axis, dtype=float)
        axis = axis / np.linalg.norm(axis)
        aside = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
        return np.asarray(self.centre, dtype=float), axis, aside / np.linalg.norm(aside)


@dataclass(frozen=True, eq=False)
class Contacts:
    """What is known of the contact at each sample. No value is NaN: where nothing is known, `flags` say so.

    Parameters
    ----------
    point : (n, 3) float, mm
        In the sensor's frame; where the line misses the surface, the nearest point of it (of a dome: of where the force can
        push), and the pole (of a mesh, the first corner) where there is no contact.
    normal : (n, 3) float
        Unit, into the fingertip.
    force_n : (n,) float, N
        Size of the force.
    inclination_rad : (n,) float, rad
        Between the force and the normal: the friction angle is its limit.
    torsion_nmm : (n,) float, N mm
        Moment about the force's own line, f . m / |f|: none at a point contact.
    miss_mm : (n,) float, mm
        From the line to the point; 0 where it cuts the surface.
    sd_mm : (n,) float, mm
        Standard deviation of the point that the sensor's noise causes, to first order; at most the fingertip's size.
    flags : (n,) uint8
        Bits, see `FLAGS`; 0 where nothing is wrong.
    """

    point: FloatArray
    normal: FloatArray
    force_n: FloatArray
    inclination_rad: FloatArray
    torsion_nmm: FloatArray
    miss_mm: FloatArray
    sd_mm: FloatArray
    flags: NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.point)

    @property
    def touching(self) -> BoolArray:
        """Where something pushes on the fingertip."""
        return (self.flags & (_INVALID | _NO_CONTACT)) == 0

    @property
    def trusted(self) -> BoolArray:
        """Where nothing is wrong."""
        return self.flags == 0

    @property
    def missed(self) -> BoolArray:
        """Where the line misses the surface."""
        return (self.flags & _MISSED) != 0

    @property
    def twisted(self) -> BoolArray:
        """Where a moment about the force's line shows that it is no single point contact."""
        return (self.flags & TORSION) != 0

    @property
    def ambiguous(self) -> BoolArray:
        """Where the line enters the surface more than once; the outermost entry was taken."""
        return (self.flags & _AMBIGUOUS) != 0

    @property
    def mounted(self) -> BoolArray:
        """Where the line enters a mesh by its flat bottom, which nothing can touch: the force's sign or frame is wrong."""
        return (self.flags & _MOUNTED) != 0

    def words(self, k: int) -> str:
        """What is wrong with the k-th sample; empty where nothing is."""
        return "; ".join(text for bit, text in FLAGS.items() if self.flags[k] & bit)


def locate(
    force: ArrayLike,
    moment: ArrayLike,
    surface: Hemisphere | TipMesh | None = None,
    *,
    least_force: float = LEAST_FORCE_N,
    noise: SensorNoise | None = None,
) -> Contacts:
    """Contact points of many samples at once.

    Parameters
    ----------
    force : (n, 3) float, N
        That acts on the fingertip, in the sensor's frame.
    moment : (n, 3) float, N mm
        About the origin of that frame.
    surface : Hemisphere or TipMesh
        The fingertip; a `Hemisphere` of 20 mm where left out.
    least_force : float, N
        What is weaker is no contact.
    noise : SensorNoise
        Of the sensor: decides what torsion is noise, and the points' standard deviation.

    Raises
    ------
    InputError
        Shapes that are none of n forces and n moments, or a negative `least_force`.

    Examples
    --------
    A finger presses straight down on the pole, then from the side:

    >>> found = locate([[0, 0, -1.0], [-1.0, 0, -1.0]], [[0, 0, 0], [0, 0, 0]])
    >>> found.point.round(2).tolist()
    [[0.0, 0.0, 20.0], [14.14, 0.0, 14.14]]
    >>> found.inclination_rad.round(6).tolist(), found.flags.tolist()
    ([0.0, 0.0], [0, 0])
    """
    F, M = _vectors(force, "force"), _vectors(moment, "moment")
    if F.shape != M.shape:
        raise InputError(f"{len(F)} forces and {len(M)} moments do not belong together; give one moment for each force")
    if not (np.isfinite(least_force) and least_force >= 0):
        raise InputError(f"a least force of {least_force:g} N is none; give 0 or more")
    surface, noise = surface or Hemisphere(), noise or SensorNoise()
    from skinfab.fingertip.force import _entry

    out, flags = np.empty((len(F), _entry.COLUMNS)), np.empty(len(F), dtype=np.uint8)
    limits = (float(least_force), noise.force_n, noise.moment_nmm, TORSION_SD)
    if isinstance(surface, Hemisphere):
        _entry.enter_hemisphere(F, M, float(surface.radius), *surface.frame, *limits, out, flags)
    else:
        surface.enter(F, M, *limits, out, flags)
        flags[surface.at_the_mount(out[:, :3], out[:, 3:6]) & (flags & (_INVALID | _NO_CONTACT) == 0)] |= _MOUNTED
    return Contacts(out[:, :3], out[:, 3:6], out[:, 6], out[:, 7], out[:, 8], out[:, 9], out[:, 10], flags)


def _vectors(value: ArrayLike, name: str) -> FloatArray:
    try:
        vectors = np.ascontiguousarray(value, dtype=float)
    except (TypeError, ValueError) as fault:
        raise InputError(f"{name} holds what is no number ({fault}); give an array of (n, 3)") from fault
    if vectors.ndim != 2 or vectors.shape[1] != 3:
        raise InputError(f"{name} has the shape {vectors.shape}; give (n, 3), a row a sample")
    return vectors
