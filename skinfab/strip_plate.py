"""A plate of calibration strips: a flat skin whose sensors are lines of three lengths, cast and printed like any other."""

from __future__ import annotations

import csv
import hashlib
import io
import math
from pathlib import Path

import numpy as np

from skinfab.errors import InputError
from skinfab.files import atomic_write
from skinfab.material import Material
from skinfab.mesh.model import Mesh
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source

#: Length of a strip, mm, and in how many parallel lines it lies. Sixteen times between shortest and longest tells area
#: and contact apart with few strips, and spans the paper's sensors, whose lines are 110 to 660 mm long.
STRIPS = ((640.0, 8), (160.0, 4), (40.0, 2))

#: Rows of one strip of each length; more do not fit the bed.
COPIES_MAX = 8

#: Distance of neighbouring lines and room between strips, mm; larger where the bead asks for it.
_PITCH_MM = 2.0
_APART_MM = 4.0


def strip(length: float, lines: int, material: Material) -> StrainLines:
    """A line of exactly `length` mm between its terminals, folded into `lines` parallel ones.

    Examples
    --------
    >>> from skinfab.material import load_material
    >>> round(strip(160.0, 4, load_material()).path().length, 9)
    160.0
    """
    bead, gap = material.ink.bead_width, material.gap
    pitch = max(_PITCH_MM, bead + gap)
    r, lead = pitch / 2, 2 * pitch
    # length = 2 (l1 - r) + (lines - 2) (l1 - lead - 2 r) + (lines - 1) pi r
    l1 = (length + 2 * r + (lines - 2) * (lead + 2 * r) - (lines - 1) * math.pi * r) / lines
    return StrainLines(l1=l1, l2=l1 - lead, b=(lines - 1) * pitch, lines=lines, bead=bead, gap=gap, pad=material.pad)


def strip_skin(material: Material, *, copies: int = 4, material_name: str, printer_name: str) -> Skin:
    """A rectangular plate with `copies` strips of each length, all pads towards its left or right edge.

    Parameters
    ----------
    material : Material
    copies : int
        2 to 8.
    material_name, printer_name : str
        For the document.

    Raises
    ------
    InputError
        So many copies are not to be had.
    """
    if not 2 <= copies <= COPIES_MAX:
        raise InputError(f"{copies} strips of each length; a plate has 2 to {COPIES_MAX}, and the scatter is told by several")
    patterns = [strip(length, lines, material) for length, lines in STRIPS]
    boxes = [np.array(pattern.printed_path().bbox) for pattern in patterns]
    bead = material.ink.bead_width
    (w0, h0), (w1, h1), (_w2, h2) = (np.ptp(box, axis=0) + bead for box in boxes)
    edge, apart = material.margin + 1.0, max(_APART_MM, 2 * material.gap)
    row = max(h0, h1 + apart + h2) + apart
    width, height = 2 * edge + w0 + apart + w1, 2 * edge + copies * row - apart
    sensors: list[Sensor] = []
    for copy in range(copies):
        bottom = edge + copy * row
        # The long one from the left edge, the two others from the right, turned half round.
        places = ((0.0, edge, bottom), (math.pi, width - edge, bottom), (math.pi, width - edge, bottom + h1 + apart))
        for pattern, box, (length, _), (angle, x, y) in zip(patterns, boxes, STRIPS, places, strict=True):
            low = box[0] if angle == 0 else -box[1]
            high = box[1] if angle == 0 else -box[0]
            at_x = x - low[0] + bead / 2 if angle == 0 else x - high[0] - bead / 2
            name = f"L{length:g}-{copy + 1}"
            sensors.append(Sensor(name, "P1", pattern, float(at_x), float(y - low[1] + bead / 2), angle, len(sensors)))
    V = np.array([[0.0, 0, 0], [width, 0, 0], [width, height, 0], [0, height, 0]])
    F = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int64)
    piece = Piece("P1", np.arange(2), np.arange(4), F, V[:, :2])
    source = Source("strips", hashlib.sha256(V.tobytes()).hexdigest(), "mm", 1.0)
    none = np.zeros((0, 2), dtype=np.int64)
    return Skin(Mesh(V, F, "strips"), source, none, (piece,), tuple(sensors), printer=printer_name, material=material_name)


def write_strip_table(skin: Skin, path: str | Path) -> None:
    """A CSV file to fill in: sensor, length_mm, and r_kohm, which is empty."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["sensor", "length_mm", "r_kohm"])
    table.writerows([sensor.id, round(sensor.path.length, 3), ""] for sensor in skin.sensors)
    atomic_write(path, text.getvalue())
