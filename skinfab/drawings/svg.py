"""The flat skin as SVG: 1:1 in millimetres, with true arcs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path as FilePath
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from numpy.typing import NDArray

from skinfab.drawings.labels import SMALL_MM, Label, origin_cross, skin_labels
from skinfab.drawings.seam_sides import SeamSide, seam_sides
from skinfab.drawings.sheet import sheet_offsets
from skinfab.drawings.strokes import NOTCH_MM, TEXT_MM, pad_paths, short_arcs
from skinfab.files import atomic_write
from skinfab.paths import Line, Path
from skinfab.skin import Skin

#: White border round the pieces, mm: a piece's name, below it, is inside.
MARGIN_MM = 6.0

#: Mean width of a letter of the legend's sentences, as a part of its height: most are small.
_LETTER = 0.55

#: The legend's rows, above the pieces, and the narrowest sheet, which it fits on (mm).
ROW_MM = 4.5
NARROWEST_MM = 80.0

#: SVG gives an arc by its ends and radius; near half a turn the centre is then ill-determined.
LONGEST_ARC = 2 * math.pi / 3

_STYLE = (
    ".outline{fill:#f4efe6;stroke:none}.seam,.dart,.border,.notch,.origin{fill:none;stroke-width:0.25}"
    ".seam,.notch{stroke:#b03a2e}.dart{stroke:#d68910}.border{stroke:#566573}.origin{stroke:#117a65}"
    ".conductor,.pad{fill:none;stroke-linecap:round;stroke-linejoin:round}.conductor{stroke:#1c2833}.pad{stroke:#2e86c1}"
    # The halo: a white edge that is painted first, so that a word stays readable on whatever it lies.
    f"text{{font:{TEXT_MM:g}px sans-serif;text-anchor:middle;dominant-baseline:central;fill:#212f3d;"
    "stroke:#fff;stroke-width:0.7;stroke-linejoin:round;paint-order:stroke}"
    f".piece-name,.size,.key{{text-anchor:start}}.size,.key{{font-size:{SMALL_MM:g}px}}"
    ".piece-name,.size{fill:#117a65}.seam-number{fill:#b03a2e}.sensor-name{fill:#1a5276;font-weight:bold}"
)

#: What the legend shows: the class of the stroke, the bead where it is as wide as one, and its words.
_LEGEND = (
    ("seam", "seam: equal numbers are joined"),
    ("dart", "dart: joined to its own piece"),
    ("border", "edge of the object"),
    ("conductor", "conductor"),
    ("pad", "contact pad"),
    ("origin", "origin (0, 0) of a piece"),
)
_CLASS = {"piece": "piece-name", "size": "size", "sensor": "sensor-name", "seam": "seam-number"}

#: Said on the drawing: a skin that is turned inside out looks the same as one that is not.
THIS_SIDE_OUT = "This side out: the pieces are seen from outside the object"


def write_svg(skin: Skin, path: str | FilePath, *, labels: Sequence[Sequence[Label]] | None = None) -> None:
    """Draw the whole skin on one sheet, 1:1.

    A legend, and one group a piece, with its outline, its seam sides (with a notch and a number, the same on both
    sides of a seam), its sensors with the bead at its true width, the names of all, its size, and a cross at the
    origin of its coordinates. One user unit is one mm.

    Parameters
    ----------
    skin : Skin
    path : path
    labels : sequence of sequence of Label, optional
        `skinfab.drawings.labels.skin_labels` of the skin, where several drawings are made of it.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    words = skin_labels(skin) if labels is None else labels
    offsets = sheet_offsets(skin.pieces)
    far = np.max([np.zeros(2), *(piece.UV.max(axis=0) + offset for piece, offset in zip(skin.pieces, offsets, strict=True))], axis=0)
    sides = seam_sides(skin.pieces)
    drawn = {side.kind for side in sides} | ({"conductor", "pad"} if skin.sensors else set()) | {"origin"}
    width = max(float(far[0]) + 2 * MARGIN_MM, NARROWEST_MM)
    legend = _legend([(role, words) for role, words in _LEGEND if role in drawn], width)
    height = float(far[1]) + 2 * MARGIN_MM + ROW_MM * len(legend)
    bead = max((sensor.pattern.bead for sensor in skin.sensors), default=0.0)
    body = _draw_legend(legend, bead)
    for k, (piece, offset) in enumerate(zip(skin.pieces, offsets, strict=True)):
        # SVG's y axis points down: the points are flipped here, so that text and arcs need no transform.
        pen = SvgPen(shift=offset + MARGIN_MM, height=height)
        mine = [side for side in sides if side.piece == k]
        body.append(f'<g id={quoteattr(piece.id)} class="piece">')
        body.append(f'<path class="outline" d="{pen.polyline(piece.outline)}Z"/>')
        body += [line for side in mine for line in _seam_side(side, pen)]
        for sensor in skin.sensors_on(piece.id):
            body.append(f'<g id={quoteattr(sensor.id)} class="sensor" stroke-width="{mm(sensor.pattern.bead)}">')
            body += [f'<path class="pad" d="{pen.path(pad)}"/>' for pad in pad_paths(sensor)]
            body.append(f'<path class="conductor" d="{pen.path(sensor.path)}"/>')
            body.append("</g>")
        body.append(f'<path class="origin" d="{"".join(pen.polyline(stroke) for stroke in origin_cross())}"/>')
        body += [pen.label(label) for label in words[k]]
        body.append("</g>")
    w, h = mm(width), mm(height)
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{w}mm" height="{h}mm" viewBox="0 0 {w} {h}">'
    title = f"<title>{escape(skin.mesh.name)}: flat skin, 1:1</title>"
    atomic_write(path, "\n".join(['<?xml version="1.0" encoding="UTF-8"?>', head, title, f"<style>{_STYLE}</style>", *body, "</svg>", ""]))


