"""A result of `skinfab force`: files that appear together or not at all, and JSON or words."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from skinfab.cli import steps


@contextmanager
def result_folder(args: argparse.Namespace, result: Mapping[str, Any]) -> Iterator[Path]:
    """The folder of ``--output``, which appears whole at the end, with the result as result.json beside what is written into it."""
    from skinfab.staging import staged_folder

    with staged_folder(args.output) as folder:
        yield folder
        (folder / "result.json").write_text(json.dumps(result, indent=1, allow_nan=False) + "\n")


def told_as_json(args: argparse.Namespace, result: Mapping[str, Any]) -> bool:
    """Whether the result was printed as JSON; else its notes were said, and words are to follow."""
    if args.json:
        print(json.dumps(result, allow_nan=False))
        return True
    steps.say(result["notes"])
    return False
