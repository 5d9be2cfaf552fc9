"""A pattern's picture for the docs: the printed stroke with true arcs, and its parameters as a draughtsman gives them."""

from __future__ import annotations

from html import escape

import numpy as np
from numpy.typing import NDArray

from skinfab.drawings.strokes import pad_paths
from skinfab.drawings.svg import SvgPen, mm
from skinfab.patterns.base import Dimension, Pattern
from skinfab.placement.edit import middle_of
from skinfab.placement.sensor import Sensor

Array = NDArray[np.float64]

#: Width of the picture, px.
_WIDTH_PX = 760
#: Height of the letters, and of a row of dimensions, as parts of the picture's width.
_TEXT, _ROW = 0.022, 0.04
#: A dimension across the pattern lies beside it if it is within this part of its width from an end, else where it is.
_BESIDE = 0.25

_STYLE = (
    ".conductor,.pad{fill:none;stroke-linecap:round;stroke-linejoin:round}.conductor{stroke:#1c2833}.pad{stroke:#2e86c1}"
    ".dimension{fill:none;stroke:#b03a2e}.middle{fill:none;stroke:#117a65}"
    "text{font-family:sans-serif;text-anchor:middle;dominant-baseline:central;fill:#b03a2e;stroke:#fff;stroke-linejoin:round;paint-order:stroke}"
)


def pattern_svg(pattern: Pattern) -> str:
    """The picture of a pattern: conductor black, pads blue, its middle a green cross, its dimensions red.

    Parameters
    ----------
    pattern : Pattern

    Returns
    -------
    str
        SVG; one unit is one mm. The same pattern gives the same text.
    """
    sensor = Sensor("", "", pattern, 0.0, 0.0, 0.0, 0)
    box = sensor.printed_path.bbox + np.array([[-1.0], [1.0]]) * pattern.bead / 2
    unit = float(np.ptp(box[:, 0]))
    row, text, thin = _ROW * unit, _TEXT * unit, 0.0025 * unit
    dimensions, frame = _laid_out(pattern.dimensions(), box, row)
    low, (width, height) = frame[0], np.ptp(frame, axis=0)
    pen = SvgPen(shift=-low, height=height)
    body = [f'<rect width="{mm(width)}" height="{mm(height)}" fill="#fff"/>']
    body += [f'<path class="pad" stroke-width="{mm(pattern.bead)}" d="{pen.path(pad)}"/>' for pad in pad_paths(sensor)]
    body.append(f'<path class="conductor" stroke-width="{mm(pattern.bead)}" d="{pen.path(sensor.path)}"/>')
    arm = np.array([0.3 * row, 0.0])
    cross = "".join(pen.polyline(middle_of(sensor) + np.outer([-1, 1], a)) for a in (arm, arm[::-1]))
    body.append(f'<path class="middle" stroke-width="{mm(2 * thin)}" d="{cross}"/>')
    for name, strokes, at in dimensions:
        body.append(f'<path class="dimension" stroke-width="{mm(thin)}" d="{"".join(pen.polyline(s) for s in strokes)}"/>')
        x, y = pen.point(at).split()
        body.append(f'<text x="{x}" y="{y}" font-size="{mm(text)}" stroke-width="{mm(0.3 * text)}">{escape(name)}</text>')
    w, h = mm(width), mm(height)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_WIDTH_PX}" height="{round(_WIDTH_PX * height / width)}" viewBox="0 0 {w} {h}">'
    )
    return "\n".join([head, f"<title>{escape(pattern.kind)}</title>", f"<style>{_STYLE}</style>", *body, "</svg>", ""])


def _laid_out(dimensions: tuple[Dimension, ...], box: Array, row: float) -> tuple[list[tuple[str, list[Array], Array]], Array]:
    """Each dimension's name, strokes and the place of its name; and the box of all, with a border of one row."""
    used = {"below": 0, "above": 0, "left": 0, "right": 0}
    out = []
    for name, start, end in dimensions:
        ends = np.array([start, end])
        side = _side(ends, box)
        moved = ends.copy()
        if side:
            used[side] += 1
            axis, low = (1, side == "below") if side in ("below", "above") else (0, side == "left")
            moved[:, axis] = box[0, axis] - used[side] * row if low else box[1, axis] + used[side] * row
        along = (ends[1] - ends[0]) / np.hypot(*(ends[1] - ends[0]))
        across = np.array([-along[1], along[0]]) * 0.15 * row
        strokes = [moved, *(np.array([m - across, m + across]) for m in moved)]
        if side:
            strokes += [np.array([a, b]) for a, b in zip(ends, moved, strict=True)]
        at = moved.mean(axis=0) + (0.0 if side else np.array([0.5 * row, 0.0]))
        out.append((name, strokes, at))
    rim = np.array([[-used["left"] - 1, -used["below"] - 1], [used["right"] + 1, used["above"] + 1]]) * row
    return out, box + rim


def _side(ends: Array, box: Array) -> str:
    """Where a dimension is drawn: on the side of the pattern that it is nearer to, or "" for in its place."""
    middle, centre, size = ends.mean(axis=0), box.mean(axis=0), np.ptp(box, axis=0)
    if abs(ends[1, 0] - ends[0, 0]) > abs(ends[1, 1] - ends[0, 1]):
        return "below" if middle[1] <= centre[1] else "above"
    if abs(middle[0] - centre[0]) < (0.5 - _BESIDE) * size[0]:
        return ""
    return "left" if middle[0] < centre[0] else "right"
