"""The flat pieces as PDF at true size, to lay under the glass of the bed or beside the moulds: a piece a sheet of A4, or tiled."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path as FilePath
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from skinfab import __version__
from skinfab.drawings.labels import SMALL_MM, Label, origin_cross, skin_labels
from skinfab.drawings.seam_sides import SeamSide, seam_sides
from skinfab.drawings.strokes import NOTCH_MM, TEXT_MM, pad_paths, short_arcs
from skinfab.drawings.tiles import BORDER_MM, FOOT_MM, Tiling, tile
from skinfab.files import atomic_path
from skinfab.mould import CastingMould
from skinfab.paths import Arc, Path
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin
from skinfab.wire_exits import wire_pads

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.transforms import Affine2D

#: A PDF's own unit.
POINTS_PER_MM = 72 / 25.4

#: The bar that is measured after printing, mm, and the arms of a mould's L marks and of the crosses where sheets meet.
BAR_MM = 100.0
MARK_MM = 6.0

#: Room round a piece for its name and its seams' numbers, mm.
_ROOM_MM = 8.0

#: Arcs become cubic Bezier curves of at most a twelfth of a turn, which leave them by less than 4e-7 of the radius.
_BEZIER = np.pi / 6

_COLOUR = {"seam": "#b03a2e", "dart": "#d68910", "border": "#566573", "sensor": "#1a5276", "piece": "#117a65", "size": "#117a65"}
_INK, _PAD, _MOULD, _PLAIN = "#1c2833", "#2e86c1", "#7d3c98", "#212f3d"


def write_pdf(
    skin: Skin, path: str | FilePath, *, moulds: Sequence[CastingMould] = (), labels: Sequence[Sequence[Label]] | None = None
) -> None:
    """Draw each piece at true size on A4; the same skin gives the same bytes.

    A sheet shows the outline with its seams, notches and seam numbers, the sensors with the bead at its true width and
    their terminals' numbers on the pads, the piece's origin, and a bar of 100 mm to measure what the printer made of it.
    A piece larger than a sheet is spread over several that overlap by 10 mm, with crosses that must agree.

    Parameters
    ----------
    skin : Skin
        With one piece at least.
    path : path
    moulds : sequence of CastingMould, optional
        Of these, the L marks and the wires' ways from pad to slot are drawn too.
    labels : sequence of sequence of Label, optional
        `skinfab.drawings.labels.skin_labels` of the skin, where several drawings are made of it.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    import matplotlib
    from matplotlib.backends.backend_pdf import PdfPages

    words = skin_labels(skin) if labels is None else labels
    by_piece = {mould.piece: mould for mould in moulds}
    sides = seam_sides(skin.pieces)
    facts = {"Title": f"{skin.mesh.name}: flat pieces, 1:1", "Creator": f"skinfab {__version__}", "Producer": None, "CreationDate": None}
    # Helvetica is in every reader: nothing to embed, and its words can be searched.
    with (
        matplotlib.rc_context({"pdf.use14corefonts": True, "font.family": "Helvetica", "font.weight": "medium", "pdf.compression": 6}),
        atomic_path(path) as partial,
        PdfPages(partial, metadata=facts) as pages,
    ):
        for k, piece in enumerate(skin.pieces):
            mine = [side for side in sides if side.piece == k]
            drawing = _Drawing(piece, mine, skin.sensors_on(piece.id), by_piece.get(piece.id), words[k])
            tiling = tile(*drawing.box)
            rows, columns = tiling.corners.shape[:2]
            for row in range(rows):
                for column in range(columns):
                    which = f", sheet {row * columns + column + 1} of {rows * columns}" if rows * columns > 1 else ""
                    place = f" (row {row + 1} from below, column {column + 1})" if which else ""
                    title = f"{skin.mesh.name}, piece {piece.id}{which}{place}"
                    pages.savefig(_sheet(drawing, tiling, tiling.corners[row, column], title))


def _sheet(drawing: _Drawing, tiling: Tiling, corner: NDArray[np.float64], title: str) -> Figure:
    """One page: the drawing as seen through its window, and the foot."""
    from matplotlib.figure import Figure
    from matplotlib.transforms import Affine2D, Bbox

    figure = Figure(figsize=(tiling.sheet[0] / 25.4, tiling.sheet[1] / 25.4), dpi=72)
    at = np.array([BORDER_MM, BORDER_MM + FOOT_MM])
    window = Bbox([at * POINTS_PER_MM, (at + tiling.window) * POINTS_PER_MM])
    pen = _Pen(figure, Affine2D().translate(*(at - corner)).scale(POINTS_PER_MM), window)
    drawing.draw(pen)
    for x, y in tiling.joins:
        for dx, dy in ((MARK_MM / 2, 0.0), (0.0, MARK_MM / 2)):
            pen.line([[x - dx, y - dy], [x + dx, y + dy]], _PLAIN)
    foot = _Pen(figure, Affine2D().scale(POINTS_PER_MM), None)
    foot.frame(at, tiling.window)
    _foot(foot, title)
    return figure


def _foot(pen: _Pen, title: str) -> None:
    """Title, what to set when printing, and the bar."""
    y = BORDER_MM + 2.0
    pen.line([[BORDER_MM, y], [BORDER_MM + BAR_MM, y]], _PLAIN, width=0.3)
    for k in range(11):
        x = BORDER_MM + BAR_MM * k / 10
        pen.line([[x, y], [x, y + (2.0 if k % 5 == 0 else 1.2)]], _PLAIN, width=0.3)
    pen.text("100 mm", (BORDER_MM + BAR_MM + 2.0, y + 0.5), SMALL_MM, _PLAIN, left=True)
    pen.text(title, (BORDER_MM, y + 10.5), TEXT_MM, _PLAIN, left=True)
    hint = "Print at 100 %, not fitted to the page: the bar must measure 100 mm. Seen from outside the object, as its mould lies."
    pen.text(hint, (BORDER_MM, y + 6.0), SMALL_MM, _PLAIN, left=True)


