"""docs/first-skin.md, followed by the letter: its commands succeed, say what is shown, and write the files that it names."""

import re
from pathlib import Path

import pytest

from skinfab.cli.main import main

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs/first-skin.md"
#: What the fixture does for all who look at it.
MADE = "skinfab make meshes/robot_finger.obj -o first"


def words(line: str) -> str:
    """A line without its numbers and the width of its columns: results may change a little, what is said may not."""
    return re.sub(r"\s+", " ", re.sub(r"[-+]?\d[\d,.]*", "N", line)).strip()


def boxes(page: str) -> list[tuple[list[str], list[str]]]:
    """The commands of each box, and the lines that are shown below it."""
    found = re.findall(r"^```sh\n(.*?)^```\n(?:\n```text\n(.*?)^```\n)?", page, re.DOTALL | re.MULTILINE)
    return [(commands.splitlines(), shown.splitlines()) for commands, shown in found]


def test_followed_by_the_letter(
    first_skin: tuple[Path, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for path in (ROOT / "meshes", ROOT / "calibration", first_skin[0]):
        (tmp_path / path.name).symlink_to(path)
    monkeypatch.chdir(tmp_path)
    page = PAGE.read_text()
    assert page.count("```text") == sum(bool(shown) for _, shown in boxes(page)) and len(boxes(page)) >= 8
    for commands, shown in boxes(page):
        said = ""
        for command in commands:
            assert command.startswith("skinfab ")
            if command == MADE:
                said += first_skin[1]
            else:
                assert main(command.split()[1:]) == 0, command
                said += "".join(capsys.readouterr())
        lines = "\n".join(map(words, said.splitlines()))
        assert [line for line in shown if words(line) not in lines] == []
    outputs = re.findall(r"^skinfab .* -o (\S+)", page, re.MULTILINE)
    assert "first" in outputs
    for path in re.findall(rf"[`(]((?:{'|'.join(map(re.escape, outputs))})[\w./]*)[`)]", page):
        assert (tmp_path / path).exists(), path


def test_words_are_compared_and_numbers_are_not() -> None:
    assert words("made in 2.4 s,  -3 of 1,000") == "made in N s, N of N" != words("made in 2.4 min, -3 of 1,000")
    assert boxes("```sh\na\nb\n```\n\n```text\nc\n```\n```sh\nd\n```\n") == [(["a", "b"], ["c"]), (["d"], [])]


def test_what_the_page_makes_is_no_change_of_the_repository() -> None:
    made = {Path(name) for commands, _ in boxes(PAGE.read_text()) for name in re.findall(r" -o (\S+)", "\n".join(commands))}
    ignored = {Path(line.strip("/")) for line in (ROOT / ".gitignore").read_text().splitlines() if line.startswith("/")}
    assert len(made) >= 7 and made <= ignored
