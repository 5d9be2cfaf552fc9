"""Advice is given where it helps, and only there."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from skinfab.cli.advice import many_pieces
from skinfab.document import load_skin


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
