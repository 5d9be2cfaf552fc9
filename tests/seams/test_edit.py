"""Seams by hand: cut, glue, lock, forbid, paint; ways that keep to the marks."""

from dataclasses import replace

import numpy as np
import pytest
from shapes import cube, grid, object_mesh, sphere, torus

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.seams.edit import allow, chain, cut_path, forbid, glue, lock, paint, path_edges, preview_path, unlock
from skinfab.seams.manual import cut_along
from skinfab.seams.rules import edge_mask
from skinfab.seams.ways import Ways
from skinfab.skin import SeamMarks, Skin, Source

NO_SEAMS = np.zeros((0, 2), dtype=np.int64)


def skin_of(mesh: Mesh) -> Skin:
    return Skin(mesh, Source("a.obj", "0" * 64, "mm", 1.0), NO_SEAMS, ())


def sheet(n: int = 6) -> Skin:
    """A flat square; vertex (i, j) has number j (n + 1) + i."""
    V, F = grid(n, n)
    return skin_of(Mesh(60 * V, F))


def two_spheres() -> Skin:
    V, F = sphere(1)
    return skin_of(Mesh(np.vstack([V, V + 5]), np.vstack([F, F + len(V)])))


def seam_set(skin: Skin) -> set[tuple[int, int]]:
    return {tuple(sorted(pair)) for pair in skin.seams.tolist()}


def test_a_cut_is_what_a_cuts_file_cuts() -> None:
    """The window and `skinfab segment --cuts` find the same edges."""
    mesh = object_mesh("robot_finger")
    points = [5, 400, 1200, 77]
    skin = cut_path(skin_of(mesh), points)
    by_file = cut_along(mesh, [mesh.V[points]])
    np.testing.assert_array_equal(skin.seams, mesh.topology.E[by_file & ~mesh.topology.is_boundary])
    assert len(skin.seams) > 20


def test_the_preview_is_what_is_cut_and_searches_once() -> None:
    mesh = object_mesh("robot_finger")
    skin = skin_of(mesh)
    ways = Ways(mesh)
    for end in (400, 900, 13):
        path = preview_path(skin, 5, end, ways=ways)
        assert path[0] == 5 and path[-1] == end
        np.testing.assert_array_equal(path, preview_path(skin, 5, end))
        before = ways._before
        assert seam_set(cut_path(skin, [5, end], ways=ways)) == {
            tuple(sorted(p)) for p in np.stack([path[:-1], path[1:]], axis=1).tolist()
        } - {tuple(p) for p in mesh.topology.E[mesh.topology.is_boundary].tolist()}
        assert ways._before is before


def test_ways_of_another_document_are_not_used() -> None:
    skin = sheet()
    old = Ways(skin.mesh)
    closed = forbid(skin, path_edges(skin.mesh, [24, 25]))
    assert not old.suit(closed)
    assert preview_path(closed, 24, 25, ways=old).tolist() != [24, 25]


def test_attracting_faces_draw_a_way_and_avoided_ones_push_it() -> None:
    skin = sheet(12)
    middle = skin.mesh.V[skin.mesh.F].mean(axis=1)
    straight = preview_path(skin, 13 * 6, 13 * 6 + 12)
    assert np.ptp(skin.mesh.V[straight, 1]) == 0
    avoiding = paint(skin, np.flatnonzero(np.abs(middle - [30, 30, 0]).max(axis=1) < 6), -1)
    assert np.ptp(skin.mesh.V[preview_path(avoiding, 13 * 6, 13 * 6 + 12), 1]) > 0
    attracting = paint(skin, np.flatnonzero(middle[:, 1] > 50), 1)
    low, high = preview_path(skin, 13 * 9, 13 * 9 + 12), preview_path(attracting, 13 * 9, 13 * 9 + 12)
    assert skin.mesh.V[low, 1].max() == 45 and skin.mesh.V[high, 1].max() >= 50


