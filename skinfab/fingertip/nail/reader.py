"""One window after the other, each in some tens of microseconds: all that does not change between windows is worked out once.

It decides as `NailModel.decide` does, and adds where the pattern lies, how it is turned and how hard it is pressed.
"""

from __future__ import annotations

import math
from collections import OrderedDict
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.nail.classify import STRANGE, NailModel
from skinfab.fingertip.nail.confidence import LAPSE
from skinfab.fingertip.nail.labels import NOTHING
from skinfab.fingertip.nail.phasors import BLOCK, ComplexArray, lock_in_weights, turned_phasors
from skinfab.fingertip.nail.regress import Continuous, Regression
from skinfab.fingertip.nail.units import CHANNELS

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Weights are kept for frequencies on this grid, Hz: half a step off turns the ends of a block of 128 readings by 0.8 degrees.
_STEP_HZ = 0.05
#: So many of them: a drift over 6 Hz.
_KEPT = 128


@dataclass(frozen=True)
class Decision:
    """On one window.

    Parameters
    ----------
    label : str
        Of the class.
    confidence : float
        How probable it is, among those that were learned.
    contact, strange : bool
        See `skinfab.fingertip.nail.classify.Decisions`.
    continuous : Continuous
    missing : tuple of str
        Channels that were left out because the window has too few readings of them.
    """

    label: str
    confidence: float
    contact: bool
    strange: bool
    continuous: Continuous
    missing: tuple[str, ...] = ()


class Reader:
    """Decides on windows of one length.

    Parameters
    ----------
    model : NailModel
    samples : int
        Readings of a window.
    regression : Regression, optional
        What `continuous` comes from.
    rate_hz : float, optional
        Readings a second; those of the model where it is left out.

    Raises
    ------
    InputError
        The window is too short.
    """

    def __init__(self, model: NailModel, samples: int, *, regression: Regression | None = None, rate_hz: float | None = None) -> None:
        self.model, self.samples, self.regression = model, samples, regression
        self._rate = rate_hz or model.rate_hz
        self._count = max(samples // BLOCK, 1)
        self._length = samples // self._count
        self._weights: OrderedDict[int, ComplexArray] = OrderedDict()
        self._weights_at(model.drive_hz)  # refuses a window that is too short
        self._others: dict[bytes, Reader] = {}
        self._L = model.whitener(samples)
        self._means = model.means @ self._L.T
        self._usual, self._gate, self._rest = STRANGE * model.usual, model.gate, model.at_rest
        self._conj = model.reference.conj()
        self._scale = 1 / model.size
        self._used = model.channels
        self._all = bool(model.channels.all())
        self._names = [model.names[k] for k in model.touched]

    def decide(self, window: FloatArray, *, drive_hz: float | None = None) -> Decision:
        """Decide on a window (samples, 6); NaN where a reading is missing or saturated.

        Raises
        ------
        InputError
            Fewer than two channels have enough readings.
        """
        drive_hz = self.model.drive_hz if drive_hz is None else drive_hz
        if math.isfinite(window.sum() if self._all else window[:, self._used].sum()):
            w = self._weights_at(drive_hz)
            blocks = window[: self._count * self._length].reshape(self._count, self._length, 6)
            return self._decide(np.where(self._used, w @ blocks, 0.0))
        return self._with_gaps(window, drive_hz)

    def _decide(self, drive: ComplexArray) -> Decision:
        along = drive @ self._conj
        turn = along.conj() / np.maximum(np.abs(along), 1e-300)
        mean = (drive * turn[:, None]).mean(axis=0)
        scaled = (mean if self._all else mean[self._used]) * self._scale
        x = np.concatenate([scaled.real, scaled.imag])
        white = self._L @ x
        apart = self._means - white
        squared = np.einsum("kd,kd->k", apart, apart)
        best = int(squared.argmin())
        nearest = float(squared[best])
        weight = np.exp((nearest - squared) / (2 * self.model.temperature))
        total = float(weight.sum())
        if self._rest is not None and (away := math.dist(x, self._rest)) <= self._gate:
            sure, strange = self.model.none_at(away, self.samples)
            return Decision(NOTHING, sure, False, strange, Continuous())
        found = Continuous() if self.regression is None else self.regression.continuous(x)
        sure = (1 - LAPSE) / total + LAPSE / len(squared)
        return Decision(self._names[best], sure, True, nearest > self._usual, found)

    def _with_gaps(self, window: FloatArray, drive_hz: float) -> Decision:
        # A channel without any reading first: without it the others may be whole.
        silent = self._used & ~np.isfinite(window).any(axis=0)
        if silent.any():
            return self._without(silent, window, drive_hz)
        drive, _ = turned_phasors(window[None], self._rate, drive_hz, self.model.reference)
        gone = ~np.isfinite(drive[0]) & self._used
        return self._without(gone, window, drive_hz) if gone.any() else self._decide(np.where(self._used, drive, 0.0))

    def _without(self, gone: BoolArray, window: FloatArray, drive_hz: float) -> Decision:
        key = gone.tobytes()
        if key not in self._others:
            model = self.model.without(gone)
            regression = None if self.regression is None else self.regression.of(model)
            self._others[key] = Reader(model, self.samples, regression=regression, rate_hz=self._rate)
        found = self._others[key].decide(window, drive_hz=drive_hz)
        return replace(found, missing=tuple(name for name, out in zip(CHANNELS, gone, strict=True) if out or name in found.missing))

    def _weights_at(self, drive_hz: float) -> ComplexArray:
        key = round(drive_hz / _STEP_HZ)
        if key not in self._weights:
            self._weights[key] = lock_in_weights(self._length, self._rate, key * _STEP_HZ)
            if len(self._weights) > _KEPT:
                self._weights.popitem(last=False)
        return self._weights[key]
