"""Small pieces that locked seams part off are named; those that the search parts off, and those that can be handled, are not."""

from dataclasses import replace

import numpy as np
import pytest
from shapes import grid

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.seams.auto import Aim, find_seams
from skinfab.seams.edit import lock
from skinfab.seams.enclosed import enclosed_pieces, enclosed_words
from skinfab.seams.judge import Limits
from skinfab.seams.partial import auto_cut
from skinfab.seams.rules import EdgeRules
from skinfab.skin import Skin, Source

LIMITS = Limits(mean=4.05)


def sheet(size: float) -> Skin:
    V, F = grid(6, 6)
    return Skin(Mesh(size * V, F), Source("a.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), ())


@pytest.mark.parametrize(("size", "told"), [(18, True), (36, False)])
def test_a_locked_ring_round_one_triangle(size: float, told: bool) -> None:
    skin = sheet(size)
    ring = skin.mesh.topology.FE[30]
    result = auto_cut(lock(skin, ring), LIMITS, neck=4.0)
    assert len(result.skin.pieces) == 2
    assert [fault.faces.tolist() for fault in result.faults] == [[30]] * told
    for fault in result.faults:
        assert "(1 triangle, " in fault.text and "by locked seams" in fault.text
        a, b = skin.mesh.topology.E[ring[0]].tolist()
        assert f"{a}-{b}" in fault.text or f"{b}-{a}" in fault.text


def test_only_what_locks_part_off_all_round() -> None:
    """A border of which one edge is not locked could be glued; an object smaller than a neck has no border to glue."""
    skin = sheet(18)
    ring = skin.mesh.topology.FE[30]
    pieces = auto_cut(lock(skin, ring), LIMITS, neck=4.0).skin.pieces
    locked = np.isin(np.arange(len(skin.mesh.topology.E)), ring)
    assert [len(piece.faces) for piece in enclosed_pieces(skin.mesh, pieces, locked, 4.0)] == [1]
    locked[ring[0]] = False
    assert enclosed_pieces(skin.mesh, pieces, locked, 4.0) == []
    whole = auto_cut(sheet(3), LIMITS).skin
    assert enclosed_pieces(whole.mesh, whole.pieces, np.zeros(len(locked), dtype=bool), 4.0) == []


def test_of_a_document() -> None:
    skin = sheet(18)
    locked = lock(skin, skin.mesh.topology.FE[30])
    cut = auto_cut(locked, LIMITS, neck=4.0)
    assert enclosed_words(cut.skin, 4.0) == [fault.text for fault in cut.faults] and len(cut.faults) == 1
    assert enclosed_words(cut.skin, 0.1) == enclosed_words(replace(cut.skin, marks=None), 4.0) == []


@pytest.mark.parametrize("aim", ["fewest", "usual", "simplest"])
def test_locked_and_forbidden_at_once_is_refused(aim: Aim) -> None:
    mesh = sheet(18).mesh
    both = np.isin(np.arange(len(mesh.topology.E)), mesh.topology.edge_ids(np.array([[8, 9], [9, 10]])))
    rules = EdgeRules(np.ones(len(both)), both, both)
    with pytest.raises(InputError, match=r"8-9, 9-10: locked, which stays a seam, and forbidden.*unlock it or allow it"):
        find_seams(mesh, LIMITS, rules=rules, aim=aim)
