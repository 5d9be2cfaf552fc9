"""The flat skin as SVG: 1:1 in millimetres, with true arcs."""

from __future__ import annotations

import math
from pathlib import Path as FilePath
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from numpy.typing import NDArray

from skinfab.drawings.seam_sides import SeamSide, seam_sides
from skinfab.drawings.sheet import sheet_offsets
from skinfab.drawings.strokes import NOTCH_MM, TEXT_MM, name_place, pad_paths, short_arcs
from skinfab.files import atomic_write
from skinfab.paths import Line, Path
from skinfab.skin import Skin

#: White border round the pieces, mm.
MARGIN_MM = 5.0

#: SVG gives an arc by its ends and radius; near half a turn the centre is then ill-determined.
LONGEST_ARC = 2 * math.pi / 3

_STYLE = (
    ".outline{fill:#f4efe6;stroke:none}.seam,.dart,.border,.notch{fill:none;stroke-width:0.25}"
    ".seam,.notch{stroke:#b03a2e}.dart{stroke:#d68910}.border{stroke:#566573}"
    ".conductor,.pad{fill:none;stroke-linecap:round;stroke-linejoin:round}.conductor{stroke:#1c2833}.pad{stroke:#2e86c1}"
    f"text{{font:{TEXT_MM:g}px sans-serif;text-anchor:middle;dominant-baseline:central;fill:#212f3d}}"
)


def write_svg(skin: Skin, path: str | FilePath) -> None:
    """Draw the whole skin on one sheet, 1:1.

    One group a piece, with its outline, its seam sides (with a notch and a number, the same on both sides of
    a seam), its sensors with the bead at its true width, and the names of all. One user unit is one mm.

    Parameters
    ----------
    skin : Skin
    path : path

    Raises
    ------
    InputError
        The file cannot be written.
    """
    offsets = sheet_offsets(skin.pieces)
    far = np.max([np.zeros(2), *(piece.UV.max(axis=0) + offset for piece, offset in zip(skin.pieces, offsets, strict=True))], axis=0)
    width, height = far + 2 * MARGIN_MM
    sides = seam_sides(skin.pieces)
    body = []
    for k, (piece, offset) in enumerate(zip(skin.pieces, offsets, strict=True)):
        # SVG's y axis points down: the points are flipped here, so that text and arcs need no transform.
        pen = _Pen(shift=offset + MARGIN_MM, height=height)
        body.append(f'<g id={quoteattr(piece.id)} class="piece">')
        body.append(f'<path class="outline" d="{pen.polyline(piece.outline)}Z"/>')
        body += [line for side in sides if side.piece == k for line in _seam_side(side, pen)]
        for sensor in skin.sensors_on(piece.id):
            body.append(f'<g id={quoteattr(sensor.id)} class="sensor" stroke-width="{_number(sensor.pattern.bead)}">')
            body += [f'<path class="pad" d="{pen.path(pad)}"/>' for pad in pad_paths(sensor)]
            body.append(f'<path class="conductor" d="{pen.path(sensor.path)}"/>')
            body.append(pen.text(sensor.path.bbox.mean(axis=0), sensor.id))
            body.append("</g>")
        body.append(pen.text(name_place(piece), piece.id))
        body.append("</g>")
    w, h = _number(width), _number(height)
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{w}mm" height="{h}mm" viewBox="0 0 {w} {h}">'
    title = f"<title>{escape(skin.mesh.name)}: flat skin, 1:1</title>"
    atomic_write(path, "\n".join(['<?xml version="1.0" encoding="UTF-8"?>', head, title, f"<style>{_STYLE}</style>", *body, "</svg>", ""]))


def _seam_side(side: SeamSide, pen: _Pen) -> list[str]:
    out = [f'<path class="{side.kind}" d="{pen.polyline(side.points)}"/>']
    if side.label:
        tip = side.notch + NOTCH_MM * side.inward
        out.append(f'<path class="notch" d="{pen.polyline(np.array([side.notch, tip]))}"/>')
        out.append(pen.text(tip + TEXT_MM * 0.6 * side.inward, side.label))
    return out


class _Pen:
    """Piece frame to SVG text."""

    def __init__(self, *, shift: NDArray[np.float64], height: float) -> None:
        self.shift, self.height = shift, height

    def point(self, at: NDArray[np.float64]) -> str:
        x, y = at + self.shift
        return f"{_number(x)} {_number(self.height - y)}"

    def polyline(self, points: NDArray[np.float64]) -> str:
        return "M" + "L".join(self.point(p) for p in points)

    def path(self, path: Path) -> str:
        out = [f"M{self.point(path.start)}"]
        for segment in short_arcs(path, longest=LONGEST_ARC):
            if isinstance(segment, Line):
                out.append(f"L{self.point(segment.end)}")
            else:
                # Flag 1 turns clockwise on the screen, which is a negative sweep seen with y up.
                r = _number(segment.radius)
                out.append(f"A{r} {r} 0 0 {int(segment.sweep < 0)} {self.point(segment.end)}")
        return "".join(out)

    def text(self, at: NDArray[np.float64], text: str) -> str:
        x, y = self.point(at).split()
        return f'<text x="{x}" y="{y}">{escape(text)}</text>'


def _number(value: float) -> str:
    """Six decimals, a nanometre, without trailing zeros or a negative zero."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
