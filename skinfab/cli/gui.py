"""`skinfab gui [MESH|SKIN]`: the placement window."""

from __future__ import annotations

import argparse
from pathlib import Path


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "gui",
        help="see the object, its flat skin and the sensors, and move them",
        description="A window with the object on the left and its flat skin on the right: cut, flatten, place sensors, check, export. "
        "Everything in it is done by the same functions as the commands, on the same skin document (see docs/gui.md).",
    )
    p.add_argument("file", metavar="MESH|SKIN", nargs="?", type=Path, help="what to open at once")
    p.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Open the window and wait until it is closed."""
    from skinfab.errors import InputError

    if args.file is not None and not args.file.is_file():
        raise InputError(f"{args.file}: {'is a folder; give a file in it' if args.file.is_dir() else 'no such file'}")
    try:
        import tkinter  # noqa: F401 - whether it is there
    except ImportError as fault:
        raise InputError("this Python has no tkinter; install it (Debian: apt install python3-tk) and run again") from fault
    from gui.app import run as open_window

    open_window(args.file)
    return 0
