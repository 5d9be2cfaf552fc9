"""What every command that measures does around it: a folder that is whole or not there, progress, and the sentences at the end."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli import steps

if TYPE_CHECKING:
    from skinfab.progress import Progress


def measured(
    args: argparse.Namespace, measure: Callable[[Path, Progress], dict[str, Any]], *, several: bool = False, **facts: object
) -> int:
    """Measure, write, and say what came out.

    Parameters
    ----------
    args : Namespace
        With `output` and `json`.
    measure : function of (folder, progress)
        Writes its files into the folder, and gives "sentence", "notes" and what else it knows.
    several : bool
        It gives as much by the name of each thing that it measured.
    **facts
        Of the JSON object beside that.
    """
    from skinfab.progress import terminal_progress
    from skinfab.staging import staged_folder

    with staged_folder(args.output) as folder:
        with terminal_progress(quiet=args.json) as progress:
            found = measure(folder, progress)
        files = [str(args.output / file.name) for file in sorted(folder.iterdir())]
    if args.json:
        print(json.dumps({**facts, "files": files, **found}, allow_nan=False))
        return 0
    for result in found.values() if several else (found,):
        print(result["sentence"])
        steps.say(result["notes"])
    print("wrote " + ", ".join(files))
    return 0
