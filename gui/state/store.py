"""What the window remembers from one run to the next: recent files, theme, size. In the user's own state folder."""

from __future__ import annotations

import json
import os
import re
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from skinfab.files import atomic_write

#: Recent files that are kept.
MOST_RECENT = 10


def state_folder() -> Path:
    """Where the window keeps its own files; ``SKINFAB_STATE`` names another place. Made if missing, for the user alone."""
    named = os.environ.get("SKINFAB_STATE")
    base = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    folder = Path(named) if named else Path(base) / "skinfab"
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    return folder


@dataclass(frozen=True)
class Remembered:
    """What is remembered.

    Parameters
    ----------
    theme : "light" or "dark"
    geometry : str
        Of the window, as Tk writes it; "" for the default.
    recent : tuple of str
        Absolute paths, the newest first.

    Examples
    --------
    >>> Remembered(recent=("/a.obj", "/b.skin")).with_recent("/b.skin").recent
    ('/b.skin', '/a.obj')
    """

    theme: str = "light"
    geometry: str = ""
    recent: tuple[str, ...] = field(default=())

    def with_recent(self, path: str | Path) -> Remembered:
        """The same with `path` as the newest file."""
        newest = str(Path(path).absolute())
        return replace(self, recent=(newest, *(p for p in self.recent if p != newest))[:MOST_RECENT])


def on_screen(geometry: str, width: int, height: int) -> str:
    """A window's geometry as far as it suits a screen of that many pixels: without a place that is not on it, "" for none at all.

    Examples
    --------
    >>> on_screen("1280x760+40+10", 1920, 1080), on_screen("1280x760+2500+10", 1920, 1080), on_screen("large", 1920, 1080)
    ('1280x760+40+10', '1280x760', '')
    """
    found = re.fullmatch(r"(\d{1,5}x\d{1,5})\+(-?\d{1,5})\+(-?\d{1,5})", geometry)
    if found is None:
        return ""
    size, x, y = found[1], int(found[2]), int(found[3])
    # Its title bar can be taken hold of.
    return geometry if -50 <= x <= width - 100 and -50 <= y <= height - 50 else size


def recall(folder: Path) -> Remembered:
    """What was remembered in `folder`; the defaults where that is missing or damaged, as it is only a convenience."""
    try:
        data: Any = json.loads((folder / "gui.json").read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return Remembered()
    if not isinstance(data, dict):
        return Remembered()
    theme, geometry, recent = data.get("theme"), data.get("geometry"), data.get("recent")
    return Remembered(
        theme=theme if theme in ("light", "dark") else Remembered.theme,
        geometry=geometry if isinstance(geometry, str) else "",
        recent=tuple(p for p in recent if isinstance(p, str))[:MOST_RECENT] if isinstance(recent, list) else (),
    )


def remember(folder: Path, what: Remembered) -> None:
    """Write it, whole or not at all.

    Raises
    ------
    InputError
        The folder cannot be written.
    """
    atomic_write(folder / "gui.json", json.dumps(asdict(what), indent=1) + "\n")
