"""Opening a skin along its seams: only what changed is flattened, and a bad cut is a sentence."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from shapes import cube, grid, holed, object_mesh, sphere, torus

from skinfab.document import load_skin, save_skin
from skinfab.errors import InputError, RefusedError
from skinfab.flatten.distortion import measure
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.placement.lifted import Lifted
from skinfab.placement.sensor import Sensor
from skinfab.seams import lenient
from skinfab.seams.auto import find_seams
from skinfab.seams.edit import cut_path, forbid, glue, lock, paint, path_edges
from skinfab.seams.finish import finish
from skinfab.seams.judge import Limits
from skinfab.seams.manual import seams_by_hand
from skinfab.seams.partial import Reopened, auto_cut, reopen
from skinfab.seams.rules import edge_mask
from skinfab.skin import Skin, Source

LIMITS = Limits(mean=4.05)
NO_SEAMS = np.zeros((0, 2), dtype=np.int64)
SPIRAL = make_pattern("contact-spiral", {"n": 3, "x": 1.7, "b": 1.5, "l": 3, "s": 25})


def skin_of(V: np.ndarray, F: np.ndarray) -> Skin:
    return Skin(Mesh(V, F), Source("a.obj", "0" * 64, "mm", 1.0), NO_SEAMS, ())


def sheet() -> Skin:
    """A bumpy square of 120 mm; vertex (i, j) has number 13 j + i."""
    V, F = grid(12, 12, lambda s, t: np.stack([s, t, 0.03 * np.sin(9 * s) * np.cos(7 * t)], axis=1))
    return skin_of(120 * V, F)


def column(i: int) -> list[int]:
    return [13 * j + i for j in range(13)]


def opened(skin: Skin) -> Reopened:
    result = reopen(skin, LIMITS)
    faces = [piece.faces for piece in result.skin.pieces]
    assert all(not np.intersect1d(a, b).size for a, b in combinations(faces, 2))
    assert len(result.distortions) == len(faces)
    for piece, d in zip(result.skin.pieces, result.distortions, strict=True):
        assert measure(piece.V(skin.mesh), piece.F, piece.UV).mean == pytest.approx(d.mean)
    return result


def texts(result: Reopened) -> list[str]:
    return [fault.text for fault in result.faults]


def test_only_the_piece_that_was_cut_is_flattened_anew() -> None:
    three = opened(cut_path(cut_path(sheet(), column(3)), column(8)))
    assert [p.id for p in three.skin.pieces] == ["P1", "P2", "P3"] and not three.faults
    four = opened(cut_path(three.skin, [13 * 6, 13 * 6 + 1, 13 * 6 + 2, 13 * 6 + 3]))
    shared = [p for p in four.skin.pieces if any(p is q for q in three.skin.pieces)]
    assert len(four.skin.pieces) == 4 and len(shared) == 2
    assert {p.id for p in four.skin.pieces} == {"P1", "P2", "P3", "P4"}
    assert all(p is q for p, q in zip(opened(four.skin).skin.pieces, four.skin.pieces, strict=True))


def test_the_largest_part_keeps_the_id_and_gluing_gives_one_back() -> None:
    one = opened(sheet()).skin
    two = opened(cut_path(one, column(4))).skin
    assert [(p.id, len(p.faces)) for p in two.pieces] == [("P1", 192), ("P2", 96)]
    back = opened(glue(two, int(path_edges(two.mesh, column(4)[:2])[0]))).skin
    assert [p.id for p in back.pieces] == ["P1"]
    np.testing.assert_array_equal(back.pieces[0].UV, one.pieces[0].UV)


def test_a_result_is_a_document(tmp_path) -> None:
    skin = opened(cut_path(sheet(), column(4))).skin
    save_skin(skin, tmp_path / "a.skin")
    back = load_skin(tmp_path / "a.skin")
    again = reopen(back, LIMITS).skin
    assert all(p is q for p, q in zip(again.pieces, back.pieces, strict=True))


def test_pieces_are_those_of_the_command_line() -> None:
    """Seams by hand, flattened by the window and by `skinfab segment --cuts`: the same to the last digit."""
    skin = cut_path(sheet(), column(5))
    cut = edge_mask(skin.mesh, skin.seams)
    by_hand = finish(skin.mesh, seams_by_hand(skin.mesh, cut, LIMITS), LIMITS)
    for piece, (_, verdict) in zip(sorted(opened(skin).skin.pieces, key=lambda p: p.faces[0]), by_hand.pieces, strict=True):
        np.testing.assert_array_equal(piece.UV, verdict.UV)


def test_a_cut_that_parts_nothing_opens_a_dart() -> None:
    one = opened(sheet()).skin
    dart = opened(cut_path(one, [78, 79, 80, 81]))
    assert [p.id for p in dart.skin.pieces] == ["P1"] and not dart.faults
    assert len(dart.skin.pieces[0].vertices) == len(one.pieces[0].vertices) + 3
    inside = opened(cut_path(one, [80, 81, 82]))
    assert "P1 is a ring with 2 borders: cut from one border to another" in texts(inside)


def test_a_closed_object_is_named_and_left_out() -> None:
    result = opened(skin_of(20 * sphere(2)[0], sphere(2)[1]))
    assert result.skin.pieces == ()
    assert texts(result) == ["the object is closed, so it cannot lie flat: cut it open"]
    assert len(result.faults[0].faces) == len(result.skin.mesh.F) and result.faults[0].piece == ""


def test_a_closed_loop_leaves_a_lid_and_a_closed_rest() -> None:
    V, F = cube(4)
    top = opened(cut_path(skin_of(40 * V, F), [0, 4, 24, 20, 0]))  # round one side or part of it
    assert len(top.skin.pieces) >= 1
    far = 20 * sphere(3)[0], sphere(3)[1]
    skin = skin_of(*far)
    ring = np.flatnonzero(np.abs(skin.mesh.V[:, 2]) < 1e-9)
    ring = ring[np.argsort(np.arctan2(*skin.mesh.V[ring, :2].T))]
    halves = opened(cut_path(skin, [*ring.tolist(), int(ring[0])]))
    assert [p.id for p in halves.skin.pieces] == ["P1", "P2"]
    assert all("over the bound 4.05: cut it further, or raise the bound" in text for text in texts(halves)) and len(halves.faults) == 2


def test_a_hardly_opened_object_is_shown_all_the_same() -> None:
    """A conformal layout would be off a thousand times; what is shown is off by little more than it must be."""
    skin = skin_of(20 * sphere(4)[0], sphere(4)[1])
    slit = opened(cut_path(skin, [0, int(np.argmin(np.linalg.norm(skin.mesh.V - skin.mesh.V[0] * 0.9 - 4, axis=1)))]))
    (piece,) = slit.skin.pieces
    assert slit.faults[0].piece == "P1" and "over the bound 4.05: cut it further" in slit.faults[0].text
    assert slit.distortions[0].mean < 40 and not slit.distortions[0].flipped and max(piece.size) < 400


def test_what_would_dwarf_all_others_is_left_out() -> None:
    """Rings about a ball's whole surface: a layout would be meters wide."""
    V, F = sphere(4)
    skin = skin_of(20 * V, F)
    for pole in (0, 1, 2, 3):
        edge = skin.mesh.topology.E[(skin.mesh.topology.E == pole).any(axis=1)][0]
        further = skin.mesh.topology.E[(skin.mesh.topology.E == edge.sum() - pole).any(axis=1)]
        skin = cut_path(skin, [pole, int(edge.sum() - pole), int(further[further != edge.sum() - pole][-1])])
    result = opened(skin)
    assert "a ring with 4 borders: cut from one border to another" in texts(result)[0]
    assert all(max(piece.size) < 1000 for piece in result.skin.pieces)


