"""`skinfab segment`: automatic seams and seams by hand."""

import json
from pathlib import Path

import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.document import load_skin

ROOT = Path(__file__).parents[2]
CUBE = str(ROOT / "meshes/cube.obj")


def cube_net() -> str:
    """A cross: seven edges of the cube, as a path along its vertices and two branches."""
    V = np.array([[float(x) for x in line.split()[1:]] for line in Path(CUBE).read_text().splitlines() if line.startswith("v ")])
    corner = {tuple((v > V.mean(axis=0)).astype(int)): k for k, v in enumerate(V)}
    paths = [
        [(0, 0, 1), (0, 1, 1), (1, 1, 1), (1, 0, 1)],
        [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
        [(0, 0, 0), (0, 0, 1)],
    ]
    return "# the cross\n" + "\n".join(" ".join(str(corner[c]) for c in path) for path in paths)


def test_automatic(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["segment", CUBE, "-o", str(tmp_path / "cube.skin"), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    skin = load_skin(tmp_path / "cube.skin")
    assert len(skin.pieces) == len(said["pieces"]) == 1
    assert said["seam_mm"] == pytest.approx(7 * 40)
    assert said["pieces"][0]["distortion"]["mean"] == pytest.approx(4)


def test_by_hand_is_honoured_exactly(tmp_path: Path) -> None:
    (tmp_path / "cuts.txt").write_text(cube_net())
    assert main(["segment", CUBE, "-o", str(tmp_path / "cube.skin"), "--cuts", str(tmp_path / "cuts.txt")]) == 0
    skin = load_skin(tmp_path / "cube.skin")
    given = {tuple(sorted(pair)) for line in cube_net().splitlines()[1:] for pair in zip(line.split(), line.split()[1:], strict=False)}
    assert {tuple(sorted(map(str, edge))) for edge in skin.seams.tolist()} == given
    (piece,) = skin.pieces
    assert sorted(np.round(piece.size).tolist()) == [120, 160]


def test_too_few_cuts_are_explained_or_completed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "cuts.txt").write_text(cube_net().splitlines()[1])  # three sides of one face: open, but far from flat
    target = tmp_path / "cube.skin"
    words = ["segment", CUBE, "-o", str(target), "--cuts", str(tmp_path / "cuts.txt")]
    assert main(words) == 3
    assert "over the bound 4.05" in capsys.readouterr().err
    assert not target.exists()
    assert main([*words, "--complete"]) == 0
    assert "were cut beyond those given by hand" in capsys.readouterr().err
    a, b = sorted(map(int, cube_net().splitlines()[1].split()[:2]))
    assert [a, b] in load_skin(target).seams.tolist()


@pytest.mark.parametrize(
    ("text", "status", "says"),
    [
        ("1 2 x\n", 1, "line 1: '1 2 x' is not a list of vertex numbers"),
        ("# nothing\n", 1, "holds no vertex path"),
        ("0 1\n5\n", 1, "line 2: a path needs at least two vertices"),
        ("0 8\n", 1, "vertex 8 does not exist; the mesh has vertices 0 to 7"),
        ("0 -1\n", 1, "vertex -1 does not exist"),
        ("\x00\x01", 1, "not a list of vertex numbers"),
        ("0 0\n", 1, "closed; cut it open"),
    ],
)
def test_wrong_cuts(text: str, status: int, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "cuts.txt").write_text(text)
    assert main(["segment", CUBE, "-o", str(tmp_path / "o.skin"), "--cuts", str(tmp_path / "cuts.txt")]) == status
    error = capsys.readouterr().err
    assert says in error and len(error.splitlines()) == 1


def test_complete_needs_cuts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["segment", CUBE, "-o", str(tmp_path / "o.skin"), "--complete"]) == 2
    assert "--cuts" in capsys.readouterr().err
