"""Advice is given where it helps, and only there."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinfab.cli.advice import many_pieces
from skinfab.document import load_skin
from skinfab.seams.edit import lock


@pytest.mark.parametrize(
    ("name", "pieces", "wrapped", "told"),
    [("cube", 21, False, True), ("cube", 20, False, False), ("cube", 21, True, False), ("robot_finger", 30, False, False)],
)
def test_a_closed_object_in_very_many_pieces(
    name: str, pieces: int, wrapped: bool, told: bool, cut_once: Callable[[str, Path], Path], tmp_path: Path
) -> None:
    skin = load_skin(cut_once(name, tmp_path / "a.skin"))
    skin = replace(skin, pieces=tuple(replace(skin.pieces[0], id=f"P{k}") for k in range(pieces)))
    advice = many_pieces(skin, wrapped=wrapped)
    assert len(advice) == told and all(f"into {pieces} pieces" in sentence and "--wrap 8" in sentence for sentence in advice)


def test_locks_are_blamed_where_they_part_it(cut_once: Callable[[str, Path], Path], tmp_path: Path) -> None:
    skin = load_skin(cut_once("dodecahedron", tmp_path / "a.skin"))
    skin = replace(skin, pieces=tuple(replace(skin.pieces[0], id=f"P{k}") for k in range(len(skin.mesh.F))))
    few, all_of_them = (lock(skin, np.arange(k)) for k in (3, len(skin.mesh.topology.E)))
    assert "--wrap 8" in many_pieces(few, wrapped=False)[0]
    (said,) = many_pieces(all_of_them, wrapped=False)
    assert "locked seams part it" in said and "--wrap" not in said
