"""An angle that arrives late and with noise, smoothed and led on to the present, with its speed and acceleration."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

FloatArray = NDArray[np.float64]

#: Of the smoothing, rad/s: five times the fastest motion there is to follow, one cycle a second. Less lags on turns, more is noise.
BANDWIDTH = 30.0


class Lead:
    """A smoothing filter of third order (all poles at one place) whose own delay, and that of the signal, are made good.

    Parameters
    ----------
    delay_s : float
        Of the signal.
    period_s : float
        Between steps.

    Examples
    --------
    >>> lead = Lead(0.05, 0.01)
    >>> for k in range(300):
    ...     angle, speed, acceleration = lead.step(20.0 * (k / 100 - 0.05))
    >>> round(angle, 2), round(speed, 2)  # after 2.99 s at 20 deg/s
    (59.8, 20.0)
    """

    def __init__(self, delay_s: float, period_s: float) -> None:
        w = BANDWIDTH
        chain = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-(w**3), -3 * w**2, -3 * w]])
        # Between steps the input counts as a straight line, so that of a steady motion nothing is lost.
        whole = np.zeros((5, 5))
        whole[:3, :3], whole[2, 3], whole[3, 4] = chain, w**3, 1 / period_s
        step = expm(whole * period_s)
        self._A, self._b, self._c = step[:3, :3], step[:3, 3], step[:3, 4]
        self._ahead = delay_s + 3 / w
        self._state: FloatArray | None = None
        self._before = 0.0

    def restart(self) -> None:
        """What came before is too long ago: the next angle is one at rest."""
        self._state = None

    def step(self, angle: float, *, steps: int = 1) -> tuple[float, float, float]:
        """Angle (deg), speed (deg/s) and acceleration (deg/s^2) at the present, so many periods after the last one."""
        if self._state is None:
            self._state, self._before = np.array([angle, 0.0, 0.0]), angle
        for left in range(steps, 0, -1):  # what is missing lies on a straight line
            change = (angle - self._before) / left
            self._state = self._A @ self._state + self._b * self._before + self._c * change
            self._before += change
        x, v, a = self._state.tolist()
        t = self._ahead
        return x + v * t + a * t * t / 2, v + a * t, a