def test_what_is_far_from_flat_is_named_without_a_number_that_says_nothing(monkeypatch) -> None:
    monkeypatch.setattr(lenient, "_HOPELESS", 8.0)  # as on a scan of 85,000 triangles opened by one slit, which takes long
    skin = skin_of(*sphere(2))
    edge = skin.mesh.topology.E[0]
    further = skin.mesh.topology.E[(skin.mesh.topology.E == edge[1]).any(axis=1) & (skin.mesh.topology.E != edge[0]).all(axis=1)][0]
    result = opened(cut_path(skin, [*edge.tolist(), int(further.sum() - edge[1])]))
    assert result.skin.pieces == () and texts(result) == ["the object is hardly open yet, so it cannot lie flat: cut it further"]


def test_a_handle_is_named() -> None:
    V, F = torus(columns=24, rows=12)
    skin = cut_path(skin_of(10 * V, F), [0, 1, 2])
    result = opened(skin)
    assert result.skin.pieces == () and texts(result) == ["the object has a handle, so it cannot lie flat: cut through the handle"]


def test_a_piece_with_holes_is_shown_and_named() -> None:
    V, F = holed()[:2]
    result = opened(skin_of(50 * np.asarray(V), F))
    assert [p.id for p in result.skin.pieces] == ["P1"]
    assert texts(result) == ["P1 is a ring with 3 borders: cut from one border to another"]


