"""The improved method on the paper's protocol: what it says of the very trials that the published one is asked about."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.nail.classify import NailModel, fit_phasors
from skinfab.fingertip.nail.labels import NOTHING, Label
from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.phasors import BLOCK, FIND_SHORTEST, find_drive, lock_in, reference_of, turned_phasors
from skinfab.fingertip.nail.protocol import Session
from skinfab.fingertip.nail.simulator import RATE_HZ, Touch, nail_stream

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def learn(session: Session) -> NailModel:
    """The model of a participant's training; its classes have the session's numbers.

    Examples
    --------
    >>> from skinfab.fingertip.nail.protocol import Protocol, session
    >>> learn(session("edges4", 1, protocol=Protocol(rounds=1, estimates=1, samples=256))).names[:2]
    ('none', 'longitudinal')
    """
    windows = usable(session.training.readings[:, 0])
    drive_hz = find_drive(windows, RATE_HZ)
    reference = reference_of(lock_in(windows[:, :BLOCK], RATE_HZ, drive_hz).drive)
    drive, noise = turned_phasors(windows, RATE_HZ, drive_hz, reference)
    names = (NOTHING, *(pattern.name for pattern in TESTS[session.test]))
    return fit_phasors(names, session.training.classes, drive, noise, rate_hz=RATE_HZ, drive_hz=float(np.median(drive_hz)))


def asked(session: Session, samples: int | None = None) -> FloatArray:
    """The first readings of each trial of the test, (n, samples, 6); all of them where no number is given."""
    each = session.rounds.readings
    return usable(each.reshape(len(each), -1, 6)[:, :samples])


def usable(values: FloatArray) -> FloatArray:
    """Readings without those at an end of the sensor's range."""
    ends = np.array([channel.high for channel in nail_stream().channels])
    return np.where(np.abs(values) < ends, values, np.nan)


def frequency(windows: FloatArray, model: NailModel) -> float | FloatArray:
    """The motor's frequency in windows that are long enough to find it in; in shorter ones that of the training."""
    return find_drive(windows, RATE_HZ) if windows.shape[1] >= FIND_SHORTEST else model.drive_hz


def improved_answers(session: Session, samples: int | None = None) -> dict[str, IntArray]:
    """What the improved method says of each trial of the test, from its first readings or from all of them.

    Examples
    --------
    >>> from skinfab.fingertip.nail.protocol import Protocol, session
    >>> one = session("edges4", 1, protocol=Protocol(rounds=1, estimates=1, samples=256))
    >>> improved_answers(one, 33)["improved"].shape
    (4,)
    """
    model, windows = learn(session), asked(session, samples)
    return {"improved": model.decide(windows, drive_hz=frequency(windows, model)).classes}


def label_of(touch: Touch) -> Label:
    """What a table of labels would say of a simulated touch."""
    if touch.pattern is None:
        return Label("", 0.0, 1.0, NOTHING, force_n=0.0)
    pattern = touch.pattern
    return Label(
        "",
        0.0,
        1.0,
        pattern.name,
        x_mm=pattern.x_mm,
        y_mm=pattern.y_mm,
        angle_deg=float(np.degrees(pattern.angle_rad)),
        force_n=touch.force_n,
        true_x_mm=touch.x_mm,
        true_y_mm=touch.y_mm,
        true_angle_deg=float(np.degrees(touch.angle_rad)),
    )
