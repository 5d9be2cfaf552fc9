"""The flat skin as DXF: millimetres, one layer a role, arcs as bulges."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path as FilePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.drawings.labels import Label, origin_cross, skin_labels
from skinfab.drawings.seam_sides import SeamSide, seam_sides
from skinfab.drawings.sheet import sheet_offsets
from skinfab.drawings.strokes import NOTCH_MM, TEXT_MM, pad_paths, short_arcs
from skinfab.drawings.svg import THIS_SIDE_OUT
from skinfab.files import atomic_write
from skinfab.paths import Arc, Path
from skinfab.skin import Skin

#: Layer and its AutoCAD colour.
LAYERS = {"OUTLINE": 7, "SEAM": 1, "DART": 30, "BORDER": 8, "NOTCH": 1, "CONDUCTOR": 5, "PAD": 4, "LABEL": 3, "ORIGIN": 3}


def write_dxf(skin: Skin, path: str | FilePath, *, labels: Sequence[Sequence[Label]] | None = None) -> None:
    """Draw the whole skin on one sheet, 1:1, for a cutter or a CAD program.

    A sensor's conductor is one polyline of lines and bulges (exact arcs) on layer CONDUCTOR, as wide as its
    bead; the pads are on PAD; OUTLINE has one closed polyline a piece; SEAM, DART and BORDER have the same
    edges by what they meet, with notches and labels; ORIGIN has a
    cross at the origin of each piece's coordinates. The same skin gives the same bytes.

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
    import ezdxf
    from ezdxf import units

    words = skin_labels(skin) if labels is None else labels
    with _fixed_dates():
        drawing = ezdxf.new("R2010", units=units.MM)
        for name, colour in LAYERS.items():
            drawing.layers.add(name, color=colour)
        space = drawing.modelspace()
        offsets = sheet_offsets(skin.pieces)
        sides = seam_sides(skin.pieces)
        for k, (piece, offset) in enumerate(zip(skin.pieces, offsets, strict=True)):
            space.add_lwpolyline((piece.outline + offset).tolist(), format="xy", close=True, dxfattribs={"layer": "OUTLINE"})
            mine = [side for side in sides if side.piece == k]
            for side in mine:
                _draw_side(space, side, offset)
            for stroke in origin_cross():
                start, end = (stroke + offset).tolist()
                space.add_line(start, end, dxfattribs={"layer": "ORIGIN"})
            for sensor in skin.sensors_on(piece.id):
                _stroke(space, sensor.path, offset, "CONDUCTOR", sensor.pattern.bead)
                for pad in pad_paths(sensor):
                    _stroke(space, pad, offset, "PAD", sensor.pattern.bead)
            for label in words[k]:
                _label(space, label, offset)
        top = max((float((piece.UV + offset)[:, 1].max()) for piece, offset in zip(skin.pieces, offsets, strict=True)), default=0.0)
        _label(space, Label("size", THIS_SIDE_OUT, np.array([0.0, top + 2 * TEXT_MM]), left=True), np.zeros(2))
        # ezdxf would register them in the order of a set of words, which is another in every process.
        for kind in sorted(drawing.entitydb.dxf_types_in_use()):
            drawing.classes.add_class(kind)
        text = io.StringIO()
        drawing.write(text)
    atomic_write(path, text.getvalue())


def _stroke(space: Any, path: Path, offset: NDArray[np.float64], layer: str, bead: float) -> None:
    # A bulge is the tangent of a quarter of the sweep: a whole turn has none, so no arc is over half a turn.
    segments = short_arcs(path, longest=math.pi)
    rows = [(*(s.start + offset).tolist(), math.tan(s.sweep / 4) if isinstance(s, Arc) else 0.0) for s in segments]
    rows.append((*(path.end + offset).tolist(), 0.0))
    space.add_lwpolyline(rows, format="xyb", dxfattribs={"layer": layer, "const_width": bead})


def _draw_side(space: Any, side: SeamSide, offset: NDArray[np.float64]) -> None:
    space.add_lwpolyline((side.points + offset).tolist(), format="xy", dxfattribs={"layer": side.kind.upper()})
    if side.label:
        tip = side.notch + NOTCH_MM * side.inward
        space.add_line(tuple(side.notch + offset), tuple(tip + offset), dxfattribs={"layer": "NOTCH"})


def _label(space: Any, label: Label, offset: NDArray[np.float64]) -> None:
    from ezdxf.enums import TextEntityAlignment

    x, y = (label.at + offset).tolist()
    entity = space.add_text(label.text, height=label.height, dxfattribs={"layer": "LABEL"})
    entity.set_placement((x, y), align=TextEntityAlignment.MIDDLE_LEFT if label.left else TextEntityAlignment.MIDDLE_CENTER)


@contextmanager
def _fixed_dates() -> Iterator[None]:
    """Let ezdxf write constant dates and GUIDs; it has no such argument, only this option."""
    from ezdxf import options

    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before
