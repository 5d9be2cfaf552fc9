"""One line about what the pointer is on."""

from __future__ import annotations

from gui.state.derived import Derived
from gui.state.session import Session
from skinfab.skin import Skin


def describe(session: Session, derived: Derived) -> str:
    """For the status bar.

    Examples
    --------
    >>> describe(Session(), Derived())
    'Open a mesh or a skin to begin (Ctrl+O).'
    """
    skin, at = session.skin, session.hovered
    if skin is None:
        return "Open a mesh or a skin to begin (Ctrl+O)."
    if not at:
        return f"{skin.source.file}: {_whole(skin)}"
    parts = []
    if at.sensor:
        sensor = next((s for s in skin.sensors if s.id == at.sensor), None)
        if sensor is not None:
            parts.append(f"{sensor.id}: {sensor.pattern.kind}, {sensor.path.length:.1f} mm, channel {sensor.channel}")
    if at.seam >= 0:
        locked = skin.marks is not None and _has(skin.marks.locked, skin.mesh.topology.E[at.seam])
        parts.append("locked seam" if locked else "seam")
    if at.piece:
        piece = skin.piece(at.piece)
        d = derived.distortion(skin.mesh, piece)
        parts.append(f"piece {at.piece}, {piece.size[0]:.0f} x {piece.size[1]:.0f} mm, d mean {d.mean:.3f}")
    if at.face >= 0:
        parts.append(f"face {at.face}" + ("" if at.piece else ", not flat yet"))
    return "   ".join(parts)


def _whole(skin: Skin) -> str:
    if skin.pieces:
        return f"{_counted(len(skin.pieces), 'piece')}, {_counted(len(skin.sensors), 'sensor')}"
    if len(skin.seams):
        return "cut, but nothing lies flat yet: cut further by clicks (C) or automatically (F5)"
    return "no seams yet: cut by clicks (C) or automatically (F5)"


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


def _has(pairs: object, pair: object) -> bool:
    import numpy as np

    return bool((np.sort(np.asarray(pairs).reshape(-1, 2), axis=1) == np.sort(np.asarray(pair))).all(axis=1).any())