def test_components_are_parts_of_their_own() -> None:
    V, F = sphere(1)
    G, H = grid(3, 3)
    result = opened(skin_of(np.vstack([9 * V, 50 + 30 * G]), np.vstack([F, H + len(V)])))
    assert [p.id for p in result.skin.pieces] == ["P1"]
    assert texts(result) == [f"a part of {len(F)} triangles is closed, so it cannot lie flat: cut it open"]


def test_a_piece_too_large_for_the_bed() -> None:
    result = reopen(sheet(), Limits(mean=4.05, size=(100.0, 90.0)))
    assert len(result.skin.pieces) == 1 and "does not fit the bed (100 x 90 mm): cut it smaller" in result.faults[0].text


def test_faults_of_pieces_that_stayed_are_said_again() -> None:
    one = opened(sheet()).skin
    again = reopen(one, Limits(mean=4.0 + 1e-9))
    assert again.skin.pieces[0] is one.pieces[0] and "over the bound 4" in again.faults[0].text and again.faults[0].piece == "P1"
    assert again.skin.max_distortion == 4.0 + 1e-9


@pytest.mark.parametrize("method", ["bff", "isometric", "bijective", "lscm", "arap"])
def test_other_methods_flatten_what_is_asked_for_anew(method: str) -> None:
    two = opened(cut_path(sheet(), column(4))).skin
    other = reopen(two, LIMITS, method=method, anew=["P1"]).skin
    assert other.pieces[1] is two.pieces[1] and other.pieces[0] is not two.pieces[0]
    d = [measure(p.V(two.mesh), p.F, p.UV).mean for p in (two.pieces[0], other.pieces[0])]
    assert d[1] == pytest.approx(d[0], abs=2e-3) and d[1] >= d[0] - 1e-6


def test_cones_cut_further_and_keep_to_what_is_forbidden() -> None:
    V, F = cube(3)
    skin = skin_of(30 * V, F)
    result = reopen(skin, LIMITS, method="bff-cones", cones=8)
    assert not result.faults and len(result.skin.pieces) == 1 and len(result.skin.seams)
    assert result.distortions[0].mean == pytest.approx(4, abs=1e-6)
    closed = forbid(skin, skin.mesh.topology.edge_ids(result.skin.seams))
    assert "the way to a cone is forbidden; allow it" in reopen(closed, LIMITS, method="bff-cones", cones=8).faults[0].text


@pytest.mark.parametrize(("method", "cones"), [("best", None), ("bff", 4), ("bff-cones", 0)])
def test_no_such_method(method: str, cones: int | None) -> None:
    with pytest.raises(InputError, match=r"no flattening method 'best'; there are auto, bff-cones|cones with method"):
        reopen(sheet(), LIMITS, method=method, cones=cones)


