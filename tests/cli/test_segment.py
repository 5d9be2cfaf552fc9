"""`skinfab segment`: automatic seams and seams by hand."""

import contextlib
import json
import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gcode.export import export_report
from skinfab.cli.main import main
from skinfab.document import load_skin, save_skin
from skinfab.seams.edit import forbid, lock
from skinfab.skin import SeamMarks

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


def test_fewest_pieces(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Of the mesh, and of the document of it."""
    target = str(tmp_path / "fewest.skin")
    found = []
    for source in (CUBE, target):
        assert main(["segment", source, "-o", target, "--pieces", "fewest", "--max-distortion", "4.2", "--json"]) == 0
        found.append(json.loads(capsys.readouterr().out))
    assert len(found[0]["pieces"]) == 1 and found[0]["pieces"][0]["distortion"]["mean"] <= 4.2
    assert found[1]["seam_mm"] == pytest.approx(found[0]["seam_mm"])


def test_bounds_by_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "a.skin"
    for name, bound in (("standard", 4.05), ("short", 4.1), ("shortest", 4.2)):
        assert main(["segment", CUBE, "-o", str(target), "--max-distortion", name]) == 0
        assert load_skin(target).max_distortion == bound
    capsys.readouterr()
    assert main(["segment", CUBE, "-o", str(target), "--max-distortion", "shorter"]) == 2
    assert "'shorter' is neither a number above 4 nor one of standard, short, shortest" in capsys.readouterr().err


def test_hot_spots_are_bounded_on_request(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = str(tmp_path / "a.skin")
    p99 = []
    for more in ([], ["--max-p99", "4.05"]):
        assert main(["segment", CUBE, "-o", target, "--pieces", "fewest", "--max-distortion", "4.2", "--json", *more]) == 0
        p99.append(max(piece["distortion"]["p99"] for piece in json.loads(capsys.readouterr().out)["pieces"]))
    assert p99[0] > 4.05 >= p99[1]


def test_fewest_pieces_are_not_cut_by_hand(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["segment", CUBE, "-o", str(tmp_path / "cube.skin"), "--cuts", str(tmp_path / "cuts.txt"), "--pieces", "fewest"]) == 2
    assert "--pieces is for automatic seams" in capsys.readouterr().err


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
        ("0 0\n", 1, "all its points are vertex 0, so it has no length"),
        ("0 1\n", 1, "closed (a cut of one edge alone, 0-1, opens nothing); cut it open, such as along"),
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


def marked_cube(path: Path) -> set[tuple[int, int]]:
    """A document of the cube with two of its edges locked and one forbidden; the locked ones."""
    assert main(["segment", CUBE, "-o", str(path)]) == 0
    skin = load_skin(path)
    topology = skin.mesh.topology
    sharp = np.flatnonzero(np.linalg.norm(np.diff(skin.mesh.V[topology.E], axis=1)[:, 0], axis=1) < 41)
    seams = set(map(tuple, skin.seams.tolist()))
    free = [k for k in sharp if tuple(topology.E[k].tolist()) not in seams]
    taken = topology.edge_ids(skin.seams)[:1]
    save_skin(forbid(lock(skin, free[:2]), taken), path)
    return set(map(tuple, topology.E[free[:2]].tolist()))


def test_a_document_is_cut_anew_by_its_marks(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    locked = marked_cube(tmp_path / "a.skin")
    assert main(["segment", str(tmp_path / "a.skin"), "-o", str(tmp_path / "b.skin")]) == 0
    assert "1 piece, 280 mm of seam" in capsys.readouterr().out
    before, after = load_skin(tmp_path / "a.skin"), load_skin(tmp_path / "b.skin")
    assert before.marks is not None and after.marks is not None
    seams = set(map(tuple, after.seams.tolist()))
    assert locked <= seams and len(seams) == 7
    assert not seams & set(map(tuple, before.marks.forbidden.tolist()))
    np.testing.assert_array_equal(after.marks.locked, before.marks.locked)


def test_a_document_without_marks_is_cut_as_its_mesh(tmp_path: Path) -> None:
    mesh = str(ROOT / "meshes/human_finger.obj")
    assert main(["segment", mesh, "-o", str(tmp_path / "a.skin"), "--max-distortion", "4.08", "--seed", "3"]) == 0
    assert main(["segment", str(tmp_path / "a.skin"), "-o", str(tmp_path / "b.skin")]) == 0
    assert (tmp_path / "a.skin").read_bytes() == (tmp_path / "b.skin").read_bytes()
    assert load_skin(tmp_path / "b.skin").max_distortion == 4.08
    assert main(["segment", str(tmp_path / "a.skin"), "-o", str(tmp_path / "c.skin"), "--max-distortion", "4.2"]) == 0
    assert load_skin(tmp_path / "c.skin").max_distortion == 4.2


def test_sensors_of_a_document_follow(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    document = tmp_path / "a.skin"
    assert main(["segment", CUBE, "-o", str(document)]) == 0
    assert main(["place", str(document)]) == 0
    ids = [s.id for s in load_skin(document).sensors]
    assert main(["segment", str(document), "-o", str(tmp_path / "b.skin")]) == 0
    assert ids and [s.id for s in load_skin(tmp_path / "b.skin").sensors] == ids
    assert "taken off" not in capsys.readouterr().err


@pytest.mark.parametrize("words", [["--cuts", "x"], ["--units", "mm"], ["--wrap", "8"], ["--thickness", "2"]])
def test_what_goes_with_a_mesh_only(words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["segment", CUBE, "-o", str(tmp_path / "a.skin")]) == 0
    assert main(["segment", str(tmp_path / "a.skin"), "-o", str(tmp_path / "b.skin"), *words]) == 2
    assert "go with a mesh" in capsys.readouterr().err and not (tmp_path / "b.skin").exists()


def test_marks_that_forbid_everything_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["segment", CUBE, "-o", str(tmp_path / "a.skin")]) == 0
    skin = load_skin(tmp_path / "a.skin")
    save_skin(forbid(skin, np.arange(len(skin.mesh.topology.E))), tmp_path / "a.skin")
    assert main(["segment", str(tmp_path / "a.skin"), "-o", str(tmp_path / "b.skin")]) == 3
    assert "the forbidden edges leave no seam" in capsys.readouterr().err and not (tmp_path / "b.skin").exists()


def test_marks_that_contradict_each_other_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """No edit makes such a document, but a script of one's own may."""
    assert main(["segment", CUBE, "-o", str(tmp_path / "a.skin")]) == 0
    skin = load_skin(tmp_path / "a.skin")
    save_skin(
        replace(skin, marks=SeamMarks(skin.seams[:1], skin.seams[:1], np.zeros(len(skin.mesh.F), dtype=np.int8))), tmp_path / "a.skin"
    )
    assert main(["segment", str(tmp_path / "a.skin"), "-o", str(tmp_path / "b.skin")]) == 1
    a, b = sorted(skin.seams[0].tolist())
    assert f"{a}-{b}: locked" in capsys.readouterr().err and not (tmp_path / "b.skin").exists()


def test_pieces_too_small_to_handle_behind_locks_are_told_wherever_they_are_made(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A corner of the cube, 2 mm across each face, that locked seams part from the rest."""
    document, out = tmp_path / "a.skin", tmp_path / "out"
    V = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2], [30, 0, 0], [0, 30, 0], [0, 0, 30.0]])
    faces = [(0, 1, 2), (0, 2, 3), (0, 3, 1), (1, 4, 5), (1, 5, 2), (2, 5, 6), (2, 6, 3), (3, 6, 4), (3, 4, 1)]
    lines = [f"v {x} {y} {z}" for x, y, z in V] + [f"f {c + 1} {b + 1} {a + 1}" for a, b, c in faces]
    (tmp_path / "corner.obj").write_text("\n".join(lines) + "\n")
    assert main(["segment", str(tmp_path / "corner.obj"), "-o", str(document), "--units", "mm"]) == 0
    skin = load_skin(document)
    ring = skin.mesh.topology.edge_ids(np.array([[1, 2], [2, 3], [1, 3]]))
    save_skin(lock(skin, ring), document)
    capsys.readouterr()
    assert main(["segment", str(document), "-o", str(document), "--json"]) == 0
    said = capsys.readouterr()
    (told,) = json.loads(said.out)["warnings"]
    assert "narrower than the 4 mm" in told and told.endswith("unlock some of them") and f"warning: {told}" in said.err.splitlines()
    assert main(["make", str(document), "-o", str(out)]) == 0
    assert json.loads((out / "report.json").read_text())["warnings"].count(told) == 1
    assert capsys.readouterr().err.count(told) == 1
    assert export_report(skin=load_skin(document), path=tmp_path / "r.html").notes.count(told) == 1


def test_simplest_pieces(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["segment", CUBE, "-o", str(tmp_path / "cube.skin"), "--pieces", "simplest", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert len(said["pieces"]) == 2 and said["seam_mm"] == pytest.approx(8 * 40)


def test_a_piece_whose_halves_hang_on_a_thread_is_parted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Two flat squares of 20 mm with a bridge of 2 mm between them; the material asks for 4."""
    x, y = np.array([0, 20, 20, 20, 20, 30, 30, 30, 30, 50, 0, 50.0]), np.array([0, 0, 9, 11, 20, 0, 9, 11, 20, 0, 20, 20.0])
    faces = [(0, 1, 2), (0, 2, 3), (0, 3, 10), (10, 3, 4), (2, 6, 3), (3, 6, 7), (5, 9, 6), (6, 9, 11), (6, 11, 7), (7, 11, 8)]
    lines = [f"v {a} {b} 0" for a, b in zip(x, y, strict=True)] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    (tmp_path / "h.obj").write_text("\n".join(lines) + "\n")
    (tmp_path / "cuts.txt").write_text("0 1\n")  # along the border: nothing is cut
    words = ["segment", str(tmp_path / "h.obj"), "-o", str(tmp_path / "h.skin"), "--json"]
    assert main([*words, "--cuts", str(tmp_path / "cuts.txt")]) == 3
    assert "piece 1 (10 faces) has a neck 2.0 mm wide when laid flat, and 4 mm of silicone survive" in capsys.readouterr().err
    assert main(words) == 0
    said = json.loads(capsys.readouterr().out)
    assert len(said["pieces"]) == 2 and said["seam_mm"] == pytest.approx(2, abs=0.3)
    assert said["warnings"] == [] and said["notes"][-1].startswith("2 of the pieces are parted at a neck of 2 mm")


@pytest.mark.skipif(not hasattr(os, "openpty"), reason="no pseudo-terminals on this system")
def test_fewest_pieces_show_how_far_they_are_and_can_be_interrupted(tmp_path: Path) -> None:
    ours, theirs = os.openpty()
    target = tmp_path / "grip.skin"
    work = subprocess.Popen(
        [sys.executable, "-m", "skinfab", "segment", str(ROOT / "meshes" / "grip.obj"), "-o", str(target), "--pieces", "fewest"],
        stderr=theirs,
        env={**os.environ, "TERM": "xterm", "COLUMNS": "100"},
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    os.close(theirs)
    shown = b""
    while b"cutting and flattening" not in shown:
        shown += os.read(ours, 4096)
    work.send_signal(signal.SIGINT)
    with contextlib.suppress(OSError):  # Linux says EIO where the other side is closed
        while more := os.read(ours, 4096):
            shown += more
    os.close(ours)
    assert work.wait(timeout=60) == 130 and b"interrupted; nothing half-written was left" in shown
    assert list(tmp_path.iterdir()) == []
