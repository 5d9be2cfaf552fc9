"""The command as a user runs it, on a document of two plates."""

from __future__ import annotations

import argparse
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from skinfab.cli.mould import add_parser
from skinfab.document import save_skin
from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source


def plate(id: str, first: int, w: float, h: float) -> Piece:
    UV = np.array([[0, 0], [w, 0], [w, h], [0, h]], dtype=float)
    return Piece(id, np.arange(2) + first // 2, np.arange(4) + first, np.array([[0, 1, 2], [0, 2, 3]]), UV)


@pytest.fixture
def skin() -> Skin:
    pieces = (plate("P1", 0, 80, 40), plate("P2", 4, 30, 20))
    V = np.vstack([np.c_[p.UV + 100 * k, np.zeros(4)] for k, p in enumerate(pieces)])
    mesh = Mesh(V, np.vstack([p.F + 4 * k for k, p in enumerate(pieces)]), "plates")
    sensor = Sensor("S1", "P1", StrainLines(l1=60, l2=50, b=6), x=8, y=15, angle=0.0, channel=0)
    return Skin(mesh, Source("plates.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), np.int64), pieces, (sensor,))


def call(*argv: str) -> int:
    parser = argparse.ArgumentParser()
    add_parser(parser.add_subparsers(required=True))
    args = parser.parse_args(["mould", *argv])
    return int(args.run(args))


def test_one_stl_a_piece_and_the_recipe(skin: Skin, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    save_skin(skin, tmp_path / "a.skin")
    assert call(str(tmp_path / "a.skin"), "-o", str(tmp_path / "out" / "moulds")) == 0
    out = capsys.readouterr().out
    assert sorted(p.name for p in (tmp_path / "out" / "moulds").iterdir()) == ["P1.stl", "P2.stl"]
    assert trimesh.load_mesh(tmp_path / "out" / "moulds" / "P1.stl").is_watertight
    assert "holds 8.00 ml" in out and "holds 1.50 ml" in out  # 3200 and 600 mm^2, 2.5 mm deep
    assert "Pour 6.85 g" in out  # 6.4 ml of reservoir at 1.07 g/ml
    assert "P2 has no sensors and is only cast" in out and "S1-1 by (0.0, " in out and "10. Wrap" in out

    from skinfab.material import load_material
    from skinfab.mould import casting_mould

    plain = casting_mould(skin.pieces[0], material=load_material())
    slotted = trimesh.load_mesh(tmp_path / "out" / "moulds" / "P1.stl")
    # Two slots of 1.2 mm, 0.5 mm deep, through a wall of 1.6 mm that leans out by 2 degrees about half of 2.5 mm.
    assert float(plain_volume(plain.V, plain.F) - slotted.volume) == pytest.approx(
        2 * 1.2 * (1.6 - 1.5 * math.tan(math.radians(2))) * 0.5, rel=0.001
    )


def plain_volume(V: np.ndarray, F: np.ndarray) -> float:
    return float(trimesh.Trimesh(V, F, process=False).volume)


def test_nothing_to_cast(skin: Skin, tmp_path: Path) -> None:
    save_skin(replace(skin, pieces=(), sensors=()), tmp_path / "a.skin")
    with pytest.raises(InputError, match="no flat pieces to cast"):
        call(str(tmp_path / "a.skin"), "-o", str(tmp_path / "out"))
    assert not (tmp_path / "out").exists()


def test_output_that_is_a_file(skin: Skin, tmp_path: Path) -> None:
    save_skin(skin, tmp_path / "a.skin")
    (tmp_path / "out").write_text("")
    with pytest.raises(InputError, match="cannot write"):
        call(str(tmp_path / "a.skin"), "-o", str(tmp_path / "out"))


def test_a_mould_of_another_run_is_named_and_left_alone(skin: Skin, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    save_skin(skin, tmp_path / "a.skin")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "P7.stl").write_text("old")
    assert call(str(tmp_path / "a.skin"), "-o", str(tmp_path / "out")) == 0
    assert "also holds P7.stl, which is not of this run and was left alone" in capsys.readouterr().err
    assert (tmp_path / "out" / "P7.stl").read_text() == "old"