def test_sensors_follow_and_none_is_lost_silently() -> None:
    one = opened(sheet()).skin
    material = load_material("carbon-grease-ecoflex")
    sensors = tuple(Sensor(f"C{k}", "P1", SPIRAL, x, 30.0, 0.0, k) for k, x in ((1, 25.0), (2, 80.0)))
    result = reopen(cut_path(replace(one, sensors=sensors), column(7)), LIMITS, material=material)
    assert [s.id for s in result.skin.sensors] == ["C1", "C2"]
    assert {s.piece for s in result.skin.sensors} == {p.id for p in result.skin.pieces}
    lid = replace(one, mesh=one.mesh, pieces=())
    gone = reopen(replace(lid, sensors=sensors), LIMITS)
    assert gone.lost == sensors and sum("was taken off" in text for text in texts(gone)) == 2


def test_lifted_sensors_come_back_when_the_skin_is_cut_the_next_time() -> None:
    one = opened(sheet()).skin
    sensors = tuple(Sensor(f"C{k}", "P1", SPIRAL, x, 30.0, 0.0, k) for k, x in ((1, 25.0), (2, 80.0)))
    none = replace(one, pieces=(), lifted=tuple(Lifted(sensor, one.pieces[0], place=k) for k, sensor in enumerate(sensors)))
    parted = reopen(cut_path(none, column(7)), LIMITS)
    assert parted.back == parted.skin.sensors and parted.skin.lifted == () and [s.id for s in parted.back] == ["C1", "C2"]
    assert len({s.piece for s in parted.back}) == 2
    again = auto_cut(none, LIMITS)
    assert [s.id for s in again.back] == ["C1", "C2"] and again.skin.lifted == ()


def test_sensors_come_back_in_the_order_they_had_however_they_went() -> None:
    """Three sensors whose order is not that of their channels, taken off one piece after the other."""
    V, F = cube()
    flat = opened(cut_path(skin_of(60 * V, F), [0, 1, 3, 2, 6, 7, 5, 4])).skin
    middle = flat.pieces[0].UV[flat.pieces[0].F[:2].ravel()].mean(axis=0)
    sensors = tuple(Sensor(id, "P1", SPIRAL, *middle, 0.0, channel) for id, channel in (("C3", 9), ("C1", 4), ("C2", 7)))
    closed = reopen(replace(flat, seams=NO_SEAMS, sensors=sensors[::2]), LIMITS).skin
    assert closed.sensors == () and [(each.sensor.id, each.place) for each in closed.lifted] == [("C3", 0), ("C2", 1)]
    # Another one between them was off before: it counts.
    before = replace(flat, seams=NO_SEAMS, sensors=sensors[::2], lifted=(Lifted(sensors[1], flat.pieces[0], place=1),))
    all_off = reopen(before, LIMITS).skin
    assert [(each.sensor.id, each.place) for each in all_off.lifted] == [("C3", 0), ("C1", 1), ("C2", 2)]
    back = reopen(replace(all_off, seams=flat.seams), LIMITS).skin
    assert back.lifted == () and [s.id for s in back.sensors] == ["C3", "C1", "C2"]
    one_off = replace(flat, sensors=sensors[::2], lifted=(replace(all_off.lifted[1], why="overlaps C9"),))
    assert [s.id for s in reopen(one_off, LIMITS).skin.sensors] == ["C3", "C1", "C2"]


def test_what_a_cut_takes_off_is_lifted() -> None:
    flat = opened(cut_path(skin_of(*cube()), [0, 1, 3, 2, 6, 7, 5, 4])).skin
    sensor = Sensor("C1", "P1", SPIRAL, *flat.pieces[0].UV[flat.pieces[0].F[:2].ravel()].mean(axis=0), 0.0, 1)
    closed = reopen(replace(flat, seams=NO_SEAMS, sensors=(sensor,)), LIMITS)
    (lifted,) = closed.skin.lifted
    assert closed.skin.sensors == () and lifted.sensor is sensor and lifted.piece is flat.pieces[0]
    still = reopen(closed.skin, LIMITS)
    assert [each.sensor for each in still.skin.lifted] == [sensor] and still.lost == still.back == ()


