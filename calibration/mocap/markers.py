"""Markers of a motion capture: where each one was, frame by frame, and where it was not seen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError

FloatArray = NDArray[np.float64]

#: What systems write for a coordinate that is not known, besides NaN: this, or a point at the very origin.
MISSING = -16512.0

#: One unit in mm.
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

#: A larger file is no capture of a hand.
MAX_BYTES = 2_000_000_000


@dataclass(frozen=True, eq=False)
class Markers:
    """A capture.

    Parameters
    ----------
    file : str
        Its name.
    sha256 : str
        Of its bytes.
    rate_hz : float
    time : (n,) float, s
        From the first frame on.
    positions : mapping of (n, 3) float, mm
        By label; NaN where the marker was not seen.
    notes : tuple of str
        What was left out or taken for granted, a sentence each.
    """

    file: str
    sha256: str
    rate_hz: float
    time: FloatArray
    positions: Mapping[str, FloatArray]
    notes: tuple[str, ...]

    def marker(self, label: str) -> FloatArray:
        """A marker's positions, (n, 3) mm; a subject's name before a colon may be left out.

        Raises
        ------
        InputError
            There is none of this label, or several, or it was never seen.
        """
        found = [name for name in self.positions if name == label] or [n for n in self.positions if n.rpartition(":")[2] == label]
        if not found:
            raise InputError(f"{self.file} has no marker {label!r}; it has {', '.join(self.positions) or 'none'}")
        if len(found) > 1:
            raise InputError(f"{self.file} has {len(found)} markers {label!r}: {', '.join(found)}; give one of these names")
        out = self.positions[found[0]]
        if not np.isfinite(out).any():
            raise InputError(f"{self.file}: marker {found[0]!r} was never seen; name another one")
        return out


def masked(positions: FloatArray) -> FloatArray:
    """Positions (..., 3) with NaN for what was not seen: not finite, `MISSING`, or exactly at the origin.

    Examples
    --------
    >>> masked(np.array([[1.0, 2, 3], [0, 0, 0], [0, 0, 1], [-16512, -16512, -16512]])).tolist()
    [[1.0, 2.0, 3.0], [nan, nan, nan], [0.0, 0.0, 1.0], [nan, nan, nan]]
    """
    gone = ~np.isfinite(positions).all(axis=-1) | (positions == MISSING).any(axis=-1) | (positions == 0).all(axis=-1)
    return np.where(gone[..., None], np.nan, positions)


def in_mm(unit: str, where: str) -> float:
    """One of `unit` in mm.

    Raises
    ------
    InputError
        It is no known unit of length.
    """
    if unit.strip().lower() not in UNITS:
        raise InputError(f"{where}: positions are in {unit!r}; {', '.join(UNITS)} are known")
    return UNITS[unit.strip().lower()]


def read_markers(path: str | Path) -> Markers:
    """Read a capture, C3D or Vicon's CSV export, by its content.

    Raises
    ------
    InputError
        It cannot be read, or is neither; what and where is said.
    """
    from calibration.mocap.c3d import MAGIC, read_c3d
    from calibration.mocap.vicon import read_vicon

    path = Path(path)
    try:
        if not path.is_file():
            raise InputError(f"{path} is {'no file' if path.exists() else 'not there'}; give a C3D file or a Vicon CSV export")
        if path.stat().st_size > MAX_BYTES:
            raise InputError(f"{path} has {path.stat().st_size / 1e9:.1f} GB; cut the capture into shorter ones")
        with path.open("rb") as file:
            head = file.read(2)
        return read_c3d(path) if head[1:] == MAGIC else read_vicon(path)
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror or fault}; give a C3D file or a Vicon CSV export") from fault
