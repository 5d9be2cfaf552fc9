"""The plate's strips have the lengths they say, fit like any sensor, and the table names them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.material import Material, load_material
from skinfab.placement.check import validate
from skinfab.skin import Skin
from skinfab.strip_plate import strip_skin, write_strip_table
from skinfab.strip_table import read_strips

MATERIAL = load_material()
WIDE = replace(MATERIAL, ink=replace(MATERIAL.ink, bead_width=1.6), gap=1.2, margin=2.0, pad=4.0)


def plate(copies: int = 4, material: Material = MATERIAL) -> Skin:
    return strip_skin(material, copies=copies, material_name="carbon-grease-ecoflex", printer_name="ender5plus-vipro")


@pytest.mark.parametrize("material", [MATERIAL, WIDE])
@pytest.mark.parametrize("copies", [2, 8])
def test_strips_are_sound(copies: int, material: Material) -> None:
    skin = plate(copies, material)
    validate(skin, material)
    lengths = [s.path.length for s in skin.sensors]
    np.testing.assert_allclose(sorted(lengths), sorted([40.0, 160, 640] * copies), rtol=1e-12)
    assert [s.channel for s in skin.sensors] == list(range(3 * copies))
    assert max(skin.pieces[0].size) < 330  # with its mould it lies on a bed of 350 mm


def test_table_to_fill_in(tmp_path: Path) -> None:
    write_strip_table(plate(2), tmp_path / "strips.csv")
    lines = (tmp_path / "strips.csv").read_text().splitlines()
    assert lines[:2] == ["sensor,length_mm,r_kohm", "L640-1,640.0,"] and len(lines) == 7
    with pytest.raises(InputError, match="is not filled in: the column r_kohm is empty for all 6 strips"):
        read_strips(tmp_path / "strips.csv")


@pytest.mark.parametrize("copies", [1, 9])
def test_copies_out_of_range(copies: int) -> None:
    with pytest.raises(InputError, match=f"{copies} strips of each length; a plate has 2 to 8"):
        plate(copies)
