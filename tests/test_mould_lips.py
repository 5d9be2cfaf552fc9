"""Lips are planned from what lies near each of them: the same lips as from the whole piece."""

import numpy as np
import pytest

from skinfab import mould_plan
from skinfab.material import load_material
from skinfab.pieces import Piece


def star(spikes: int) -> Piece:
    """Darts all round, 3 to 8 mm wide at the rim: lips make room for each other and for the flanks across."""
    corners = 2 * spikes
    angle = np.arange(corners) * 2 * np.pi / corners
    radius = np.where(np.arange(corners) % 2, 25.0, 40.0 + 3 * np.sin(5 * angle))
    UV = np.vstack([np.zeros((1, 2)), np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])])
    ring = 1 + np.arange(corners)
    F = np.column_stack([np.zeros(corners, dtype=np.int64), ring, np.roll(ring, -1)])
    return Piece("P1", np.arange(len(F)), np.arange(len(UV)), F, UV)


@pytest.mark.parametrize("spikes", [9, 40])
def test_what_lies_far_off_changes_no_lip(spikes: int, monkeypatch: pytest.MonkeyPatch) -> None:
    piece, mould = star(spikes), load_material().mould
    ring = np.vstack([piece.outline, piece.outline[:1]])
    lips = [ring[k : k + 3] for k in range(0, len(ring) - 2, 4)]
    near = mould_plan.mould_plan(piece, mould=mould, depth=2.5, lips=lips).lip
    monkeypatch.setattr(mould_plan, "_NEAR_WALLS", 1e3)
    whole = mould_plan.mould_plan(piece, mould=mould, depth=2.5, lips=lips).lip
    assert near.area > 20
    assert near.symmetric_difference(whole).area < 1e-5 * whole.area

    # No wall round it is not enough: the test tells.
    monkeypatch.setattr(mould_plan, "_NEAR_WALLS", 0)
    assert mould_plan.mould_plan(piece, mould=mould, depth=2.5, lips=lips).lip.symmetric_difference(whole).area > 1e-3 * whole.area