class _Pen:
    """Draws on a page, in mm of a frame."""

    def __init__(self, figure: Figure, frame_to_points: Affine2D, window: Any) -> None:
        self.figure, self.place, self.window = figure, frame_to_points, window

    def path(self, vertices: Any, codes: Any, colour: str, *, width: float = 0.0, fill: str = "none", dashed: bool = False) -> None:
        from matplotlib.patches import PathPatch
        from matplotlib.path import Path as Curve

        patch = PathPatch(
            Curve(np.asarray(vertices, dtype=float), codes),
            transform=self.place,
            facecolor=fill,
            edgecolor=colour,
            linewidth=width * POINTS_PER_MM,
            linestyle=(0, (4, 3)) if dashed else "solid",
            capstyle="round",
            joinstyle="round",
        )
        self._add(patch)

    def line(self, points: Any, colour: str, *, width: float = 0.25, dashed: bool = False) -> None:
        self.path(points, [1] + [2] * (len(points) - 1), colour, width=width, dashed=dashed)

    def region(self, outline: NDArray[np.float64], fill: str) -> None:
        # The last vertex only closes it.
        self.path(np.vstack([outline, outline[:1]]), [1] + [2] * (len(outline) - 1) + [79], "none", fill=fill)

    def stroke(self, path: Path, colour: str, width: float) -> None:
        """A path with its arcs as curves."""
        vertices, codes = [path.start], [1]
        for segment in short_arcs(path, longest=_BEZIER):
            if isinstance(segment, Arc):
                vertices += _bezier(segment)
                codes += [4, 4, 4]
            else:
                vertices.append(segment.end)
                codes.append(2)
        self.path(vertices, codes, colour, width=width)

    def frame(self, at: NDArray[np.float64], size: tuple[float, float]) -> None:
        (x, y), (w, h) = at, size
        self.line([[x, y], [x + w, y], [x + w, y + h], [x, y + h], [x, y]], "#aab7b8", width=0.1)

    def text(self, words: str, at: Any, height: float, colour: str, *, left: bool = False) -> None:
        from matplotlib.text import Text

        side = "left" if left else "center"
        size = height * POINTS_PER_MM
        x, y = at
        # A dollar sign is one, and not the beginning of a formula.
        text = Text(float(x), float(y), words, fontsize=size, color=colour, parse_math=False, ha=side, va="center")
        text.set_transform(self.place)
        self._add(text)

    def _add(self, artist: Any) -> None:
        artist.set_figure(self.figure)
        if self.window is not None:
            artist.set_clip_box(self.window)
        self.figure.add_artist(artist)


class _Drawing:
    """All that is drawn of one piece, in its frame."""

    def __init__(
        self, piece: Piece, sides: Sequence[SeamSide], sensors: Sequence[Sensor], mould: CastingMould | None, labels: Sequence[Label]
    ) -> None:
        self.piece, self.sides, self.sensors, self.mould, self.labels = piece, sides, sensors, mould, labels
        corners = [piece.UV - _ROOM_MM, piece.UV + _ROOM_MM]
        if mould is not None:
            corners += [mould.marks - 1.0, mould.marks + 1.0]
        points = np.vstack(corners)
        self.box = points.min(axis=0), points.max(axis=0)

    def draw(self, pen: _Pen) -> None:
        pen.region(self.piece.outline, "#f4efe6")
        for side in self.sides:
            pen.line(side.points, _COLOUR[side.kind])
            if side.label:
                pen.line([side.notch, side.notch + NOTCH_MM * side.inward], _COLOUR["seam"])
        for sensor in self.sensors:
            for pad in pad_paths(sensor):
                pen.stroke(pad, _PAD, sensor.pattern.bead)
            pen.stroke(sensor.path, _INK, sensor.pattern.bead)
        for stroke in origin_cross():
            pen.line(stroke, _COLOUR["piece"])
        if self.mould is not None:
            self._draw_mould(pen, self.mould)
        for label in self.labels:
            if label.over_ink:
                pen.region(np.array(label.box.exterior.coords)[:-1], "white")
            pen.text(label.text, label.at, label.height, _COLOUR[label.kind], left=label.left)
        for each in wire_pads(self.sensors):
            pen.text(str(each.terminal), each.at, SMALL_MM, "white")

    def _draw_mould(self, pen: _Pen, mould: CastingMould) -> None:
        for (x, y), (dx, dy) in zip(mould.marks, ((1, 1), (-1, 1), (1, -1)), strict=True):
            pen.line([[x + MARK_MM * dx, y], [x, y], [x, y + MARK_MM * dy]], _MOULD, width=0.3)
        for slot in mould.wire_slots:
            pen.line([slot.pad, slot.at, slot.out], _MOULD, width=0.15, dashed=True)


def _bezier(arc: Arc) -> list[NDArray[np.float64]]:
    """The cubic curve that has the arc's ends, tangents and middle."""
    a, b = arc.start_angle, arc.start_angle + arc.sweep
    reach = 4 / 3 * np.tan(arc.sweep / 4) * arc.radius
    start, end = arc.start, arc.end
    return [start + reach * np.array([-np.sin(a), np.cos(a)]), end - reach * np.array([-np.sin(b), np.cos(b)]), end]
