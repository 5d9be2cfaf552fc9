"""preview.png: the object with its seams, the flat pieces with their sensors, the distortion, and the numbers."""

from __future__ import annotations

import io
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinfab.drawings.sheet import sheet_offsets
from skinfab.files import atomic_write
from skinfab.flatten.distortion import Distortion
from skinfab.pieces import Piece
from skinfab.report.labels import Room, dense
from skinfab.report.object_view import SEAM_COLOUR, SENSOR_COLOUR, Picture, View, object_picture, piece_colour, sensor_points
from skinfab.report.raster import rasterise
from skinfab.report.words import count
from skinfab.skin import Skin
from skinfab.tolerances import PREVIEW_CHORD_MM

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: The colour bar is the same in every picture, so that pictures can be compared: 4 is perfect.
D_RANGE = (4.0, 4.2)

_ELEVATION = 22.0  # degrees
_DPI = 150
#: Pixels between a label and any line.
_CLEAR = 3.0
#: So many flat pieces can be told apart and named on a panel; `flat.pdf` has a sheet for each of them.
_MOST = 20
#: As many names fit in a title.
_FEW = 4
#: A label farther from what it names than this, pixels, gets a line to it.
_LEADER = 60.0


def draw_preview(skin: Skin, distortions: Sequence[Distortion], report: Mapping[str, Any], path: str | Path) -> None:
    """Write the preview of a finished skin as PNG.

    Parameters
    ----------
    skin : Skin
    distortions : sequence of Distortion
        One a piece, in order.
    report : mapping
        As `build_report` gives it.
    path : path
    """
    figure = _figure(13.0, 9.8)
    top = figure.add_gridspec(1, 2, left=0.03, right=0.97, top=0.96, bottom=0.56, wspace=0.06, width_ratios=(1.75, 1.0))
    below = figure.add_gridspec(1, 2, left=0.03, right=0.945, top=0.515, bottom=0.02, wspace=0.06)
    _draw_object(figure.add_subplot(top[0, 0]), skin)
    _draw_numbers(figure.add_subplot(top[0, 1]), report)
    shown = shown_pieces(skin)
    _draw_sheet(figure.add_subplot(below[0, 0]), skin, shown)
    _draw_distortion(figure.add_subplot(below[0, 1]), skin, distortions, shown)
    atomic_write(path, _png(figure))


def shown_pieces(skin: Skin) -> list[int]:
    """Positions of the flat pieces that are shown, in order: all, or those with sensors first and then the largest, 20 at most."""
    sensed = {sensor.piece for sensor in skin.sensors}
    order = sorted(range(len(skin.pieces)), key=lambda k: (skin.pieces[k].id not in sensed, -skin.pieces[k].area, k))
    return sorted(order[:_MOST])


def _offsets(pieces: Sequence[Piece]) -> np.ndarray:
    """Where the pieces lie on a panel, with room for their names between them however small they are drawn."""
    longest = max((max(piece.size) for piece in pieces), default=0.0)
    offsets: np.ndarray = sheet_offsets(pieces, spacing=max(10.0, 0.05 * longest * len(pieces) ** 0.5))
    return offsets


def _of_all(skin: Skin, shown: Sequence[int]) -> str:
    """For a title: which of the pieces are shown where not all are."""
    if len(shown) == len(skin.pieces):
        return ""
    return f"{len(shown)} of {len(skin.pieces)} pieces, those with sensors and the largest; flat.pdf has all"


def _draw_object(axes: Axes, skin: Skin) -> None:
    """The object from opposite sides, side by side: what one view does not show, the other one does."""
    box = axes.get_window_extent()
    width, height = int(box.width / 2), int(box.height)
    x, y, z = np.ptp(skin.mesh.bbox, axis=0)
    # The longer side of the object lies across the picture.
    front = -60.0 if x >= y else -30.0
    views = [View(front, _ELEVATION), View(front + 180, -_ELEVATION)]
    # Half a pixel of the picture, whichever way the object is turned.
    lines = sensor_points(skin, spacing=0.25 * max(x, y, z) / max(width, height))
    pictures = [object_picture(skin, view, lines, width=width, height=height) for view in views]
    axes.imshow(np.hstack([picture.image for picture in pictures]), interpolation="none", aspect="equal")
    for k, picture in enumerate(pictures):
        _name_parts(axes, skin, picture, left=k * width)
    hidden = [sensor.id for k, sensor in enumerate(skin.sensors) if not any(k in picture.sensors for picture in pictures)]
    few = ", ".join(hidden) if len(hidden) <= _FEW else count(hidden, "sensor")
    not_seen = f" (not seen: {few})" if hidden else ""
    axes.set_title(f"The object from the front and above, and from the back and below; seams in red{not_seen}", fontsize=10, loc="left")
    axes.set_axis_off()


