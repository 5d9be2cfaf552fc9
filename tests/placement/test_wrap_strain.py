"""Wrap strain against closed forms."""

from collections.abc import Callable

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.paths import Arc, Line, Path
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.pieces import Piece
from skinfab.placement.wrap_strain import wrap_strain

SPIRAL = ContactSpiral(n=3, x=1.7, b=1.5, l=3, s=15).path().transformed(angle=0.3, shift=(12, 15))


@pytest.mark.parametrize(("scale", "strain"), [(1.0, 0.0), (1 / 1.1, 0.1), (1.25, -0.2)])
def test_a_uniform_scale(sheet: Callable, scale: float, strain: float) -> None:
    got = wrap_strain(*sheet(60, 60, scale=scale), SPIRAL)
    assert got.mean == pytest.approx(strain, abs=1e-12) and got.max == pytest.approx(strain, abs=1e-12)


def test_one_direction_only(sheet: Callable) -> None:
    mesh, piece = sheet(60, 60)
    wide = Mesh(mesh.V * [1.2, 1, 1], mesh.F)
    assert wrap_strain(wide, piece, Path((Line((5, 5), (50, 5)),))).mean == pytest.approx(0.2)
    assert wrap_strain(wide, piece, Path((Line((5, 5), (5, 50)),))).mean == pytest.approx(0, abs=1e-12)
    # A circle becomes an ellipse: its length in closed form.
    from scipy.special import ellipe

    ring = wrap_strain(wide, piece, Path((Arc((30, 30), 10.0, 0.0, 2 * np.pi),)), step=0.1)
    assert ring.mean == pytest.approx(4 * 12 * ellipe(1 - (10 / 12) ** 2) / (2 * np.pi * 10) - 1, abs=1e-6)
    assert ring.max == pytest.approx(0.2, abs=1e-4)


def test_the_mean_weighs_length_and_the_max_keeps_its_sign(sheet: Callable) -> None:
    mesh, piece = sheet(40, 20, step=5)
    V = mesh.V.copy()
    right = V[:, 0] > 20
    V[right, 0] = 20 + 0.7 * (V[right, 0] - 20)  # 30 % shorter on the right half only
    got = wrap_strain(Mesh(V, mesh.F), piece, Path((Line((10, 7), (25, 7)),)))
    assert got.mean == pytest.approx(-0.3 * 5 / 15) and got.max == pytest.approx(-0.3)


def test_bending_without_stretch_is_none(sheet: Callable) -> None:
    mesh, piece = sheet(60, 60, step=0.5)
    x, y, _ = mesh.V.T
    bent = Mesh(np.column_stack([10 * np.sin(x / 10), y, 10 * np.cos(x / 10)]), mesh.F)
    got = wrap_strain(bent, piece, SPIRAL)
    assert abs(got.mean) < 2e-4 and abs(got.max) < 2e-4  # chords of 0.5 mm on a radius of 10: 1e-4


def test_a_path_off_the_piece(sheet: Callable) -> None:
    mesh, piece = sheet(60, 60)
    with pytest.raises(InputError, match=r"leaves piece P1 near \(60\.\d, 5\.0\)"):
        wrap_strain(mesh, piece, Path((Line((50, 5), (70, 5)),)))
    assert isinstance(piece, Piece)
