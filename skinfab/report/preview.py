"""preview.png: the object with its seams, the flat pieces with their sensors, the distortion, and the numbers."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinfab.drawings.sheet import sheet_offsets
from skinfab.files import atomic_write
from skinfab.flatten.distortion import Distortion
from skinfab.report.object_view import SEAM_COLOUR, SENSOR_COLOUR, View, object_image, piece_colour, sensor_points
from skinfab.report.raster import rasterise
from skinfab.report.words import count, percent
from skinfab.skin import Skin
from skinfab.tolerances import PREVIEW_CHORD_MM

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: The colour bar is the same in every picture, so that pictures can be compared: 4 is perfect.
D_RANGE = (4.0, 4.2)

_ELEVATION = 22.0  # degrees
_DPI = 150
_ROWS_OF_TABLE = 9


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
    figure = _figure(13.0, 9.4)
    grid = figure.add_gridspec(2, 2, left=0.04, right=0.945, top=0.96, bottom=0.045, wspace=0.10, hspace=0.16, height_ratios=(1.0, 1.05))
    _draw_object(figure.add_subplot(grid[0, 0]), skin)
    _draw_numbers(figure.add_subplot(grid[0, 1]), report)
    _draw_sheet(figure.add_subplot(grid[1, 0]), skin)
    _draw_distortion(figure.add_subplot(grid[1, 1]), skin, distortions)
    atomic_write(path, _png(figure))


def _draw_object(axes: Axes, skin: Skin) -> None:
    """The object from two sides, side by side."""
    box = axes.get_window_extent()
    width, height = int(box.width / 2), int(box.height)
    x, y, z = np.ptp(skin.mesh.bbox, axis=0)
    # The longer side of the object lies across the picture; what one view does not show, the opposite one does.
    front = -60.0 if x >= y else -30.0
    views = [View(azimuth, _ELEVATION) for azimuth in (front, front + 180)]
    # Half a pixel of the picture, whichever way the object is turned.
    lines = sensor_points(skin, spacing=0.25 * max(x, y, z) / max(width, height))
    images = [object_image(skin, view, lines, width=width, height=height) for view in views]
    axes.imshow(np.hstack(images), interpolation="none", aspect="equal")
    size = f"{x:.0f} x {y:.0f} x {z:.0f}"
    axes.set_title(f"The object from two sides, {size} mm; seams in red", fontsize=10, loc="left")
    axes.set_axis_off()


def _draw_sheet(axes: Axes, skin: Skin) -> None:
    """The flat pieces with their sensors, to scale."""
    from matplotlib.collections import LineCollection, PolyCollection

    offsets = sheet_offsets(skin.pieces)
    outlines = [piece.outline + offset for piece, offset in zip(skin.pieces, offsets, strict=True)]
    colours = [piece_colour(k) for k in range(len(outlines))]
    axes.add_collection(PolyCollection(outlines, facecolors=colours, edgecolors=[SEAM_COLOUR], linewidths=0.9))
    _sheet_axes(axes, outlines, "Flat pieces and sensors, mm")
    points_per_mm = 72 / _DPI * axes.get_window_extent().width / float(np.ptp(axes.get_xlim()))
    names = {piece.id: offset for piece, offset in zip(skin.pieces, offsets, strict=True)}
    for sensor in skin.sensors:
        line = sensor.printed_path.to_polyline(tolerance=PREVIEW_CHORD_MM) + names[sensor.piece]
        bead = max(sensor.pattern.bead * points_per_mm, 0.5)
        axes.add_collection(LineCollection([line], colors=[SENSOR_COLOUR], linewidths=bead, capstyle="round", joinstyle="round"))
        # Behind the pads, where the wires will be.
        behind = (sensor.path.start + sensor.path.end) / 2 - (sensor.pattern.pad + 3.0) * np.array(
            [np.cos(sensor.angle), np.sin(sensor.angle)]
        )
        _label(axes, behind + names[sensor.piece], sensor.id, size=8, colour="white", box="black")
    for piece, outline in zip(skin.pieces, outlines, strict=True):
        _label(axes, outline[np.argmin(outline @ (1.0, 1.0))], piece.id, size=9, colour="black", box="white")


def _draw_distortion(axes: Axes, skin: Skin, distortions: Sequence[Distortion]) -> None:
    """The flat pieces coloured by d, on a colour bar that is the same for every skin."""
    from matplotlib.collections import LineCollection

    offsets = sheet_offsets(skin.pieces)
    outlines = [piece.outline + offset for piece, offset in zip(skin.pieces, offsets, strict=True)]
    _sheet_axes(axes, outlines, "Distortion d on the flat pieces (4 is perfect)")
    extent = (*axes.get_xlim(), *axes.get_ylim())
    box = axes.get_window_extent()
    image = axes.imshow(
        _distortion_image(skin, distortions, offsets, extent, (int(box.height), int(box.width))),
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
    skin: Skin, distortions: Sequence[Distortion], offsets: np.ndarray, extent: tuple[float, ...], shape: tuple[int, int]
) -> np.ndarray:
    """d of the face each pixel shows, NaN where there is none: (rows, columns), lowest row first."""
    if not skin.pieces:
        return np.full(shape, np.nan)
    UV = np.vstack([piece.UV + offset for piece, offset in zip(skin.pieces, offsets, strict=True)])
    first = np.cumsum([0, *(len(piece.UV) for piece in skin.pieces)])
    F = np.vstack([piece.F + start for piece, start in zip(skin.pieces, first, strict=False)])
    d = np.append(np.concatenate([each.d for each in distortions]), np.nan)
    left, right, bottom, top = extent
    at = (UV - (left, bottom)) / (right - left, top - bottom) * (shape[1], shape[0]) - 0.5
    face, _ = rasterise(np.column_stack([at, np.zeros(len(at))]), F, shape=shape)
    image: np.ndarray = d[face]
    return image


def _draw_numbers(axes: Axes, report: Mapping[str, Any]) -> None:
    d, mesh = report["distortion"], report["mesh"]
    parts = f"{count(report['pieces'], 'piece')}, {report['seam_mm']:.0f} mm of seams"
    lines = [
        f"{_printable(mesh['file'])[:40]}: {mesh['n_faces']} faces, {parts}",
        f"d mean {d['mean']:.4f}  p99 {d['p99']:.4f}  max {d['max']:.4f}",
        "",
        f"{'piece':<8}{'faces':>8}{'area mm2':>11}{'d mean':>9}{'d p99':>9}{'d max':>9}",
        *_rows(
            [
                f"{p['id'][:8]:<8}{p['n_faces']:>8}{p['area_mm2']:>11.1f}"
                f"{p['distortion']['mean']:>9.4f}{p['distortion']['p99']:>9.4f}{p['distortion']['max']:>9.3f}"
                for p in report["pieces"]
            ]
        ),
        "",
    ]
    if report["sensors"]:
        lines += [
            f"{'sensor':<8}{'kind':<15}{'piece':<7}{'mm':>7}{'kohm (90 %)':>20}{'wrap strain':>13}",
            *_rows(
                [
                    f"{s['id'][:7]:<8}{s['kind'][:14]:<15}{s['piece'][:6]:<7}{s['length_mm']:>7.1f}{_interval(s['resistance_kohm']):>20}"
                    f"{percent(s['wrap_strain']['mean']):>11.2f} %"
                    for s in report["sensors"]
                ]
            ),
            "",
        ]
    if report["gcode"]:
        time_s, ink = sum(g["time_s"] for g in report["gcode"]), sum(g["ink_mm3"] for g in report["gcode"])
        lines += [f"G-code: {count(report['gcode'], 'file')}, {time_s / 60:.1f} min, {ink:.0f} mm3 of ink"]
    if report["moulds"]:
        lines += [f"Moulds: {count(report['moulds'], 'file')}, {sum(m['cavity_ml'] for m in report['moulds']):.1f} ml of silicone"]
    axes.set_axis_off()
    # One size for all lines: as large as the longest and their number allow.
    size = min(9.2, 250 / max(len(lines), 1), 640 / max(len(line) for line in lines))
    axes.text(0.0, 1.0, "\n".join(lines), family="monospace", fontsize=size, va="top", transform=axes.transAxes, parse_math=False)


def _interval(kohm: Mapping[str, float]) -> str:
    return f"{kohm['median']:.0f} ({kohm['low']:.0f}-{kohm['high']:.0f})"


def _rows(rows: list[str]) -> list[str]:
    """As many rows as there is room for; the rest by their number."""
    return rows if len(rows) <= _ROWS_OF_TABLE else [*rows[: _ROWS_OF_TABLE - 1], f"... and {len(rows) - _ROWS_OF_TABLE + 1} more"]


def _printable(text: str) -> str:
    """The text with what the bundled font cannot draw replaced."""
    return text.encode("latin-1", "replace").decode("latin-1")


def _label(axes: Axes, at: np.ndarray, text: str, *, size: float, colour: str, box: str) -> None:
    frame = {"boxstyle": "round,pad=0.15", "facecolor": box, "edgecolor": "none", "alpha": 0.75}
    axes.text(
        float(at[0]), float(at[1]), text, fontsize=size, color=colour, ha="center", va="center", bbox=frame, parse_math=False, clip_on=True
    )


def _sheet_axes(axes: Axes, outlines: list[np.ndarray], title: str) -> None:
    points = np.vstack([*outlines, np.zeros((1, 2))])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.04 * float((high - low).max()) + 1.0
    # Widen the shorter side to the shape of the panel, so that "equal" leaves its size alone.
    box = axes.get_window_extent()
    size = high - low + 2 * margin
    size = np.maximum(size, size[::-1] * (box.width / box.height, box.height / box.width))
    middle = (low + high) / 2
    axes.set_xlim(middle[0] - size[0] / 2, middle[0] + size[0] / 2)
    axes.set_ylim(middle[1] - size[1] / 2, middle[1] + size[1] / 2)
    axes.set_aspect("equal")
    axes.tick_params(labelsize=8)
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