def _name_parts(axes: Axes, skin: Skin, picture: Picture, *, left: float) -> None:
    """The sensors' names on their middles, the pieces' where there is most room for them."""
    height, width = picture.piece.shape
    free = picture.piece >= 0
    free &= ~picture.drawn
    for k, (column, row) in picture.sensors.items():
        name = skin.sensors[k].id
        _with_halo(axes, (left + column, row), name, size=8.5)
        half = 9.0 * len(name)
        free[max(int(row - 16), 0) : int(row + 16), max(int(column - half), 0) : int(column + half)] = False
    for k, piece in enumerate(skin.pieces):
        rows, columns = np.nonzero(free & (picture.piece == k))
        if not len(rows):
            continue
        room = Room(width, height)
        room.fill(~(free & (picture.piece == k)))
        size = _text_size(axes, piece.id, 9)
        place = room.place(size, near=(float(columns.mean()), float(rows.mean())))
        if place is not None:
            _with_halo(axes, (left + place[0], place[1]), piece.id, size=9, colour=(0.35, 0.0, 0.0))


def _draw_sheet(axes: Axes, skin: Skin, shown: Sequence[int]) -> None:
    """The flat pieces with their sensors, to scale, each with the origin of its own coordinates."""
    from matplotlib.collections import LineCollection, PolyCollection

    pieces = [skin.pieces[k] for k in shown]
    offsets = _offsets(pieces)
    outlines = [piece.outline + offset for piece, offset in zip(pieces, offsets, strict=True)]
    colours = [piece_colour(k) for k in shown]
    axes.add_collection(PolyCollection(outlines, facecolors=colours, edgecolors=[SEAM_COLOUR], linewidths=0.9))
    which = _of_all(skin, shown) or "Flat pieces and sensors; + is the origin (0, 0) of a piece, sizes in mm"
    _sheet_axes(axes, outlines, which)
    sheet = _Sheet(axes)
    for outline in outlines:
        sheet.take(outline, closed=True)
    points_per_mm = 72 / _DPI * sheet.pixels_per_mm
    names = {piece.id: offset for piece, offset in zip(pieces, offsets, strict=True)}
    sensors = [sensor for sensor in skin.sensors if sensor.piece in names]
    for sensor in sensors:
        line = sensor.printed_path.to_polyline(tolerance=PREVIEW_CHORD_MM) + names[sensor.piece]
        bead = max(sensor.pattern.bead * points_per_mm, 0.5)
        axes.add_collection(LineCollection([line], colors=[SENSOR_COLOUR], linewidths=bead, capstyle="round", joinstyle="round"))
        sheet.take(line, width=bead * _DPI / 72)
    for offset in offsets:
        # The lower left corner of its box, where it counts from.
        axes.plot(*offset, marker="+", color="black", markersize=7, markeredgewidth=1.0)
        sheet.take(offset[None], width=14)
    for sensor in sensors:
        # Behind the pads, where the wires will be.
        pads = (sensor.path.start + sensor.path.end) / 2
        behind = pads - (sensor.pattern.pad + 2.0) * np.array([np.cos(sensor.angle), np.sin(sensor.angle)])
        sheet.label([sensor.id], near=behind + names[sensor.piece], of=pads + names[sensor.piece], size=9, colour="white", box="black")
    for piece, offset in zip(pieces, offsets, strict=True):
        width, height = piece.size
        sheet.label([f"{piece.id}  {width:.0f} x {height:.0f}", piece.id], near=offset, of=offset, size=9, colour="black", box="white")
    # Wherever there is room left: it belongs to no piece.
    sheet.scale_bar()


