"""The Python in the docs runs as it stands there, from the project's root."""

import re
import textwrap
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [
    ROOT / "docs" / name
    for name in (
        "cuts.md",
        "flattening.md",
        "calibration.md",
        "control.md",
        "contact.md",
        "logs.md",
        "readout.md",
        "nail.md",
        "array.md",
        "optical.md",
        "force.md",
        "batch.md",
    )
]  # patterns.md has its own test


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_example_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "meshes").symlink_to(ROOT / "meshes")
    (tmp_path / "finger.obj").symlink_to(ROOT / "meshes/human_finger.obj")  # "a mesh of yours"
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^ *```python\n(.*?)^ *```", page.read_text(), re.DOTALL | re.MULTILINE)
    exec(compile("\n".join(map(textwrap.dedent, blocks)), str(page), "exec"), {})  # one page, one session
    if page.name == "flattening.md":
        assert capsys.readouterr().out.count("0 flipped") == 2