def test_degenerate_triangles_do_not_raise() -> None:
    skin = sheet()
    V = skin.mesh.V.copy()
    V[80:86] = V[80]
    result = reopen(replace(skin, mesh=Mesh(V, skin.mesh.F)), LIMITS)
    assert len(result.skin.pieces) + len(result.faults) >= 1
    needles = replace(skin, mesh=Mesh(skin.mesh.V * [1, 1e-12, 1e-12], skin.mesh.F))
    assert texts(reopen(needles, LIMITS)) == ["the object has no area, so it cannot lie flat: glue it to its neighbour"]


def test_progress_runs_to_the_end() -> None:
    seen: list[float] = []
    reopen(cut_path(sheet(), column(4)), LIMITS, progress=lambda part, label: seen.append(part))
    assert seen == sorted(seen) and seen[0] == 0 and seen[-1] == 1


# Automatic seams


def test_without_marks_they_are_those_of_the_command_line() -> None:
    mesh = object_mesh("cube")
    skin = Skin(mesh, Source("a.obj", "0" * 64, "mm", 1.0), NO_SEAMS, ())
    found = finish(mesh, find_seams(mesh, LIMITS), LIMITS)
    result = auto_cut(skin, LIMITS)
    np.testing.assert_array_equal(result.skin.seams, mesh.topology.E[found.cut & ~mesh.topology.is_boundary])
    np.testing.assert_array_equal(result.skin.pieces[0].UV, found.pieces[0][1].UV)


@pytest.mark.parametrize("name", ["human_finger", "robot_finger"])
def test_locked_seams_stay_and_forbidden_edges_are_not_cut(name: str) -> None:
    """One object as it is, and one large enough to be searched on a simplified mesh."""
    mesh = object_mesh(name)
    skin = Skin(mesh, Source("a.obj", "0" * 64, "mm", 1.0), NO_SEAMS, ())
    plain = auto_cut(skin, LIMITS).skin
    low, high = (int(k) for k in (np.argmin(mesh.V[:, 0]), np.argmax(mesh.V[:, 0])))
    mine = cut_path(skin, [low, high])
    locked = mesh.topology.edge_ids(mine.seams)
    forbidden = np.setdiff1d(mesh.topology.edge_ids(plain.seams)[::3], locked)
    result = auto_cut(forbid(lock(mine, locked), forbidden), LIMITS)
    cut = edge_mask(mesh, result.skin.seams)
    assert cut[locked].all() and not cut[forbidden].any()
    assert all(d.mean <= 4.05 and not d.flipped for d in result.distortions)
    assert sum(len(p.faces) for p in result.skin.pieces) == len(mesh.F)
    assert result.skin.marks is not None


def test_seams_run_where_they_are_wanted() -> None:
    mesh = object_mesh("cylinder")
    skin = Skin(mesh, Source("a.obj", "0" * 64, "mm", 1.0), NO_SEAMS, ())
    middle = mesh.V[mesh.F].mean(axis=1) - mesh.V.mean(axis=0)
    axis = int(
        np.argmin(
            [abs(np.ptp(np.delete(mesh.V, k, axis=1), axis=0)[0] - np.ptp(np.delete(mesh.V, k, axis=1), axis=0)[1]) for k in range(3)]
        )
    )
    across = next(k for k in range(3) if k != axis)

    def on_that_side(skin: Skin) -> float:
        ends = mesh.V[skin.seams].mean(axis=1) - mesh.V.mean(axis=0)
        along = np.abs(np.diff(mesh.V[skin.seams], axis=1)[:, 0, axis])
        return float(along[ends[:, across] > 0].sum() / along.sum())

    for sign in (1, -1):
        wanted = auto_cut(
            paint(paint(skin, np.flatnonzero(sign * middle[:, across] > 0), 1), np.flatnonzero(sign * middle[:, across] < 0), -1), LIMITS
        )
        assert (on_that_side(wanted.skin) > 0.9) == (sign > 0)


def test_everything_forbidden_is_refused_in_words() -> None:
    V, F = cube(3)
    skin = forbid(skin_of(30 * V, F), np.arange(162))
    with pytest.raises(RefusedError, match="the forbidden edges leave no seam that lays the 108 faces about face 0 flat; allow some"):
        auto_cut(skin, LIMITS)
