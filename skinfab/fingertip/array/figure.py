"""Figures of an array: what a log says, and how good a learned model is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from skinfab.files import atomic_path
from skinfab.fingertip.array.analyser import Reading
from skinfab.fingertip.array.judge import QUANTITIES, WAYS, Error
from skinfab.fingertip.array.matched import ArrayModel
from skinfab.fingertip.array.peak import PeakFinder

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

_DPI = 150
#: Told apart without red and green, and in print.
_STATES = {
    "point": "#000000",
    "line": "#0072B2",
    "patch": "#009E73",
    "several": "#E69F00",
    "wide": "#CC79A7",
    "edge": "#56B4E9",
    "past": "#D55E00",
}
_EVENTS = {"touch": "#009E73", "lift": "#777777", "slip": "#D55E00", "roll": "#0072B2"}
#: Frames whose contours are drawn, and at which parts of a peak.
_CONTOURS, _PARTS = 6, (0.25, 0.5, 0.75, 0.95)
_WAYS = {"published": "#000000", "drawn": "#E69F00", "learned": "#D55E00"}


def draw_run(readings: Sequence[Reading], model: ArrayModel, path: Path, *, title: str, simulated: bool) -> None:
    """Write where the finger was touched, on its unrolled skin and over time, with lines, forces and events, as PNG.

    Parameters
    ----------
    readings : sequence of Reading
    model : ArrayModel
    path : Path
    title : str
    simulated : bool
    """
    figure = _figure((11.4, 8.2))
    figure.suptitle(f"{title}{' (simulated)' if simulated else ''}: centre of pressure, directions, events, contours", fontsize=10)
    upper, lower = figure.subfigures(2, 1, squeeze=False, height_ratios=(1.7, 1)).ravel()
    left, right = upper.subfigures(1, 2, width_ratios=(1, 1.6))
    skin, times = left.subplots(), right.subplots(3, 1, sharex=True)
    _draw_contours(lower, [reading for reading in readings if reading.place.force_n > 0], model)
    touched = [reading for reading in readings if math.isfinite(reading.place.axial_mm)]
    _draw_skin(skin, touched, model)
    _draw_times(times, readings)
    _save(figure, path)


def _draw_times(panels: Sequence[Axes], readings: Sequence[Reading]) -> None:
    """Place along, angle and force of every contact over time, and the events."""
    span = readings[-1].time - readings[0].time
    for axes, label, value in zip(
        panels,
        ("along, mm", "around, degrees", "force, N"),
        (lambda one: one.axial_mm, lambda one: math.degrees(one.angle_rad), lambda one: one.force_n),
        strict=True,
    ):
        for state, colour in _STATES.items():
            of = [
                (reading.time, value(one)) for reading in readings if reading.state == state for one in reading.contacts or (reading.place,)
            ]
            axes.plot([t for t, _ in of], [v for _, v in of], ".", ms=3, color=colour)
        for event in (event for reading in readings for event in reading.events):
            axes.axvspan(event.start, max(event.end, event.start + 0.01 * span), color=_EVENTS[event.kind], alpha=0.25, lw=0)
        axes.set_ylabel(label, fontsize=8)
        axes.tick_params(labelsize=7)
        axes.grid(True, lw=0.3, alpha=0.6)
    for kind, colour in _EVENTS.items():
        panels[0].fill_between([], [], [], color=colour, alpha=0.25, lw=0, label=kind)
    panels[0].legend(fontsize=7, ncols=4, loc="lower right", bbox_to_anchor=(1, 1))
    panels[2].set_xlabel("time, s", fontsize=8)


def _draw_skin(axes: Axes, touched: Sequence[Reading], model: ArrayModel) -> None:
    g = model.geometry
    i, j = np.meshgrid(np.arange(g.rings), np.arange(g.stripes), indexing="ij")
    angles = [math.degrees(g.from_tactels(0, int(k))[1]) for k in j.ravel()]
    axes.plot(angles, i.ravel() * g.ring_pitch, "s", ms=3, mfc="none", color="#bbbbbb", label="tactels")
    for state, colour in _STATES.items():
        of = [reading for reading in touched if reading.state == state]
        each = [one for reading in of for one in reading.contacts or (reading.place,)]
        if of:
            axes.plot([math.degrees(one.angle_rad) for one in each], [one.axial_mm for one in each], ".", ms=5, color=colour, label=state)
        for reading in of:
            if (line := reading.line) is not None and line.orientation.sure:
                half, a = line.length_mm / 2, line.line_rad
                dx, dy = math.degrees(half * math.cos(a) / g.finger_radius), half * math.sin(a)
                centre = math.degrees(line.angle_rad)
                axes.plot([centre - dx, centre + dx], [line.axial_mm - dy, line.axial_mm + dy], "-", lw=0.3, color=colour)
    axes.set(xlabel="angle around the finger, degrees", ylabel="place along it, mm from ring 0", xlim=(-180, 180))
    axes.legend(fontsize=7)


def _draw_contours(figure: SubFigure, touched: Sequence[Reading], model: ArrayModel) -> None:
    """Lines of equal deflection, as the seed's figure 6: at the frames of events, and between them where there are few."""
    from skinfab.fingertip.array.contours import contour
    from skinfab.fingertip.array.interpolate import Coefficients

    g = model.geometry
    at = [k for k, reading in enumerate(touched) if any(event.kind in ("touch", "slip", "roll") for event in reading.events)]
    spread = np.linspace(0, len(touched) - 1, _CONTOURS).astype(int).tolist() if touched else []
    chosen = sorted([*at[:_CONTOURS], *[k for k in spread if k not in at][: max(_CONTOURS - len(at), 0)]])
    sinc = Coefficients("sinc", g.shape)
    for axes, k in zip(figure.subplots(1, _CONTOURS, sharey=True), chosen, strict=False):
        reading = touched[k]
        C = sinc(np.where(np.isfinite(reading.Z), reading.Z, 0.0))
        for peak in PeakFinder(g).all(reading.Z):
            for part in _PARTS:
                points, _ = contour(C, sinc.kind, g, peak, part=part)
                for turn in (-360, 0, 360):  # whatever lies beyond the seam goes on at the other side
                    axes.plot(np.degrees(points[:, 1]) + turn, points[:, 0], "-", lw=0.8, color="#0072B2")
        for one in reading.contacts or (reading.place,):
            axes.plot(math.degrees(one.angle_rad), one.axial_mm, "+", color="#D55E00")
        axes.set(xlim=(-180, 180), xticks=(-180, -90, 0, 90, 180), ylim=(0, (g.rings - 1) * g.ring_pitch), title=f"{reading.time:.2f} s")
        axes.title.set_fontsize(8)
        axes.tick_params(labelsize=7)
    figure.supxlabel(f"degrees; contours at {', '.join(f'{100 * part:.0f}' for part in _PARTS)} % of each peak of the sinc", fontsize=8)


