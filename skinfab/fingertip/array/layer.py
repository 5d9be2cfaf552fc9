"""Another field than the simulator's, to see what the matched ways lose where their own is not that of the skin.

A layer of rubber that keeps its volume, bonded to a hard core, is pressed by small tips; a tactel reads the pressure on the core, averaged
over its electrode. Per wavelength in plane strain the part of a pressure on top that reaches the core is

    (cosh S + S sinh S) / (cosh^2 S + S^2),   S = wave number times depth,

where a half space lets (1 + S) exp(-S) through at that depth (from Airy's stress function, with no motion on the core).
Like the simulated one the finger is unrolled; simulated all the same.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.array.simulator import Device, Skin

FloatArray = NDArray[np.float64]

#: Length along the finger after which the field begins anew, mm; wave numbers each way; radius of the tips of 1 N, mm: Hertz's grow as
#: the force to the power of a third.
_SPAN_MM, _WAVES, _TIP_MM = 80.0, 64, 1.2


def let_through(S: FloatArray) -> FloatArray:
    """Part of a pressure's wave that reaches the core.

    Examples
    --------
    >>> let_through(np.array([0.0, 1.0, 4.0])).round(3)
    array([1.   , 0.804, 0.179])
    """
    # With exp(-S) taken out of both, so that nothing overflows.
    e = np.exp(-2 * S)
    out: FloatArray = np.exp(-S) * ((1 + e) / 2 + S * (1 - e) / 2) / ((1 + e) ** 2 / 4 + S * S * e)
    return out


class LayerSkin(Skin):
    """Tactels under a bonded layer."""

    @cached_property
    def _waves(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Wave numbers along and around, and what a tactel reads of each pair, times E."""
        g = self.geometry
        turn = g.stripes * g.stripe_pitch
        kx = 2 * math.pi / _SPAN_MM * np.arange(-_WAVES, _WAVES + 1)
        ky = 2 * math.pi / turn * np.arange(-_WAVES, _WAVES + 1)
        electrode = np.sinc(kx * g.half[0] / math.pi)[:, None] * np.sinc(ky * g.half[1] / math.pi)
        read: FloatArray = let_through(np.hypot(kx[:, None], ky) * g.skin) * electrode / (_SPAN_MM * turn)
        return kx.astype(float), ky.astype(float), read

    def points(self, forces: Sequence[tuple[float, float, float]], places: Sequence[tuple[float, float]]) -> FloatArray:
        """Deflections of small tips that press straight down."""
        g = self.geometry
        kx, ky, read = self._waves
        out = np.zeros(g.shape)
        for (force, along, around), (axial, angle) in zip(forces, places, strict=True):
            if along or around:
                raise InputError("a layer is only pressed straight down; take the half space (Skin) for what pulls along the skin")
            # A Gaussian tip of the same mean square radius as Hertz's.
            tip = np.exp(-(kx[:, None] ** 2 + ky**2) * (_TIP_MM * force ** (1 / 3)) ** 2 / 10)
            A = np.exp(1j * kx * (g.ring_pitch * np.arange(g.rings)[:, None] - axial))
            B = np.exp(1j * ky * (g.stripe_pitch * np.arange(g.stripes)[:, None] - angle * g.core_radius))
            out += force * (A @ (read * tip) @ B.T).real
        return out * self.gains / self.rubber.young


class LayerDevice(Device):
    """An array under a bonded layer: gains, noise and voltages as `Device`.

    Examples
    --------
    >>> Z = LayerDevice(seed=1).skin.pressed(0.5, axial_mm=11.1, angle_rad=0.0)
    >>> [int(k) for k in np.unravel_index(Z.argmax(), Z.shape)]
    [3, 0]
    """

    @cached_property
    def skin(self) -> Skin:
        """With this device's gains."""
        made = super().skin
        return LayerSkin(made.geometry, made.rubber, gains=made.gains)