def test_a_forbidden_edge_is_never_on_a_way() -> None:
    skin = sheet()
    wall = path_edges(skin.mesh, [24 + 7 * k for k in range(-3, 4)])
    closed = forbid(skin, wall)
    for a, b in ((3, 45), (10, 38), (24, 31)):
        assert not np.isin(path_edges(skin.mesh, preview_path(closed, a, b)), wall).any()
    assert seam_set(cut_path(allow(closed, wall), [3, 45])) == seam_set(cut_path(skin, [3, 45]))


@pytest.mark.parametrize(
    ("points", "says"),
    [
        ([], "a cut needs two points, none was given"),
        ([3], "a cut needs two points, this has one"),
        ([3, 9999], "vertex 9999 does not exist; the mesh has vertices 0 to 83"),
        ([-1, 3], "vertex -1 does not exist"),
        ([0, 60], "lie on different parts of the object"),
    ],
)
def test_cuts_that_cannot_be(points: list[int], says: str) -> None:
    skin = two_spheres()
    with pytest.raises(InputError, match=says):
        cut_path(skin, points)
    assert not len(skin.seams)


def test_everything_forbidden() -> None:
    skin = skin_of(Mesh(*sphere(1)))
    closed = forbid(skin, np.arange(len(skin.mesh.topology.E)))
    with pytest.raises(InputError, match="every way from vertex 0 to vertex 7 is forbidden; allow some"):
        cut_path(closed, [0, 7])
    assert preview_path(closed, 0, 7).tolist() == []
    assert allow(closed, np.arange(len(skin.mesh.topology.E))).marks is None


def test_what_changes_nothing_gives_the_same_skin() -> None:
    skin = cut_path(sheet(), [21, 27])
    edges = path_edges(skin.mesh, [22, 23])
    assert cut_path(skin, [22, 26]) is skin and cut_path(skin, [23, 23]) is skin
    assert cut_path(skin, list(range(7))) is skin  # the sheet's own border
    assert unlock(skin, edges) is skin and allow(skin, edges) is skin and paint(skin, [3], 0) is skin
    locked = lock(skin, edges)
    assert lock(locked, edges) is locked and locked.marks is not None
    assert unlock(locked, edges).marks is None


def test_a_chain_ends_at_branches_and_at_the_border() -> None:
    skin = cut_path(cut_path(sheet(), [21, 27]), [24, 45])
    mesh = skin.mesh
    left = chain(mesh, skin.seams, int(path_edges(mesh, [22, 23])[0]))
    np.testing.assert_array_equal(left, path_edges(mesh, [21, 22, 23, 24]))
    up = chain(mesh, skin.seams, int(path_edges(mesh, [31, 38])[0]))
    np.testing.assert_array_equal(up, path_edges(mesh, [24, 31, 38, 45]))
    glued = glue(skin, int(up[0]))
    whole = chain(mesh, glued.seams, int(left[0]))  # no branch is left
    np.testing.assert_array_equal(whole, path_edges(mesh, range(21, 28)))


def test_a_closed_loop_is_one_chain_each_edge_once() -> None:
    mesh = Mesh(*torus())
    around = [16 * k for k in range(36)]
    skin = cut_path(skin_of(mesh), [*around, 0])
    assert len(skin.seams) == 36
    for edge in mesh.topology.edge_ids(skin.seams)[[0, 7, 35]]:
        found = chain(mesh, skin.seams, int(edge))
        assert sorted(found.tolist()) == sorted(mesh.topology.edge_ids(skin.seams).tolist())
        ends = mesh.topology.E[found]
        assert all(set(a) & set(b) for a, b in zip(ends, np.roll(ends, -1, axis=0), strict=True))
    assert not len(glue(skin, int(found[0])).seams)


def test_loops_that_touch_are_chains_of_their_own() -> None:
    skin = cut_path(cut_path(sheet(), [24, 25, 32, 31, 24]), [24, 23, 16, 17, 24])
    one = chain(skin.mesh, skin.seams, int(path_edges(skin.mesh, [25, 32])[0]))
    assert set(one.tolist()) == set(path_edges(skin.mesh, [24, 25, 32, 31, 24]).tolist()) and len(one) == 4


