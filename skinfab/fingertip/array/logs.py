"""Logs of an array as deflections, with what is known of the truth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.array.geometry import tactel_columns
from skinfab.fingertip.array.rest import stuck_at_rest
from skinfab.fingertip.array.simulator import deflection
from skinfab.readout.frame import Recording

FloatArray = NDArray[np.float64]

#: What a log may say of the truth.
TRUTH: tuple[str, ...] = ("axial_mm", "angle_deg", "force_n", "line_deg")
#: The log begins untouched for so long, s; and so many frames at least.
REST_S, REST_FRAMES = 1.0, 3
#: A log whose tactels scatter by more than this in that time was touched then, as a part of the gap.
RESTLESS = 5e-3
#: A frame is pulled where its lowest reading is below rest by more than this part of its highest: beside a contact that also pulls along
#: the skin it is a third. In a log it is also so many standard deviations, this part of the log's highest, and so many frames.
PULLED_PART, PULLED_SIGMAS, PULLED_LOG, PULLED_FRAMES = 0.5, 10.0, 0.1, 3


@dataclass(frozen=True, eq=False)
class ArrayLog:
    """Deflections in a log.

    Parameters
    ----------
    name : str
    time : (n,) float, s
    Z : (n, rings, stripes) float
        Deflections; NaN where a tactel reads nothing, or is at the end of its range.
    saturated : (n, rings, stripes) bool
    truth : dict of (n,) float
        By name: ``axial_mm``, ``angle_deg``, ``force_n``, ``line_deg``, those that the log has.
    noise : float
        Standard deviation of a reading at rest, as a part of the gap.
    rest_v : (rings, stripes) float
        Voltages at rest; NaN of a tactel that reads nothing.
    simulated : bool
    sha256 : str
    notes : tuple of str
    """

    name: str
    time: FloatArray
    Z: FloatArray
    saturated: NDArray[np.bool_]
    truth: dict[str, FloatArray]
    noise: float
    rest_v: FloatArray
    simulated: bool
    sha256: str = ""
    notes: tuple[str, ...] = ()

    @property
    def shape(self) -> tuple[int, int]:
        """Rings and stripes."""
        return self.Z.shape[1], self.Z.shape[2]

    def touched(self) -> NDArray[np.int64]:
        """Frames of which the truth is known to be a contact.

        Raises
        ------
        InputError
            The log does not say where it was touched.
        """
        if missing := [name for name in ("axial_mm", "angle_deg", "force_n") if name not in self.truth]:
            raise InputError(f"{self.name} has no column {', '.join(missing)}; to learn, a log must say where and how hard it was touched")
        known = np.isfinite(self.truth["axial_mm"]) & np.isfinite(self.truth["angle_deg"]) & (self.truth["force_n"] > 0)
        return np.flatnonzero(known)


def read_array_log(path: str | Path) -> ArrayLog:
    """Read a log of voltages that begins untouched.

    Raises
    ------
    InputError
        As `skinfab.readout.logs.log.read_log`; it has no array's channels; or it does not begin at rest.
    """
    from skinfab.readout.logs.log import read_log

    log = read_log(path)
    return of_recording(log.recording, name=log.file, sha256=log.sha256, notes=log.notes)


def of_recording(recording: Recording, *, name: str, sha256: str = "", notes: tuple[str, ...] = ()) -> ArrayLog:
    """A recording's voltages as deflections: V0 is the median of its first second.

    Raises
    ------
    InputError
        It has no array's channels, no tactel reads, or it was touched in its first second.

    Examples
    --------
    >>> from skinfab.fingertip.array.protocols import presses
    >>> from skinfab.fingertip.array.simulator import Device
    >>> log = of_recording(presses(Device(), 3), name="presses")
    >>> log.shape, log.simulated, len(log.touched())
    ((8, 8), True, 9)
    """
    shape, columns = tactel_columns(recording.stream)
    time = recording.device_time - recording.device_time[0] if len(recording) else recording.device_time
    rest = int(np.searchsorted(time, REST_S - 1e-9)) if len(time) else 0
    if rest < REST_FRAMES:
        raise InputError(f"{name} has {rest} frames in its first {REST_S:g} s; begin it untouched, with at least {REST_FRAMES} frames")
    flat = columns.ravel()
    valid, saturated = recording.valid[:, flat], recording.saturated[:, flat]
    # Frame after frame in memory, as a port's are: of another layout all that is compiled would be compiled a second time.
    volts = np.ascontiguousarray(np.where(valid & ~saturated, recording.values[:, flat], np.nan)).reshape(len(time), *shape)
    # A broken wire reads nothing, or 0 V. A tactel that never reads has no rest; it stays NaN.
    lost = ~np.isfinite(np.where(volts[:rest] > 0, volts[:rest], np.nan)).any(axis=0)
    rest_v = np.nanmedian(np.where(lost, 1.0, volts[:rest]), axis=0)
    lost |= ~(rest_v > 0)
    stuck = stuck_at_rest(volts[:rest]) & ~lost
    dead = lost | stuck
    if dead.all():
        raise InputError(f"{name}: no tactel reads a voltage above zero in the first {REST_S:g} s; look at its wires")
    rest_v = np.where(dead, 1.0, rest_v)
    Z = np.where(dead, np.nan, deflection(volts, rest_v))
    scatter = np.nanstd(np.where(dead, 0.0, Z[:rest]), axis=0)
    if float(scatter.max()) > RESTLESS:
        i, j = np.unravel_index(int(scatter.argmax()), shape)
        raise InputError(
            f"{name}: tactel r{i}s{j} moves by {100 * scatter.max():.2g} % of its gap in the first {REST_S:g} s; leave the array "
            "untouched when a log begins"
        )
    said = list(notes)
    for which, how in ((lost, "read nothing, or 0 V,"), (stuck, "stand still while the others change")):
        if which.any():
            said.append(
                f"{name}: {int(which.sum())} of {which.size} tactels {how} at rest and are left out: {tactels(which)}; look at their wires"
            )
    alive = scatter[~dead]
    noise = math.sqrt(float((alive**2).mean()) * rest / max(rest - 1, 1)) if alive.size else 0.0
    low, high = -np.nanmin(Z, axis=(1, 2), initial=0.0), np.nanmax(Z, axis=(1, 2), initial=0.0)
    deep = np.maximum(PULLED_PART * high, max(PULLED_SIGMAS * noise, PULLED_LOG * float(high.max())))
    require_rested(Z[low > deep], name)
    truth: dict[str, FloatArray] = {
        each: np.where(recording.valid[:, recording.stream.index(each)], recording.values[:, recording.stream.index(each)], np.nan)
        for each in TRUTH
        if each in recording.stream.names
    }
    return ArrayLog(
        name,
        time,
        Z,
        saturated.reshape(len(time), *shape),
        truth,
        noise,
        np.where(dead, np.nan, rest_v),
        recording.stream.simulated,
        sha256,
        tuple(said),
    )


def tactels(which: NDArray[np.bool_]) -> str:
    """The first few of some tactels by name.

    Examples
    --------
    >>> tactels(np.array([[True, False], [False, True]]))
    'r0s0, r1s1'
    """
    return ", ".join(f"r{i}s{j}" for i, j in np.argwhere(which)[:4])


def require_rested(pulled: Sequence[FloatArray] | FloatArray, name: str) -> None:
    """Refuse a log with frames, (n, rings, stripes), that read far less than at rest.

    Raises
    ------
    InputError
        There are several of them.
    """
    if len(pulled) < PULLED_FRAMES:
        return
    deepest = np.nanmin(np.array(pulled), axis=0, initial=0.0)
    which = deepest == deepest.min()
    raise InputError(
        f"{name}: in {len(pulled)} frames tactels read less than at rest, {tactels(which)} by {-100 * deepest.min():.2g} % of its gap; the "
        "array was touched in the first second, or its voltage falls when it is pressed (turn the polarity), or a wire broke"
    )
