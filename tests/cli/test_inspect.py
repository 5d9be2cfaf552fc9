"""`skinfab inspect`: the table, the JSON object, and exit status 1 for a mesh that cannot be used."""

import json
import runpy
from pathlib import Path

import pytest

from skinfab.cli.main import main

ROOT = Path(__file__).parents[2]
SHAPES = runpy.run_path(str(ROOT / "tests" / "stability" / "broken_meshes.py"))


def test_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(ROOT / "meshes" / "cup.obj"), "--json"]) == 0
    out, err = capsys.readouterr()
    report = json.loads(out)
    assert err == "" and len(out.splitlines()) == 1
    assert report["genus"] == [1] and report["closed"] and report["usable"] and report["units"] == "mm"
    assert report["faults"] == report["cleaning_does"] == report["repair_would_do"] == []


def test_units_and_scale(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(ROOT / "meshes" / "cube.obj"), "--json", "--units", "cm", "--scale", "0.5"]) == 0
    assert json.loads(capsys.readouterr().out)["size_mm"] == [200, 200, 200]


def test_table_names_what_was_found_and_what_repair_does(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    V, F = SHAPES["grid"]()
    (tmp_path / "fin.obj").write_bytes(SHAPES["obj"]([*V, [25, 25, 40]], [*F, [60, 61, len(V)]]))
    assert main(["inspect", str(tmp_path / "fin.obj")]) == 1
    out, err = capsys.readouterr()
    assert "Found: non-manifold edge, first at edge 60-61; --repair:" in out
    assert "With --repair: cut back to two faces at each non-manifold edge: 1 face removed" in out
    assert len(err.splitlines()) == 1 and "run again with --repair" in err


def test_pieces_to_expect(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    finger = str(ROOT / "meshes" / "human_finger.obj")
    assert main(["inspect", finger, "--json"]) == 0
    expected = json.loads(capsys.readouterr().out)["expected"]
    assert expected["pieces"] == expected["components"] == 1 and expected["compact"] == 2
    assert expected["curvature_sr"] == pytest.approx(6.28, rel=0.1)  # half a ball at the tip
    assert main(["inspect", finger]) == 0
    assert "Expect: at least 1 piece without darts at a mean d of 4.05, about 2 where they are compact" in capsys.readouterr().out
    (tmp_path / "torn.off").write_text("OFF\n5 3 0\n0 0 0\n30 0 0\n0 30 0\n0 0 30\n0 -30 0\n3 0 1 2\n3 0 1 3\n3 0 1 4\n")
    assert main(["inspect", str(tmp_path / "torn.off"), "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["expected"] is None
