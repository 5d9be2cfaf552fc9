"""Necks of flat pieces: found where something hangs on them, not at tips, nor in strips that are narrow throughout."""

import numpy as np
import pytest
import shapes

from skinfab.flatten.neck import find_neck
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces


def bar(neck: float, *, columns: int = 60, length: float = 60.0, wide: float = 12.0):
    """A flat bar, `wide` mm, that narrows smoothly to `neck` mm in its middle third; its left end is the shorter one."""

    def place(s, t):
        x = length * s
        half = wide / 2 - (wide - neck) / 2 * np.exp(-(((x - 0.45 * length) / (0.08 * length)) ** 2))
        return np.stack([x, (2 * t - 1) * half, 0 * s], axis=1)

    V, F = shapes.grid(columns, 8, place)
    return F, V[:, :2]


@pytest.mark.parametrize("width", [0.5, 2.0, 3.5])
def test_width_and_sides(width: float) -> None:
    F, UV = bar(width)
    neck = find_neck(F, UV, 4.0)
    assert neck is not None and neck.width == pytest.approx(width, abs=0.1)
    x = UV[F].mean(axis=1)[:, 0]
    assert x[neck.side == 1].max() < 27 < x[neck.side == 2].min()
    assert find_neck(F, UV, 0.9 * width) is None


def test_none_where_it_is_wide_enough_or_not_asked_for() -> None:
    assert find_neck(*bar(4.5), 4.0) is None
    assert find_neck(*bar(1.0), 0.0) is None


def test_strips_narrow_throughout_and_tips_are_none() -> None:
    assert find_neck(*bar(3.0, wide=3.2), 4.0) is None
    V, F = shapes.grid(20, 6, lambda s, t: np.stack([50 * s, (2 * t - 1) * 10 * (1 - s) + 1e-3 * t, 0 * s], axis=1))
    assert find_neck(F, V[:, :2], 4.0) is None


def test_a_rough_strip_just_as_wide_as_asked_for_is_none() -> None:
    rng = np.random.default_rng(0)
    V, F = shapes.grid(80, 3, lambda s, t: np.stack([80 * s, 4 * t + 0.2 * rng.random(len(s)) * (2 * t - 1), 0 * s], axis=1))
    assert find_neck(F, V[:, :2], 4.0) is None


def test_between_the_tip_of_a_dart_and_the_border() -> None:
    """The sides of the dart lie on each other: by area alone there is nothing missing."""
    mesh = Mesh(*shapes.grid(10, 10, lambda s, t: np.stack([30 * s, 30 * t, 0 * s], axis=1)))
    middle = 5 * 11 + np.arange(11)
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    cut[mesh.topology.edge_ids(np.stack([middle[:-2], middle[1:-1]], axis=1))] = True  # leaves 3 of 30 mm
    (piece,) = open_pieces(mesh, cut)
    UV = mesh.V[piece.vertices, :2]
    neck = find_neck(piece.F, UV, 4.0, topology=piece.topology)
    assert piece.is_disk and neck is not None and neck.width == pytest.approx(3, abs=0.1)
    assert find_neck(piece.F, UV, 2.5, topology=piece.topology) is None


def test_three_lobes_the_smallest_first() -> None:
    F, UV = bar(1.0)
    x = UV[:, 0]
    UV = np.c_[x, UV[:, 1] * np.where(x > 40, 0.1 + 0.9 * np.minimum(np.abs(x - 48) / 4, 1) ** 2, 1)]  # another neck, 12 mm from the end
    neck = find_neck(F, UV, 4.0)
    assert neck is not None and UV[F].mean(axis=1)[neck.side == 1, 0].min() > 48


def test_turned_and_scaled_it_is_the_same() -> None:
    F, UV = bar(2.0)
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    one, other = find_neck(F, UV, 4.0), find_neck(F, 100 * UV @ turn.T, 400.0)
    assert one is not None and other is not None
    assert other.width == pytest.approx(100 * one.width, rel=0.05)
    assert (one.side != other.side).mean() < 0.02 and not (one.side * other.side == 2).any()  # rims are made of chords


def test_what_is_no_layout_has_none() -> None:
    F, UV = bar(1.0)
    UV[3] = np.nan
    assert find_neck(F, UV, 4.0) is None
