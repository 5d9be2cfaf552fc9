"""What a chart of a benchmark owes its reader: the point of the project's default ringed, and why it is the default."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING

from skinfab.files import atomic_write

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_GREY = "#555555"
#: By this a ring is known among the marks of a figure.
_RING = "ring of the default"
#: Letters of 8 points in an inch, and the width of the margins.
_LETTERS_AN_INCH, _MARGINS_INCHES, _SIZE = 15, 0.6, 8
#: Height of a line of them, and what is left free below.
_LINE_INCHES, _PAD_INCHES = 0.14, 0.06


def ring(axes: Axes, x: float, y: float, *, size: float = 14, color: str = _GREY, label: str | None = None) -> None:
    """Draw a ring round the point (x, y) of the default; `size` in points."""
    axes.plot(x, y, "o", ms=size, mfc="none", mec=color, mew=1.5, zorder=4, label=label, gid=_RING)


def save(figure: Figure, path: Path, *, default: str, notes: Sequence[str] = ()) -> None:
    """Write the figure as PNG; below it stands why the default is where its ring is, and so does in the file's Description.

    Parameters
    ----------
    figure : Figure
        With the default's point under a `ring`.
    path : Path
    default : str
        What the default is, and after a colon why: "one in 16: fewer save no more time".
    notes : sequence of str
        What the other marks mean; a line each.

    Raises
    ------
    ValueError
        Nothing is ringed, or no reason is given.

    Examples
    --------
    >>> import tempfile
    >>> from matplotlib.figure import Figure
    >>> figure = Figure(layout="constrained")
    >>> axes = figure.subplots()
    >>> _ = axes.plot([1, 2, 3], [9, 5, 4.9], "o-")
    >>> ring(axes, 2, 5)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save(figure, Path(folder) / "a.png", default="two: a third gains 2 %")
    ...     (Path(folder) / "a.png").read_bytes()[1:4]
    b'PNG'
    """
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    if not any(artist.get_gid() == _RING for axes in figure.axes for artist in axes.lines):
        raise ValueError(f"{path.name}: the default is marked nowhere; draw a ring round its point")
    what, _, why = default.partition(": ")
    if not (what and why):
        raise ValueError(f"{path.name}: {default!r} does not say what the default is and, after a colon, why")
    letters = round(_LETTERS_AN_INCH * (figure.get_figwidth() - _MARGINS_INCHES))
    words = "\n".join(fill(line, letters) for line in (f"ring: the default, {default}", *notes))
    inches = _PAD_INCHES + _LINE_INCHES * (words.count("\n") + 1)
    if isinstance(layout := figure.get_layout_engine(), ConstrainedLayoutEngine):
        # A strip for the words is added below; keys outside of the panels stand above it, and the panels above these.
        figure.set_figheight(figure.get_figheight() + inches)
        figure.draw_without_rendering()
        keys = max((key.get_window_extent().height / figure.dpi + 2 * _PAD_INCHES for key in figure.legends), default=0.0)
        words_part, both_part = inches / figure.get_figheight(), (inches + keys) / figure.get_figheight()
        layout.set(rect=(0, both_part, 1, 1 - both_part))
        for key in figure.legends:
            key.set_bbox_to_anchor((0, words_part, 1, 1 - words_part), transform=figure.transFigure)
    figure.text(0.5, _PAD_INCHES / figure.get_figheight(), words, ha="center", va="bottom", fontsize=_SIZE)
    atomic_write(path, png(figure, description=f"The default is {default}."))


def png(figure: Figure, *, description: str | None = None) -> bytes:
    """The figure as a PNG file, with a description in it where one is given."""
    drawn = io.BytesIO()
    figure.savefig(drawn, format="png", metadata={"Description": description} if description else None)
    return drawn.getvalue()