class _Sheet:
    """The panel with the flat pieces: labels in mm, where there is room for them."""

    def __init__(self, axes: Axes) -> None:
        axes.apply_aspect()
        self.axes = axes
        self.box = axes.get_window_extent()
        self.room = Room(self.box.width, self.box.height)
        self.pixels_per_mm = self.box.width / float(np.ptp(axes.get_xlim()))

    def _pixels(self, points: np.ndarray) -> np.ndarray:
        at: np.ndarray = self.axes.transData.transform(points) - (self.box.x0, self.box.y0)
        return at

    def take(self, line: np.ndarray, *, width: float = 1.0, closed: bool = False) -> None:
        """Keep a line (k, 2) mm of that width in pixels free of labels."""
        self.room.take(dense(self._pixels(line), closed=closed), radius=width / 2 + _CLEAR)

    def label(self, texts: Sequence[str], *, near: np.ndarray, of: np.ndarray, size: float, colour: str, box: str) -> None:
        """Write the first of `texts` that there is room for, nearest to `near`; with a line to `of` where it comes to lie far off."""
        for text in texts:
            width, height = _text_size(self.axes, text, size)
            at = self.room.place((width + 6, height + 6), near=self._pixels(near))
            if at is None:
                continue
            target = self._pixels(of)
            place, end = (self.axes.transData.inverted().transform(np.add(xy, (self.box.x0, self.box.y0))) for xy in (at, target))
            if float(np.hypot(*np.subtract(at, target))) > _LEADER + width / 2:
                self.axes.plot([place[0], end[0]], [place[1], end[1]], color="0.35", linewidth=0.6, zorder=2.5)
            _label(self.axes, place, text, size=size, colour=colour, box=box)
            return

    def scale_bar(self) -> None:
        """A bar of a round length, in the free place nearest to the lower left corner."""
        length = round_length(0.22 * self.box.width / self.pixels_per_mm)
        text = f"{length:g} mm"
        width, height = length * self.pixels_per_mm, _text_size(self.axes, text, 9)[1]
        at = self.room.place((width + 16, height + 20), near=(0.0, 0.0))
        if at is None:
            return
        middle = self.axes.transData.inverted().transform(np.add(at, (self.box.x0, self.box.y0)))
        y = middle[1] - height / 2 / self.pixels_per_mm
        self.axes.plot(
            [middle[0] - length / 2, middle[0] + length / 2],
            [y, y],
            color="black",
            linewidth=2.0,
            marker="|",
            markersize=7,
            solid_capstyle="butt",
        )
        self.axes.text(middle[0], y + 7 / self.pixels_per_mm, text, fontsize=9, ha="center", va="bottom")


