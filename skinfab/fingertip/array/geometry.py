"""Where the tactels of a cylindrical array lie, and what its channels are called.

The axial place counts in mm from the middle of ring 0, the angle in rad from the middle of stripe 0; stripe 0 follows the last one.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Stream

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_NAME = re.compile(r"r(\d+)s(\d+)")
#: Fewer tactels have no neighbours to interpolate with; more than this nobody has wound round a finger.
_LEAST, _MOST = 4, 64
#: Electrodes smaller than this are points, mm.
_POINT = 1e-3
#: The seed's frames come 15 times a second; its voltages are put on this range.
RATE_HZ, TOP_V = 15.0, 5.0


@dataclass(frozen=True)
class Geometry:
    """A cylindrical array; the seed's where nothing is said.

    Parameters
    ----------
    rings, stripes : int
        Tactels along the finger and around it.
    ring_pitch : float, mm
    finger_radius : float, mm
        Of the skin's outside.
    skin : float, mm
        Of rubber over the electrodes.
    fill : float
        Width of an electrode in pitches, from 0 (points) to 1.

    Raises
    ------
    InputError
        A number is out of range.

    Examples
    --------
    >>> seed = Geometry()
    >>> seed.shape, round(seed.core_radius, 3), round(seed.stripe_pitch, 3)
    ((8, 8), 8.9, 6.99)
    """

    rings: int = 8
    stripes: int = 8
    ring_pitch: float = 3.7
    finger_radius: float = 12.7
    skin: float = 3.8
    fill: float = 0.9

    def __post_init__(self) -> None:
        if not (_LEAST <= self.rings <= _MOST and _LEAST <= self.stripes <= _MOST):
            raise InputError(f"an array of {self.rings} x {self.stripes} tactels is not read; give {_LEAST} to {_MOST} each way")
        if not (self.ring_pitch > 0 and 0 < self.skin < self.finger_radius and 0 <= self.fill <= 1):
            raise InputError(
                f"a pitch of {self.ring_pitch:g} mm, a skin of {self.skin:g} mm on a radius of {self.finger_radius:g} mm and a fill of "
                f"{self.fill:g} are no array; the skin must be thinner than the finger and the fill lie between 0 and 1"
            )

    @classmethod
    def of_density(cls, text: str) -> Geometry:
        """As many rings and stripes as ``8x16`` says, on the seed's finger: the rings lie closer, not farther down.

        Examples
        --------
        >>> Geometry.of_density("16x16").ring_pitch
        1.85
        """
        match = re.fullmatch(r"(\d{1,3})x(\d{1,3})", text)
        if match is None:
            raise InputError(f"{text!r} is no density; give rings x stripes, such as 8x16")
        rings, stripes = int(match[1]), int(match[2])
        seed = cls()
        return cls(rings, stripes, seed.ring_pitch * seed.rings / max(rings, 1))

    @property
    def shape(self) -> tuple[int, int]:
        """Rings and stripes."""
        return self.rings, self.stripes

    @property
    def core_radius(self) -> float:
        """Of the electrodes, mm."""
        return self.finger_radius - self.skin

    @property
    def stripe_pitch(self) -> float:
        """Distance of the stripes on the core, mm."""
        return 2 * math.pi * self.core_radius / self.stripes

    @property
    def pitch(self) -> tuple[float, float]:
        """Along and around, on the core, mm."""
        return self.ring_pitch, self.stripe_pitch

    @property
    def half(self) -> tuple[float, float]:
        """Half of an electrode's size, along and around, mm."""
        return max(self.fill * self.ring_pitch / 2, _POINT), max(self.fill * self.stripe_pitch / 2, _POINT)

    @property
    def names(self) -> tuple[str, ...]:
        """Of the channels, ring by ring."""
        return tuple(f"r{i}s{j}" for i in range(self.rings) for j in range(self.stripes))

    def to_tactels(self, axial_mm: float, angle_rad: float) -> tuple[float, float]:
        """A place in tactel spacings."""
        return axial_mm / self.ring_pitch, angle_rad * self.stripes / (2 * math.pi)

    def from_tactels(self, ring: float, stripe: float) -> tuple[float, float]:
        """A place in mm and rad, the angle from -pi to pi.

        Examples
        --------
        >>> Geometry().from_tactels(2.0, 7.0)
        (7.4, -0.7853981633974483)
        """
        return ring * self.ring_pitch, wrapped(2 * math.pi * stripe / self.stripes)

    def stream(self, *, rate_hz: float = RATE_HZ, simulated: bool = False) -> Stream:
        """Its channels, in volts."""
        channels = tuple(Channel(name, "V", "tactel", 0.0, TOP_V) for name in self.names)
        return Stream(f"{self.rings} x {self.stripes} tactels", channels, rate_hz, simulated)


def wrapped(angle: float) -> float:
    """An angle between -pi and pi.

    Examples
    --------
    >>> round(wrapped(6.0), 4), wrapped(1.0)
    (-0.2832, 1.0)
    """
    return angle - 2 * math.pi * math.floor(angle / (2 * math.pi) + 0.5)


def tactel_columns(stream: Stream) -> tuple[tuple[int, int], IntArray]:
    """The shape of the array in a stream, and the column of each of its tactels, (rings, stripes).

    Channels are called ``r0s0`` (ring, stripe) and so on; others may lie between them.

    Raises
    ------
    InputError
        There are none, or one is missing.

    Examples
    --------
    >>> shape, columns = tactel_columns(Geometry().stream())
    >>> shape, columns[1, 2]
    ((8, 8), np.int64(10))
    """
    at = {(int(m[1]), int(m[2])): k for k, name in enumerate(stream.names) if (m := _NAME.fullmatch(name))}
    if not at:
        raise InputError(
            f"{stream.name} has no tactels; call channels r0s0, r0s1, ... (ring, stripe); it has {', '.join(stream.names[:4]) or 'none'}"
        )
    rings, stripes = (1 + max(key[k] for key in at) for k in (0, 1))
    if rings > _MOST or stripes > _MOST:
        raise InputError(f"{stream.name} has a tactel of ring {rings - 1}, stripe {stripes - 1}; arrays of up to {_MOST} each way are read")
    if missing := [f"r{i}s{j}" for i in range(rings) for j in range(stripes) if (i, j) not in at]:
        raise InputError(f"{stream.name} lacks {len(missing)} of {rings} x {stripes} tactels, the first of them {missing[0]}; record all")
    return (rings, stripes), np.array([[at[i, j] for j in range(stripes)] for i in range(rings)], dtype=np.int64)