def _legend(entries: list[tuple[str, str]], width: float) -> list[list[tuple[float, str, str]]]:
    """Rows of place, stroke and words, as many on a row as the sheet is wide; the first is a sentence of its own."""
    rows: list[list[tuple[float, str, str]]] = [[(MARGIN_MM, "", THIS_SIDE_OUT)], []]
    x = MARGIN_MM
    for role, words in entries:
        wide = 2 * ROW_MM + _LETTER * SMALL_MM * len(words)
        if rows[-1] and x + wide > width:
            rows.append([])
            x = MARGIN_MM
        rows[-1].append((x, role, words))
        x += wide
    return rows


def _draw_legend(rows: list[list[tuple[float, str, str]]], bead: float) -> list[str]:
    out = ['<g class="legend">']
    for k, row in enumerate(rows):
        y = MARGIN_MM / 2 + ROW_MM * (k + 0.5)
        for x, role, words in row:
            start = x
            if role == "origin":
                arms = "".join(f"M{mm(x + 1.5 + a)} {mm(y + b)}L{mm(x + 1.5 + c)} {mm(y + d)}" for (a, b), (c, d) in origin_cross())
                out.append(f'<path class="key-stroke origin" d="{arms}"/>')
            elif role:
                thick = f' stroke-width="{mm(bead)}"' if role in ("conductor", "pad") else ""
                out.append(f'<path class="key-stroke {role}"{thick} d="M{mm(x)} {mm(y)}L{mm(x + ROW_MM)} {mm(y)}"/>')
            if role:
                start += ROW_MM + 1.0
            out.append(f'<text class="key" x="{mm(start)}" y="{mm(y)}">{escape(words)}</text>')
    return [*out, "</g>"]


def _seam_side(side: SeamSide, pen: SvgPen) -> list[str]:
    out = [f'<path class="{side.kind}" d="{pen.polyline(side.points)}"/>']
    if side.label:
        tip = side.notch + NOTCH_MM * side.inward
        out.append(f'<path class="notch" d="{pen.polyline(np.array([side.notch, tip]))}"/>')
    return out


class SvgPen:
    """Piece frame to SVG text."""

    def __init__(self, *, shift: NDArray[np.float64], height: float) -> None:
        self.shift, self.height = shift, height

    def point(self, at: NDArray[np.float64]) -> str:
        x, y = at + self.shift
        return f"{mm(x)} {mm(self.height - y)}"

    def polyline(self, points: NDArray[np.float64]) -> str:
        return "M" + "L".join(self.point(p) for p in points)

    def path(self, path: Path) -> str:
        out = [f"M{self.point(path.start)}"]
        for segment in short_arcs(path, longest=LONGEST_ARC):
            if isinstance(segment, Line):
                out.append(f"L{self.point(segment.end)}")
            else:
                # Flag 1 turns clockwise on the screen, which is a negative sweep seen with y up.
                r = mm(segment.radius)
                out.append(f"A{r} {r} 0 0 {int(segment.sweep < 0)} {self.point(segment.end)}")
        return "".join(out)

    def label(self, label: Label) -> str:
        x, y = self.point(label.at).split()
        return f'<text class="{_CLASS[label.kind]}" x="{x}" y="{y}">{escape(label.text)}</text>'


def mm(value: float) -> str:
    """Six decimals, a nanometre, without trailing zeros or a negative zero."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
