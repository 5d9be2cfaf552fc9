"""wrap_strain.svg: the flat pieces with every conductor coloured by what wearing will stretch it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from skinfab.drawings.sheet import sheet_offsets
from skinfab.files import atomic_write
from skinfab.placement.wrap_strain import running_mean
from skinfab.report.strains import SensorStrains
from skinfab.report.words import percent
from skinfab.skin import Skin
from skinfab.tolerances import CAUTION_WRAP_STRAIN

FloatArray = NDArray[np.float64]

#: Colours from squeezed to stretched; the ends stand for what is warned of, and beyond.
SQUEEZED, NEITHER, STRETCHED = (0.02, 0.27, 0.75), (0.62, 0.62, 0.62), (0.80, 0.05, 0.05)
#: Steps of colour to either side of none: finer ones are not told apart.
_STEPS = 10
#: Every so many samples (a quarter of a millimetre each) a point is drawn.
_EVERY = 3
_MARGIN = 8.0  # mm
_TEXT = 3.5  # mm
_LEGEND = 16.0  # mm


def write_strain_picture(skin: Skin, strains: SensorStrains, path: str | Path) -> None:
    """Draw the flat pieces 1:1 and their conductors, blue where they will be squeezed, red where they will be stretched.

    The colours end at `tolerances.CAUTION_WRAP_STRAIN`, so that pictures can be compared.

    Parameters
    ----------
    skin : Skin
    strains : SensorStrains
        Of this skin.
    path : path

    Raises
    ------
    InputError
        The file cannot be written.
    """
    offsets = sheet_offsets(skin.pieces)
    at = {piece.id: offset + _MARGIN for piece, offset in zip(skin.pieces, offsets, strict=True)}
    far = np.max([np.full(2, 60.0), *(piece.UV.max(axis=0) + at[piece.id] for piece in skin.pieces)], axis=0)
    width, height = float(far[0]) + _MARGIN, float(far[1]) + _MARGIN + _LEGEND

    def down(points: FloatArray) -> FloatArray:
        # SVG counts y down from the top.
        return np.column_stack([points[:, 0], far[1] + _MARGIN - points[:, 1]])

    body = [
        f'<path d="{_line(down(piece.outline + at[piece.id]))}Z" fill="#f7f7f7" stroke="#999" stroke-width="0.3"/>' for piece in skin.pieces
    ]
    names = []
    for sensor, along in zip(skin.sensors, strains.along, strict=True):
        strain = running_mean(along.together, along.lengths, strains.even)
        points = down(along.points + at[sensor.piece])
        title = f"{sensor.id}: mean {percent(float(strain @ along.lengths / along.lengths.sum())):g} %"
        body.append(f'<g fill="none" stroke-width="{sensor.pattern.bead:g}"><title>{escape(title)}</title>')
        body += [f'<path stroke="{colour(level / _STEPS)}" d="{_line(points[run])}"/>' for level, run in _runs(strain)]
        body.append("</g>")
        x, y = points.mean(axis=0)
        names.append(f'<text x="{x:.2f}" y="{y:.2f}">{escape(sensor.id)}</text>')
    style = (
        f"text{{font:{_TEXT}px sans-serif;text-anchor:middle;dominant-baseline:central;stroke:#fff;stroke-width:0.9;"
        "paint-order:stroke}path{stroke-linecap:round;stroke-linejoin:round}"
    )
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.2f}mm" height="{height:.2f}mm" viewBox="0 0 {width:.2f} {height:.2f}">'
    title = f"<title>{escape(skin.mesh.name)}: wrap strain, 1:1</title>"
    bar = _colour_bar(width / 2, height - _LEGEND)
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', head, title, f"<style>{style}</style>", *body, *names, *bar, "</svg>", ""]
    atomic_write(path, "\n".join(lines))


def colour(part: float) -> str:
    """Colour of a strain, as a part of the scale from -1 to 1.

    Examples
    --------
    >>> colour(0.0), colour(-1.0), colour(7.0)
    ('#9e9e9e', '#0545bf', '#cc0d0d')
    """
    end = np.array(STRETCHED if part > 0 else SQUEEZED)
    rgb = np.array(NEITHER) + min(abs(part), 1.0) * (end - NEITHER)
    return "#" + "".join(f"{round(255 * float(c)):02x}" for c in rgb)


def _runs(strain: FloatArray) -> Iterator[tuple[int, NDArray[np.int64]]]:
    """Colour steps along a path, and the samples that are drawn in each: the next run's first one too, so that no gap is seen."""
    level = np.clip(np.rint(strain / CAUTION_WRAP_STRAIN * _STEPS), -_STEPS, _STEPS).astype(np.int64)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(level)) + 1, [len(level)]])
    for first, last in zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True):
        end = min(last, len(level) - 1)
        run = np.unique(np.append(np.arange(first, end, _EVERY), end))
        yield int(level[first]), run


def _line(points: FloatArray) -> str:
    return "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in points.tolist())


def _colour_bar(middle: float, top: float) -> list[str]:
    """The scale, with its ends and what they mean."""
    step = 2.2
    left = middle - step * (2 * _STEPS + 1) / 2
    out = [
        f'<rect x="{left + step * k:.2f}" y="{top:.2f}" width="{step + 0.05:.2f}" height="4" fill="{colour((k - _STEPS) / _STEPS)}"/>'
        for k in range(2 * _STEPS + 1)
    ]
    most = f"{percent(CAUTION_WRAP_STRAIN):g} %"
    right = left + step * (2 * _STEPS + 1)
    labels = [(left, f"-{most} and below"), (middle, "0"), (right, f"+{most} and above")]
    out += [f'<text x="{x:.2f}" y="{top + 7:.2f}">{text}</text>' for x, text in labels]
    out.append(f'<text x="{middle:.2f}" y="{top + 12:.2f}">strain from lying flat to being worn</text>')
    return out
