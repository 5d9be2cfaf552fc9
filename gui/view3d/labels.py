"""Names of pieces and sensors and numbers of seams, where they face the viewer and do not cover each other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gui.view3d.camera import Camera
from gui.view3d.marks import SeamLabels
from gui.view3d.painter import Painter

#: Pixels between those looked at to find the middle of what is seen of a piece.
_STEP = 8

#: A piece, or a sensor, of which fewer of these or less than this share is seen bears no name.
_LEAST_PIXELS, _LEAST_SHARE = 6, 0.25

#: Pixels between a sensor's conductor and its name.
_BESIDE = 16


@dataclass(frozen=True)
class Label:
    """A word on the picture.

    Parameters
    ----------
    text : str
    x, y : float, pixels
        Of its middle.
    kind : "piece", "sensor" or "seam"
    """

    text: str
    x: float
    y: float
    kind: str


def piece_labels(painter: Painter, owner: NDArray[np.int64], names: list[str]) -> list[Label]:
    """At the seen pixel nearest to the middle of what is seen of each piece; `owner` as the scene gives it."""
    columns, rows, faces = painter.faces(_STEP)
    which = owner[faces]
    labels = []
    for k in np.unique(which[which >= 0]).tolist():
        mine = which == k
        if mine.sum() >= _LEAST_PIXELS:
            x, y = columns[mine], rows[mine]
            nearest = int(np.argmin((x - x.mean()) ** 2 + (y - y.mean()) ** 2))
            labels.append(Label(names[k], float(x[nearest]), float(y[nearest]), "piece"))
    return labels


def sensor_label(painter: Painter, camera: Camera, name: str, line: NDArray[np.float64]) -> Label | None:
    """Above what is seen of a conductor (k, 3) mm; None where too little is."""
    few = line[:: max(len(line) // 60, 1)]
    few = few[np.isfinite(few).all(axis=1)]
    if not len(few):
        return None
    screen = camera.to_screen(few)
    seen = screen[painter.is_seen(screen)]
    if len(seen) < _LEAST_SHARE * len(few):
        return None
    return Label(name, float(seen[:, 0].mean()), float(seen[:, 1].min()) - _BESIDE, "sensor")


def seam_labels(painter: Painter, camera: Camera, labels: SeamLabels) -> list[Label]:
    """Numbers of the seams whose notches are seen."""
    screen = camera.to_screen(labels.points)
    seen = painter.is_seen(screen)
    return [Label(labels.text[k], float(screen[k, 0]), float(screen[k, 1]), "seam") for k in np.flatnonzero(seen).tolist()]


def without_overlap(labels: list[Label], size: Callable[[Label], tuple[float, float]]) -> list[Label]:
    """Those, first come first served, whose boxes (width, height in pixels) do not touch one before.

    Examples
    --------
    >>> words = [Label("A", 10, 10, "seam"), Label("B", 15, 10, "seam"), Label("C", 40, 10, "seam")]
    >>> [label.text for label in without_overlap(words, lambda label: (12, 12))]
    ['A', 'C']
    """
    kept: list[tuple[Label, float, float]] = []
    for label in labels:
        w, h = size(label)
        if all(2 * abs(label.x - o.x) >= w + ow or 2 * abs(label.y - o.y) >= h + oh for o, ow, oh in kept):
            kept.append((label, w, h))
    return [label for label, _, _ in kept]
