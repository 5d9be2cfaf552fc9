"""Held solids in three dimensions, as the paper's fig. 16: contacts, normals, where these meet, the centre of gravity, the solid."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from skinfab.files import atomic_path
from skinfab.fingertip.force.grasp import CUBOID, SPHERE, Touches
from skinfab.fingertip.force.reconstruct import Solved, meeting_point

if TYPE_CHECKING:
    from mpl_toolkits.mplot3d import Axes3D

FloatArray = NDArray[np.float64]

#: More are not told apart on a page.
MOST_PANELS = 6
_DPI = 130
_NORMAL_MM = 25.0


@dataclass(frozen=True, eq=False)
class View:
    """One solid in the figure.

    Parameters
    ----------
    title : str
    found : Touches
    solved : Solved or None
        None where nothing was reconstructed.
    centre : (3,) float or None, mm
        Centre of gravity, where it was estimated.
    simulated : bool
    """

    title: str
    found: Touches
    solved: Solved | None
    centre: FloatArray | None
    simulated: bool


def draw_solids(views: Sequence[View], path: Path) -> None:
    """Write the first `MOST_PANELS` as PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    shown = views[:MOST_PANELS]
    columns = min(len(shown), 3)
    rows = math.ceil(len(shown) / columns)
    figure = Figure(figsize=(3.7 * columns, 3.8 * rows + 0.4), dpi=_DPI)
    FigureCanvasAgg(figure)
    figure.subplots_adjust(left=0.01, right=0.97, top=0.93, bottom=0.1 / rows + 0.03, wspace=0.05, hspace=0.12)
    for k, view in enumerate(shown):
        _draw(figure.add_subplot(rows, columns, k + 1, projection="3d"), view)
    figure.legend(
        handles=[
            Line2D([], [], marker="o", ls="", color="#E69F00", label="contact"),
            Line2D([], [], color="#CC79A7", label="normal"),
            Line2D([], [], marker="D", ls="", color="#000000", label="where the normals meet"),
            Line2D([], [], marker="o", ls="", color="#D55E00", label="centre of gravity"),
        ],
        loc="lower center",
        ncols=4,
        fontsize=7,
        frameon=False,
    )
    with atomic_path(path) as partial:
        figure.savefig(partial, metadata={"Software": None})


def _draw(axes: Axes3D, view: View) -> None:
    P, N = view.found.point, view.found.normal
    if view.solved is not None:
        _solid(axes, view.solved, P)
    axes.scatter(*P.T, color="#E69F00", s=28, depthshade=False)
    axes.quiver(*P.T, *(_NORMAL_MM * N.T), color="#CC79A7", lw=1.2, arrow_length_ratio=0.25)
    axes.scatter(*meeting_point(P, N), color="#000000", marker="D", s=22, depthshade=False)
    if view.centre is not None:
        axes.scatter(*view.centre, color="#D55E00", s=30, depthshade=False)
    middle = P.mean(axis=0)
    reach = float(np.abs(np.vstack([P, P + _NORMAL_MM * N]) - middle).max())
    axes.set(xlim=middle[0] + [-reach, reach], ylim=middle[1] + [-reach, reach], zlim=middle[2] + [-reach, reach])
    axes.set_box_aspect((1, 1, 1))
    axes.tick_params(labelsize=5, pad=-3)
    axes.set_xlabel("x, mm", fontsize=5, labelpad=-9)
    axes.set_ylabel("y, mm", fontsize=5, labelpad=-9)
    axes.set_zlabel("z, mm", fontsize=5, labelpad=-9)
    axes.set_title(view.title + (" (simulated)" if view.simulated else ""), fontsize=7, parse_math=False)


def _solid(axes: Axes3D, solved: Solved, P: FloatArray) -> None:
    look: dict[str, Any] = {"color": "#56B4E9", "alpha": 0.25, "linewidth": 0}
    around, along = np.meshgrid(np.linspace(0, 2 * np.pi, 40), np.linspace(0, 1, 20))
    if solved.shape == CUBOID:
        _box(axes, solved)
        return
    if solved.shape == SPHERE:
        polar = np.pi * along
        own = np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], axis=-1) * solved.size[0]
    else:  # as long as the contacts and a margin: how long it is nobody felt
        reach = (P - solved.centre) @ solved.turn[:, 2]
        low, high = reach.min() - 20, reach.max() + 20
        own = np.stack([solved.size[0] * np.cos(around), solved.size[0] * np.sin(around), low + (high - low) * along], axis=-1)
    place = own @ solved.turn.T + solved.centre
    axes.plot_surface(place[..., 0], place[..., 1], place[..., 2], **look)


def _box(axes: Axes3D, solved: Solved) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    # A side that no finger touched is drawn without thickness.
    half = np.nan_to_num(np.array(solved.size)) / 2
    faces = []
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        for sign in (-1, 1):
            corners = np.zeros((4, 3))
            corners[:, k] = sign * half[k]
            corners[:, a] = half[a] * np.array([-1, 1, 1, -1])
            corners[:, b] = half[b] * np.array([-1, -1, 1, 1])
            faces.append(corners @ solved.turn.T + solved.centre)
    axes.add_collection3d(Poly3DCollection(faces, facecolor="#56B4E9", alpha=0.25, edgecolor="#56B4E9", linewidth=0.6))