def round_length(longest: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not longer.

    Examples
    --------
    >>> round_length(37.0), round_length(0.6), round_length(100.0)
    (20.0, 0.5, 100.0)
    """
    power = 10.0 ** np.floor(np.log10(longest))
    return float(max(digit * power for digit in (1, 2, 5) if digit * power <= longest))


def _draw_distortion(axes: Axes, skin: Skin, distortions: Sequence[Distortion], shown: Sequence[int]) -> None:
    """The flat pieces coloured by d, on a colour bar that is the same for every skin."""
    from matplotlib.collections import LineCollection

    pieces = [skin.pieces[k] for k in shown]
    offsets = _offsets(pieces)
    outlines = [piece.outline + offset for piece, offset in zip(pieces, offsets, strict=True)]
    _sheet_axes(axes, outlines, "Distortion d on the flat pieces (4 is perfect)")
    extent = (*axes.get_xlim(), *axes.get_ylim())
    box = axes.get_window_extent()
    image = axes.imshow(
        _distortion_image(pieces, [distortions[k] for k in shown], offsets, extent, (int(box.height), int(box.width))),
        extent=extent,
        origin="lower",
        interpolation="nearest",
        aspect="equal",
        cmap="viridis",
        vmin=D_RANGE[0],
        vmax=D_RANGE[1],
    )
    axes.add_collection(LineCollection([np.vstack([o, o[:1]]) for o in outlines], colors="black", linewidths=0.6))
    bar = axes.figure.colorbar(image, cax=axes.inset_axes((1.02, 0.0, 0.025, 1.0)), extend="max")
    bar.ax.tick_params(labelsize=8)


def _distortion_image(
    pieces: Sequence[Piece], distortions: Sequence[Distortion], offsets: np.ndarray, extent: tuple[float, ...], shape: tuple[int, int]
) -> np.ndarray:
    """d of the face each pixel shows, NaN where there is none: (rows, columns), lowest row first."""
    if not pieces:
        return np.full(shape, np.nan)
    UV = np.vstack([piece.UV + offset for piece, offset in zip(pieces, offsets, strict=True)])
    first = np.cumsum([0, *(len(piece.UV) for piece in pieces)])
    F = np.vstack([piece.F + start for piece, start in zip(pieces, first, strict=False)])
    d = np.append(np.concatenate([each.d for each in distortions]), np.nan)
    left, right, bottom, top = extent
    at = (UV - (left, bottom)) / (right - left, top - bottom) * (shape[1], shape[0]) - 0.5
    face, _ = rasterise(np.column_stack([at, np.zeros(len(at))]), F, shape=shape)
    image: np.ndarray = d[face]
    return image


def _draw_numbers(axes: Axes, report: Mapping[str, Any]) -> None:
    """What one asks first; the page has the tables."""
    axes.set_axis_off()
    axes.text(0.0, 1.0, _printable(report["mesh"]["file"])[:28], fontsize=15, weight="bold", va="top", parse_math=False)
    for k, (name, value) in enumerate(_numbers(report)):
        y = 0.88 - 0.085 * k
        axes.text(0.0, y, name, fontsize=11, color="0.4", va="top", parse_math=False)
        axes.text(0.24, y, value, fontsize=11, va="top", parse_math=False)


def _numbers(report: Mapping[str, Any]) -> list[tuple[str, str]]:
    d, mesh = report["distortion"], report["mesh"]
    size = " x ".join(f"{high - low:.1f}" for low, high in zip(*mesh["bbox_mm"], strict=True))
    kinds = Counter(s["kind"] for s in report["sensors"])
    lines = [
        ("object", f"{size} mm"),
        ("", f"{mesh['n_faces']:,} triangles"),
        ("pieces", f"{len(report['pieces'])}, with {report['seam_mm']:.0f} mm of seams"),
        ("distortion", f"mean {d['mean']:.4f} (4 is perfect)"),
        ("", f"99 % under {d['p99']:.3f}, largest {d['max']:.3f}"),
        ("sensors", ", ".join(f"{number} {kind}" for kind, number in sorted(kinds.items())) or "none"),
    ]
    if report["gcode"]:
        time_s, ink = sum(g["time_s"] for g in report["gcode"]), sum(g["ink_mm3"] for g in report["gcode"])
        lines += [("ink", f"{ink:.0f} mm\u00b3 in {count(report['gcode'], 'file')}"), ("printing", f"{time_s / 60:.1f} min")]
    if report["moulds"]:
        lines += [("silicone", f"{sum(m['cavity_ml'] for m in report['moulds']):.1f} ml in {count(report['moulds'], 'mould')}")]
    if report["warnings"]:
        lines += [("warnings", f"{len(report['warnings'])}, see report.html")]
    return lines


def _printable(text: str) -> str:
    """The text with what the bundled font cannot draw replaced."""
    return text.encode("latin-1", "replace").decode("latin-1")


def _label(axes: Axes, at: np.ndarray, text: str, *, size: float, colour: str, box: str) -> None:
    frame = {"boxstyle": "round,pad=0.15", "facecolor": box, "edgecolor": "none", "alpha": 0.75}
    axes.text(
        float(at[0]),
        float(at[1]),
        text,
        fontsize=size,
        color=colour,
        ha="center",
        va="center",
        bbox=frame,
        parse_math=False,
        clip_on=True,
        zorder=4,
    )


def _with_halo(axes: Axes, at: tuple[float, float], text: str, *, size: float, colour: Any = "black") -> None:
    from matplotlib.patheffects import withStroke

    halo = [withStroke(linewidth=2.5, foreground="white")]
    axes.text(*at, text, fontsize=size, weight="bold", color=colour, ha="center", va="center", path_effects=halo, parse_math=False)


def _text_size(axes: Axes, text: str, size: float) -> tuple[float, float]:
    """Width and height of a text, pixels."""
    trial = axes.text(0, 0, text, fontsize=size, weight="bold", parse_math=False)
    box = trial.get_window_extent()
    trial.remove()
    return float(box.width), float(box.height)


def _sheet_axes(axes: Axes, outlines: list[np.ndarray], title: str) -> None:
    points = np.vstack([*outlines, np.zeros((1, 2))])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.05 * float((high - low).max()) + 1.0
    # Widen the shorter side to the shape of the panel, so that "equal" leaves its size alone.
    box = axes.get_window_extent()
    size = high - low + 2 * margin
    size = np.maximum(size, size[::-1] * (box.width / box.height, box.height / box.width))
    middle = (low + high) / 2
    axes.set_xlim(middle[0] - size[0] / 2, middle[0] + size[0] / 2)
    axes.set_ylim(middle[1] - size[1] / 2, middle[1] + size[1] / 2)
    axes.set_aspect("equal")
    # Each piece has its own coordinates, so the sheet shows none.
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_title(title, fontsize=10, loc="left")


def _figure(width: float, height: float) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=_DPI)
    FigureCanvasAgg(figure)
    return figure


def _png(figure: Figure) -> bytes:
    stream = io.BytesIO()
    figure.savefig(stream, format="png", metadata={"Software": None})
    return stream.getvalue()