def test_gluing_the_last_seam_leaves_none() -> None:
    skin = cut_path(skin_of(Mesh(*sphere(1))), [0, 7])
    glued = glue(skin, int(skin.mesh.topology.edge_ids(skin.seams)[0]))
    assert glued.seams.shape == (0, 2)
    with pytest.raises(InputError, match="not on a seam"):
        glue(glued, 0)


@pytest.mark.parametrize("edge", [-1, 10**6])
def test_no_such_edge(edge: int) -> None:
    skin = sheet()
    with pytest.raises(InputError, match="not on a seam"):
        chain(skin.mesh, skin.seams, edge)
    for change in (lock, unlock, forbid, allow):
        with pytest.raises(InputError, match="an edge does not exist; the mesh has edges 0 to"):
            change(skin, [edge])


def test_a_locked_seam_is_neither_glued_nor_forbidden() -> None:
    skin = cut_path(sheet(), [21, 27])
    edges = path_edges(skin.mesh, [23, 24])
    locked = lock(skin, edges)
    with pytest.raises(InputError, match="locked; unlock it before gluing"):
        glue(locked, int(path_edges(skin.mesh, [21, 22])[0]))
    with pytest.raises(InputError, match="unlock it before forbidding"):
        forbid(locked, edges)
    assert not len(glue(unlock(locked, edges), int(edges[0])).seams)


def test_locking_cuts_and_forbidding_glues() -> None:
    skin = sheet()
    edges = path_edges(skin.mesh, [23, 24, 25])
    locked = lock(skin, edges)
    assert seam_set(locked) == {(23, 24), (24, 25)}
    forbidden = forbid(unlock(locked, edges), edges[:1])
    assert seam_set(forbidden) == {(24, 25)}
    with pytest.raises(InputError, match="allow it before locking"):
        lock(forbidden, edges)


def test_marks_of_the_border_say_nothing() -> None:
    skin = sheet()
    border = np.flatnonzero(skin.mesh.topology.is_boundary)
    assert lock(skin, border) is skin and forbid(skin, border) is skin


def test_painting() -> None:
    skin = paint(paint(sheet(), [3, 5], 1), [5], -1)
    assert skin.marks is not None and skin.marks.preference.dtype == np.int8
    assert np.flatnonzero(skin.marks.preference).tolist() == [3, 5] and skin.marks.preference[[3, 5]].tolist() == [1, -1]
    assert paint(skin, [3, 5], 0).marks is None
    with pytest.raises(InputError, match="2 is no preference"):
        paint(skin, [3], 2)
    for face in (-1, 72):
        with pytest.raises(InputError, match="mesh has faces 0 to 71"):
            paint(skin, [face], 1)


def test_edits_leave_the_old_document_as_it_was() -> None:
    skin = lock(cut_path(sheet(), [21, 27]), [30])
    assert skin.marks is not None
    kept = skin.seams.copy(), skin.marks.locked.copy(), skin.marks.preference.copy()
    unlock(paint(forbid(cut_path(skin, [3, 45]), [80]), [1, 2], 1), [30])
    for old, now in zip(kept, (skin.seams, skin.marks.locked, skin.marks.preference), strict=True):
        np.testing.assert_array_equal(old, now)


def test_seams_are_in_the_order_of_the_mesh_whatever_the_clicks() -> None:
    V, F = cube(3)
    mesh = Mesh(V, F)
    one, two = (cut_path(skin_of(mesh), points) for points in ([0, 20, 40], [40, 20, 0]))
    assert (np.diff(mesh.topology.edge_ids(one.seams)) > 0).all()
    assert edge_mask(mesh, one.seams).sum() == len(one.seams)
    assert len(one.seams) == len(two.seams)


def test_marks_given_as_no_edges_of_the_mesh_name_none() -> None:
    skin = sheet()
    odd = replace(skin, marks=SeamMarks(np.array([[0, 48]]), np.array([[0, 999]]), np.zeros(72, dtype=np.int8)))
    assert len(cut_path(odd, [21, 27]).seams) == 6
