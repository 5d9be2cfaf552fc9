"""Low-pass filters: without delay for calibration, where the whole signal lies there; with a known delay for control."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy  # its parts when they are used: scipy.signal takes half a second, which one who only reads a calibration need not wait
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]


class Lowpass:
    """A Butterworth low-pass of fourth order, as "Soft Sensing Skins for Arbitrary Objects" filters at 5 Hz.

    Parameters
    ----------
    cutoff_hz : float
    rate_hz : float
        Of the samples.
    order : int

    Raises
    ------
    InputError
        The samples come too rarely for this cut-off.

    Examples
    --------
    >>> low = Lowpass(5.0, 100.0)
    >>> float(low.zero_phase(np.ones(200)).round(6).min()), round(low.delay_s, 3)
    (1.0, 0.082)
    """

    def __init__(self, cutoff_hz: float, rate_hz: float, *, order: int = 4) -> None:
        if not 0 < cutoff_hz < rate_hz / 2:
            # A thousandth of a usable rate: times in ms under a heading without a unit.
            unit = "; times were taken as seconds: if they are milliseconds, call their column time_ms" if cutoff_hz < 500 * rate_hz else ""
            raise InputError(
                f"a cut-off of {cutoff_hz:g} Hz needs more than {2 * cutoff_hz:g} samples a second, and there are {rate_hz:g}; "
                f"sample faster or lower the cut-off{unit}"
            )
        self.cutoff_hz, self.rate_hz, self.order = cutoff_hz, rate_hz, order
        self._sections = scipy.signal.butter(order, cutoff_hz, fs=rate_hz, output="sos")

    @property
    def shortest(self) -> int:
        """Fewest samples that can be filtered to and fro: what is mirrored at each end."""
        return int(3 * self.rate_hz / self.cutoff_hz / 4) + 2

    def zero_phase(self, values: FloatArray) -> FloatArray:
        """Filtered to and fro along the first axis: no delay, twice the order. The ends are mirrored, as of a joint at rest.

        Raises
        ------
        InputError
            Fewer samples than `shortest`.
        """
        if len(values) < self.shortest:
            raise InputError(f"{len(values)} samples are too few for a cut-off of {self.cutoff_hz:g} Hz; {self.shortest} are needed")
        out: FloatArray = scipy.signal.sosfiltfilt(self._sections, values, axis=0, padtype="even", padlen=self.shortest - 1)
        return out

    @cached_property
    def delay_s(self) -> float:
        """Of the causal filter for slow signals: its group delay at 0 Hz."""
        b, a = scipy.signal.butter(self.order, self.cutoff_hz, fs=self.rate_hz)
        _, delay = scipy.signal.group_delay((b, a), w=[1e-3 * self.cutoff_hz], fs=self.rate_hz)
        return float(delay[0]) / self.rate_hz

    def causal(self) -> CausalLowpass:
        """A filter for samples as they come."""
        return CausalLowpass(self._sections)


class CausalLowpass:
    """One running filter of one or many channels; it starts at rest at the first sample.

    Examples
    --------
    >>> running = Lowpass(5.0, 100.0).causal()
    >>> [round(float(running.step(np.array([2.0]))[0]), 6) for _ in range(3)]
    [2.0, 2.0, 2.0]
    """

    def __init__(self, sections: FloatArray) -> None:
        self._sections = sections
        self._state: FloatArray | None = None

    def step(self, values: FloatArray) -> FloatArray:
        """The filtered values (c,) of the next sample (c,)."""
        if self._state is None:
            self._state = scipy.signal.sosfilt_zi(self._sections)[:, :, None] * values
        out, self._state = scipy.signal.sosfilt(self._sections, values[None], axis=0, zi=self._state)
        first: FloatArray = out[0]
        return first
