"""Where a file is printed: in the mould of one piece of a skin, which stands on the bed as the report says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gcode.check_ink import Pieces
from gcode.check_wall import Wall, wall_of
from gcode.emit import TITLE
from gcode.geometry import Point
from gcode.moves import Finding, Trace
from gcode.printer import Printer
from gcode.seat import seat
from gcode.words import lines_of
from skinfab.errors import InputError
from skinfab.flatten.locate import Locator
from skinfab.material import Material
from skinfab.pieces import Piece

if TYPE_CHECKING:
    from skinfab.skin import Skin

#: How the second line of skinfab's own files begins.
_HEAD, _HEAD_LINE = "; piece ", 2


@dataclass(frozen=True, eq=False)
class Mould:
    """The mould of a `piece`, moved by `offset` (mm) onto the bed; its `wall` stands round it."""

    piece: Piece
    offset: Point
    wall: Wall


def mould_of(skin: Skin, text: str, *, printer: Printer, material: Material, piece: str | None = None) -> Mould:
    """The mould that a file is for: of the piece that is named, that the file's own head names, or the only one with sensors.

    Raises
    ------
    InputError
        No such piece, or which one is meant is not said.
    RefusedError
        Its mould does not lie on the printer's bed.
    """
    pieces = {p.id: p for p in skin.pieces}
    name = piece or head_piece(text)
    inked = [p for p in pieces if skin.sensors_on(p)]
    if name is None and len(inked) != 1:
        raise InputError(f"it does not say which piece it is for; give --piece, one of {', '.join(inked or pieces)}")
    name = name or inked[0]
    if name not in pieces:
        raise InputError(f"there is no piece {name} in the skin; give --piece, one of {', '.join(inked or pieces)}")
    offset = seat(skin, pieces[name], printer=printer, material=material)
    return Mould(pieces[name], offset, wall_of(pieces[name], material, offset))


def head_piece(text: str) -> str | None:
    """Which piece one of skinfab's own files says it is for.

    Examples
    --------
    >>> head_piece("; skinfab print program, version 1\\n; piece P2\\nG28 X Y"), head_piece("; piece P2\\nG28 X Y")
    ('P2', None)
    """
    first, second = (line.rstrip() for line in [*lines_of(text), ""][:2])
    return second.removeprefix(_HEAD).strip() if first == TITLE and second.startswith(_HEAD) else None


def piece_findings(text: str, mould: Mould) -> Iterator[Finding]:
    """Is it for another piece, by its own head? Then nothing that is found of this one's mould and wall is of use."""
    if (named := head_piece(text)) not in (None, mould.piece.id):
        what = f"its head says it is for piece {named}, it is judged for piece {mould.piece.id}"
        yield Finding(_HEAD_LINE, what, "give the file of that piece, or --piece as the head says; the mould is judged then")


def mould_findings(judged: Trace, laid: Pieces, mould: Mould) -> Iterator[Finding]:
    """Strokes that begin outside the piece; one that runs out of it runs across the wall, which the wall's rule tells."""
    inked = np.flatnonzero(laid.radius > 0)
    first = inked[np.flatnonzero(np.diff(laid.stroke[inked], prepend=-1))]
    starts = laid.ends[first, 0]
    outside = Locator(mould.piece.UV, mould.piece.F).faces(starts - np.asarray(mould.offset)) < 0
    low, high = (mould.piece.UV.min(axis=0) + mould.offset), (mould.piece.UV.max(axis=0) + mould.offset)
    for k, (x, y) in zip(laid.move[first[outside]], starts[outside], strict=True):
        move = judged.moves[k]
        yield Finding(
            move.line,
            f"at X{x:.2f} Y{y:.2f} it lays ink outside piece {mould.piece.id}, whose mould holds X{low[0]:.1f} to X{high[0]:.1f} and "
            f"Y{low[1]:.1f} to Y{high[1]:.1f}",
            "move the pattern onto the piece, or give the file's own piece",
            move.pattern,
        )
