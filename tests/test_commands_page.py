"""docs/commands.md has every command and a picture of it, and all command lines of all pages are in words and options that there are."""

import re
from collections.abc import Callable
from functools import cache
from itertools import takewhile
from pathlib import Path

import pytest

from skinfab.cli.main import COMMANDS, main

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs/commands.md"
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]

HelpOf = Callable[[tuple[str, ...]], str]


@pytest.fixture
def help_of(capsys: pytest.CaptureFixture[str]) -> HelpOf:
    @cache
    def asked(words: tuple[str, ...]) -> str:
        capsys.readouterr()
        status = main([*words, "--help"])
        return capsys.readouterr().out if status == 0 else ""

    return asked


def sections(page: str) -> dict[str, str]:
    return {part.partition("\n")[0]: part for part in re.split(r"^## ", page, flags=re.MULTILINE)[1:]}


def lines_of(page: str) -> list[str]:
    """What follows `skinfab` in a page's boxes, without what a line remarks behind it."""
    boxes = "".join(re.findall(r"^```(?:sh)?\n(.*?)^```", page, re.DOTALL | re.MULTILINE)).replace("\\\n", " ")
    return re.findall(r"^(?:\.venv/bin/)?skinfab (\S+(?: ?\S+)*)", re.sub(r"(\S) +(--?[a-z])", r"\1 \2", boxes), re.MULTILINE)


def unknown(line: str, help_of: HelpOf) -> list[str]:
    """Options of a command line that its command's help does not tell; the line itself where there is no such command."""
    words = line.partition(" #")[0].split()
    if words[0] not in COMMANDS:
        return [line]
    verbs = tuple(takewhile(str.isalpha, (word if word.islower() else "-" for word in words)))
    said = help_of(verbs)
    known = set(re.split(r"[\s,\[\]|{}]+", said))
    return [f"{line}: {word}" for word in words if re.match(r"--?[a-z]", word) and word not in known] if said else [line]


def lacking(page: str) -> list[str]:
    """Commands without a section, sections without a line of their command or a picture, pictures that are gone."""
    found = [f"{name} has no section" for name in COMMANDS if name not in sections(page)]
    for name, section in sections(page).items():
        lines = lines_of(section)
        found += [f"{name} has no line of its own"] * (not lines or any(line.split()[0] != name for line in lines))
        found += [picture for picture in re.findall(r"!\[.*?\]\((.*?)\)", section) if not (PAGE.parent / picture).is_file()]
        found += [f"{name} has no picture"] * ("![" not in section and "is its picture" not in section)
    return found


def test_every_command_is_shown() -> None:
    assert lacking(PAGE.read_text()) == [] and list(sections(PAGE.read_text())) == list(COMMANDS)


def test_every_line_of_every_page_is_known(help_of: HelpOf) -> None:
    lines = {line: page.name for page in PAGES for line in lines_of(page.read_text())}
    assert len(lines) > 100
    assert [(page, fault) for line, page in lines.items() for fault in unknown(line, help_of)] == []


def test_what_is_wrong_is_found(help_of: HelpOf) -> None:
    page = PAGE.read_text().replace("## mould\n", "## mold\n").replace("pictures/strips.svg", "pictures/strip.svg")
    assert lacking(page) == ["mould has no section", "mold has no line of its own", "pictures/strip.svg"]
    lines = (
        "skinfab contact LOG -o DIR \\",
        "  --alarms 0.1  # so many",
        "skinfab nail learn A -o B",
        "skinfab sew",
        ".venv/bin/skinfab gui A    or B",
    )
    box = "\n".join(["```", *lines, "```", ""])
    assert lines_of(box)[3] == "gui A"
    assert [fault for line in lines_of(box) for fault in unknown(line, help_of)] == [
        f"{lines_of(box)[0]}: --alarms",
        "nail learn A -o B",
        "sew",
    ]
