"""Profiles by name, and what they ask of pieces and sensors."""

from pathlib import Path

import numpy as np
import pytest

from gcode.printer import load_printer
from gcode.used import limits_for, limits_of, load_used, used_by, with_room_for_nozzle
from skinfab.errors import InputError
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.skin import Skin, Source


def test_bundled_profiles_are_named_as_they_are() -> None:
    used = load_used()
    assert (used.printer_name, used.material_name) == ("ender5plus-vipro", "carbon-grease-ecoflex")
    assert used.printer == load_printer() and used.material == load_material()


def test_a_file_of_ones_own_is_named_by_its_whole_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "fat.toml").write_text('extends = "ender5plus-vipro"\n[nozzle]\nouter_radius = 2.0\n')
    monkeypatch.chdir(tmp_path)
    used = load_used("fat.toml")
    assert used.printer_name == str((tmp_path / "fat.toml").resolve()) and used.printer.nozzle.outer_radius == 2
    roomy, (note,) = with_room_for_nozzle(used.material, used.printer)
    assert roomy.margin > used.material.margin and f"kept {roomy.margin:.2f} mm from the pieces' edges" in note


def test_no_such_profile() -> None:
    with pytest.raises(InputError, match="nothing-like-it"):
        load_used("nothing-like-it")


def test_limits_are_the_bed_less_the_mould() -> None:
    used = load_used()
    limits = limits_for(used, 4.1)
    mould, (width, depth) = used.material.mould, used.printer.bed_size
    assert limits.mean == 4.1
    assert limits.size == (width - 2 * (mould.wall + mould.mark), min(width, depth) - 2 * (mould.wall + mould.mark))
    square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    assert limits.fits is not None and limits.fits(50 * square) and not limits.fits(width * square)


def test_limits_of_a_document_are_its_own() -> None:
    mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    skin = Skin(mesh, Source("a.obj", "", "mm", 1.0), np.zeros((0, 2), dtype=np.int64), (), max_distortion=4.2)
    assert limits_of(skin).mean == 4.2 and limits_of(skin).size == limits_for(used_by(skin), 4.2).size
