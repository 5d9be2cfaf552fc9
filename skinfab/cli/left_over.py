"""Files of an earlier run that lie beside those just written: left alone, but told, so that nobody prints a stale piece."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from skinfab.cli import steps

#: So many are named.
_NAMED = 6


def left_over(folder: Path, written: Collection[Path], suffix: str) -> list[Path]:
    """The files of `folder` of that kind which this run has not written, by name; with G-code also their pictures.

    Parameters
    ----------
    folder : path
    written : collection of path
        By this run, inside `folder`.
    suffix : str
        Such as ".gcode".
    """
    present = {path for path in folder.iterdir() if path.is_file()}
    alike = {path for path in present if path.suffix.lower() == suffix}
    # A tool path's picture has the name of its file: any other picture is none of ours.
    pictures = {path for path in present if path.suffix.lower() == ".svg" and path.stem in {p.stem for p in alike}}
    return sorted((alike | pictures) - set(written), key=lambda path: (len(path.name), path.name))


def say_left_over(folder: Path, others: Collection[Path]) -> None:
    """Name them on standard error."""
    if not others:
        return
    names = [path.name for path in others]
    listed = ", ".join(names[:_NAMED]) + (f" and {len(names) - _NAMED} more" if len(names) > _NAMED else "")
    was = "is not of this run and was" if len(names) == 1 else "are not of this run and were"
    steps.say([f"{folder} also holds {listed}, which {was} left alone: take care not to print the wrong one"], kind="warning")
