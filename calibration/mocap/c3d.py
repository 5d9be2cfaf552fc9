"""C3D files: markers with their gaps, of files with or without analog channels, damaged ones included."""

from __future__ import annotations

import hashlib
import io
import json
import os
import signal
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np

from calibration.mocap.c3d_parameters import INTEL, fault
from calibration.mocap.markers import Markers, in_mm, masked
from skinfab.errors import InputError

#: The second byte of every C3D file.
MAGIC = b"\x50"
#: A capture that takes longer to read is none, s.
TIMEOUT_S = 120.0

_BLOCK = 512
#: A header has two bytes for the last frame's number: a longer capture states this one.
_LAST = 65535


def read_c3d(path: Path) -> Markers:
    """Read a capture.

    Of a file that was cut off, the whole frames are given, and a note says so: the library says nothing.

    Raises
    ------
    InputError
        It is damaged, or has no markers or no rate.
    """
    data = path.read_bytes()
    if wrong := fault(data):
        raise InputError(f"{path} is no C3D file that can be read ({wrong}); export it again")
    arrays = _contents(path)
    said = json.loads(arrays["said"].tobytes())
    points, residuals = arrays["points"], arrays["residuals"]
    markers, frames = points.shape[1:]
    labels = [str(label).strip() or f"marker {k + 1}" for k, label in enumerate(said["labels"])][:markers]
    labels += [f"marker {k + 1}" for k in range(len(labels), markers)]
    if not markers or not frames:
        raise InputError(f"{path} has {markers} markers in {frames} frames; give a capture with some")
    if twice := next((name for name in labels if labels.count(name) > 1), None):
        raise InputError(f"{path}: two markers are called {twice!r}; give each one a label of its own")
    rate = said["rate"]
    if not (np.isfinite(rate) and rate > 0):
        raise InputError(f"{path} states a rate of {rate:g} frames a second, so that nothing has a time; mend POINT:RATE")
    notes = []
    whole, stated = _frames(data, markers)
    whole = min(whole, frames)
    if not whole:
        raise InputError(f"{path} was cut off before its first frame; take another copy")
    if whole < max(frames, stated):
        notes.append(f"{path.name} was cut off: {whole:,} of {max(frames, stated):,} frames are whole")
        points, residuals, frames = points[:, :, :whole], residuals[:, :whole], whole
    if not said["units"]:
        notes.append(f"{path.name} states no unit; mm are taken")
    at = masked(points.transpose(1, 2, 0))
    at[residuals < 0] = np.nan  # the format's own mark of a point that was not seen
    at *= in_mm(said["units"] or "mm", str(path))
    positions = {label: at[k] for k, label in enumerate(labels)}
    return Markers(path.name, hashlib.sha256(data).hexdigest(), rate, np.arange(frames) / rate, positions, tuple(notes))


def _contents(path: Path) -> dict[str, np.ndarray]:
    """What the library reads, in a process of its own."""
    # The packages as they are here, and nothing that happens to lie in the user's folder.
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).resolve().parents[2])}
    environment["OPENBLAS_NUM_THREADS"] = "1"  # each thread takes some of the addresses it is allowed
    command = [sys.executable, "-P", "-m", "calibration.mocap.c3d_process", str(path.resolve())]
    try:
        done = subprocess.run(command, capture_output=True, timeout=TIMEOUT_S, env=environment, check=False)
    except subprocess.TimeoutExpired as late:
        raise InputError(f"{path} could not be read in {TIMEOUT_S:g} s; it is damaged: take another copy") from late
    if done.returncode:
        said = " ".join(done.stderr.decode(errors="replace").split())[-200:]
        if done.returncode < 0:
            out_of_time = -done.returncode in (signal.SIGXCPU, signal.SIGKILL)  # the soft limit's, and the hard one's
            said = "it takes longer than a file of its size does" if out_of_time else "the C3D library crashed on it"
        raise InputError(f"{path} is no C3D file that can be read ({said}); export it again")
    with np.load(io.BytesIO(done.stdout), allow_pickle=False) as arrays:
        return {name: arrays[name] for name in ("points", "residuals", "said")}


def _frames(data: bytes, markers: int) -> tuple[int, int]:
    """How many frames the file's bytes can hold, and how many its header states, 0 where it cannot.

    Of files of other processors, whose numbers are not read here, neither is known: as many as the library gives, and 0.
    """
    unknown = sys.maxsize, 0
    if len(data) < _BLOCK:
        return 0, 0
    parameters = (data[0] - 1) * _BLOCK
    if data[parameters + 3] != INTEL:
        return unknown
    analog, first, last, scale, start = struct.unpack_from("<4xHHH2xfH", data)
    size = (4 * markers + analog) * (4 if scale < 0 else 2)
    if not start or not size:
        return unknown
    stated = last - first + 1 if first <= last < _LAST else 0
    return max(len(data) - (start - 1) * _BLOCK, 0) // size, stated
