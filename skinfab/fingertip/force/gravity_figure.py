"""The lines of all poses and the centre of gravity, in space."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skinfab.files import atomic_path
from skinfab.fingertip.force.gravity import Centre, lines
from skinfab.fingertip.force.poses import Poses

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D

_DPI, _MOST = 130, 6
#: Of lines to either side of the centre; and the least that is shown of them, mm.
_LEAST_MM = 5.0
#: Of a normal distribution in space, the ellipsoid that holds 95 % reaches so many standard deviations (square root of chi-square's).
_STATED_SD = 2.7954834829151074
_STATED_COLOUR = "#009E73"


def draw_centres(
    objects: Sequence[tuple[str, Poses, Centre, Centre | None]], path: Path, *, simulated: bool, weighed: bool = False
) -> None:
    """Write the figure as PNG: six objects at most, each with its lines (offset taken off), its centre and the published one.

    What is stated of the centre is drawn as the three great ellipses of the ellipsoid that holds 95 % of the errors.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    shown = objects[:_MOST]
    columns = min(len(shown), 3)
    rows = -(-len(shown) // columns)
    figure = Figure(figsize=(max(4.2 * columns, 6.0), 4.2 * rows + 0.6), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    more = f", the first {_MOST} of {len(objects)}" if len(objects) > _MOST else ""
    figure.suptitle(f"Centre of gravity{' (simulated)' if simulated else ''}{more}", fontsize=10)
    for k, (name, poses, centre, published) in enumerate(shown):
        axes = figure.add_subplot(rows, columns, k + 1, projection="3d")
        _draw(axes, poses, centre, published, "centre, hand weighed" if weighed else "centre, offset fitted")
        axes.set_title(f"{name}: +- {centre.sd_mm:.2f} mm", fontsize=8)
        if k == 0:
            axes.legend(fontsize=6, loc="upper left")
    with atomic_path(path) as partial:
        figure.savefig(partial)


def ellipses(centre: Centre) -> NDArray[np.float64]:
    """Three closed lines (3, 61, 3), mm: where the ellipsoid of 95 % cuts the planes of its axes.

    Examples
    --------
    >>> one = Centre(np.zeros(3), np.diag([1.0, 4.0, 9.0]), np.zeros(3), 0.1, np.zeros(5), 1.0, 0.5)
    >>> np.abs(ellipses(one)).max(axis=(0, 1)).round(2).tolist()
    [2.8, 5.59, 8.39]
    """
    values, directions = np.linalg.eigh(centre.covariance)
    axes = _STATED_SD * np.sqrt(values) * directions
    angle = np.linspace(0, 2 * np.pi, 61)[:, None]
    return np.stack([centre.point + np.cos(angle) * axes[:, j] + np.sin(angle) * axes[:, (j + 1) % 3] for j in range(3)])


def _draw(axes: Axes3D, poses: Poses, centre: Centre, published: Centre | None, label: str) -> None:
    q, g = lines(poses.force, poses.moment - centre.offset)
    apart = 0.0 if published is None else float(np.linalg.norm(published.point - centre.point))
    stated = ellipses(centre)
    reach = max(_LEAST_MM, 1.3 * apart, 2 * float(centre.residual_mm.max()), 1.1 * float(np.abs(stated - centre.point).max()))
    along = np.einsum("ni,ni->n", centre.point - q, g)[:, None]
    ends = (q + (along - reach) * g, q + (along + reach) * g)
    for k, (a, b) in enumerate(zip(*ends, strict=True)):
        axes.plot(*np.stack([a, b], axis=1), color="#0072B2", lw=0.8, alpha=0.7, label="line of a pose" if k == 0 else None)
    for k, ring in enumerate(stated):
        axes.plot(*ring.T, color=_STATED_COLOUR, lw=1.2, label="stated, 95 %" if k == 0 else None)
    axes.plot(*centre.point[:, None], "o", color="#000000", ms=3, label=label)
    if published is not None:
        axes.plot(*published.point[:, None], "x", color="#D55E00", ms=7, mew=2, label="as published")
    for each, name, middle in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), "xyz", centre.point.tolist(), strict=True):
        each(middle - reach, middle + reach)
        getattr(axes, f"set_{name}label")(f"{name}, mm", fontsize=7)
    axes.tick_params(labelsize=6)
    axes.set_box_aspect((1, 1, 1), zoom=0.82)  # the names of its axes lie outside, and neighbours would cover them