def draw_training(model: ArrayModel, errors: Sequence[Error], path: Path, *, simulated: bool) -> None:
    """Write held-out errors by way, and the gains, as PNG."""
    figure = _figure((11.4, 3.8))
    figure.suptitle(f"An array's model on logs that were held out{' (simulated)' if simulated else ''}", fontsize=10)
    *panels, gains = figure.subplots(1, len(QUANTITIES) + 1)
    for axes, (quantity, unit) in zip(panels, QUANTITIES.items(), strict=True):
        for k, way in enumerate(WAYS):
            for each in (one for one in errors if (one.quantity, one.way) == (quantity, way)):
                span = [[max(each.rms - each.low, 0)], [max(each.high - each.rms, 0)]]
                axes.bar(k, each.rms, color=_WAYS[way], width=0.7)
                axes.errorbar(k, each.rms, yerr=span, color="#555555", capsize=3)
        if quantity == "force":
            axes.text(0, 0, "the published\nway tells\nno force", ha="center", va="bottom", fontsize=7)
        axes.set_xlim(-0.6, len(WAYS) - 0.4)
        axes.set_xticks(range(len(WAYS)), WAYS, fontsize=8)
        axes.set_title(f"{quantity}: rms, {unit}", fontsize=9)
    shown = gains.imshow(model.gains, cmap="viridis", origin="lower")
    gains.set(xlabel="stripe", ylabel="ring")
    gains.set_title("gains", fontsize=9)
    figure.colorbar(shown, ax=gains)
    _save(figure, path)


def _figure(size: tuple[float, float]) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=size, dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def _save(figure: Figure, path: Path) -> None:
    with atomic_path(path) as partial:
        figure.savefig(partial)
