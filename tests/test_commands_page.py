"""docs/commands.md: every command, in the order of the help, with lines that its parser knows and a picture that is there."""

import re
from collections.abc import Callable
from functools import cache
from itertools import takewhile
from pathlib import Path

import pytest

from skinfab.cli.main import COMMANDS, main

PAGE = Path(__file__).parents[1] / "docs/commands.md"


def sections(page: str) -> dict[str, str]:
    return {part.partition("\n")[0]: part for part in re.split(r"^## ", page, flags=re.MULTILINE)[1:]}


def examples(section: str) -> list[str]:
    return [line for box in re.findall(r"^```\n(.*?)^```", section, re.DOTALL | re.MULTILINE) for line in box.splitlines()]


@pytest.fixture
def help_of(capsys: pytest.CaptureFixture[str]) -> Callable[[tuple[str, ...]], str]:
    @cache
    def asked(words: tuple[str, ...]) -> str:
        capsys.readouterr()
        return capsys.readouterr().out if main([*words, "--help"]) == 0 else ""

    return asked


def faults(page: str, help_of: Callable[[tuple[str, ...]], str]) -> list[str]:
    """Commands without a section, lines of another command or with words and options that theirs has not, pictures that are gone."""
    found = [f"{name} has no section" for name in COMMANDS if name not in sections(page)]
    for name, section in sections(page).items():
        lines = examples(section)
        found += [f"{name} has no example"] * (not lines)
        for line in lines:
            program, *words = line.split()
            verbs = tuple(takewhile(str.isalpha, (word if word.islower() else "-" for word in words)))
            said = help_of(verbs) if program == "skinfab" and words[0] == name else ""
            found += [line] * (not said)
            found += [
                f"{line}: {word}" for word in words if said and re.match(r"--?[a-z]", word) and word not in re.split(r"[\s,\[\]|{}]+", said)
            ]
        found += [picture for picture in re.findall(r"!\[.*?\]\((.*?)\)", section) if not (PAGE.parent / picture).is_file()]
        found += [f"{name} has no picture"] * ("![" not in section and "is its picture" not in section)
    return found


def test_every_command_is_shown(help_of: Callable[[tuple[str, ...]], str]) -> None:
    page = PAGE.read_text()
    assert faults(page, help_of) == []
    assert list(sections(page)) == list(COMMANDS)


def test_what_is_wrong_is_found(help_of: Callable[[tuple[str, ...]], str]) -> None:
    page = PAGE.read_text().replace("## mould\n", "## mold\n").replace("--false-alarms", "--alarms")
    page = page.replace("skinfab nail train", "skinfab nail learn").replace("pictures/strips.svg", "pictures/strip.svg")
    found = faults(page, help_of)
    assert found[0] == "mould has no section" and "skinfab mould SKIN -o DIR" in found and "pictures/strip.svg" in found
    assert "skinfab contact LOG -o DIR --alarms 0.1: --alarms" in found
    assert "skinfab nail learn DIR/labels.csv --participant 1 -o MODEL.npz" in found and len(found) == 5
