"""The commands in docs/optical.md run as they stand there, one after the other, in a folder of their own."""

import contextlib
import io
import shlex
from pathlib import Path

import pytest

from skinfab.cli.main import build_parser, main

PAGE = Path(__file__).parents[2] / "docs/optical.md"
#: A tenth of the images, so that it takes no minutes; the benchmarks take longer still, so their words are only understood.
FEWER = ("--images 1000", "--images 100")


def commands() -> list[list[str]]:
    lines, inside, kept = PAGE.read_text().replace("\\\n", " ").splitlines(), False, []
    for line in lines:
        inside = inside != line.startswith("```")
        kept += [line] if inside and line.startswith("skinfab ") else []
    return [shlex.split(line.replace(*FEWER), comments=True)[1:] for line in kept]


def test_commands_run_as_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    ran = []
    for words in commands():
        build_parser(words).parse_args(words)
        if words[1] == "bench" or not all(map(there, words)):
            continue
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            assert main(words) == 0, words
        ran.append(words[1])
    assert ran == ["simulate", "train", "run"]
    assert (tmp_path / "felt/edges.csv").read_text().count("\n") == 101


def there(word: str) -> bool:
    """Public images are not here."""
    return not word.startswith("edge_2d/")
