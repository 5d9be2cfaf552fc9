"""Moulds are read back from their STL by another library; the volumes are worked out without ours."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import igl
import numpy as np
import pytest
import shapely
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from skinfab.errors import InputError, RefusedError
from skinfab.material import load_material
from skinfab.mould import FREEBOARD_MM, CastingMould, casting_mould, is_watertight, write_mould
from skinfab.mould_plan import cavity_region, mould_fits, mould_plan
from skinfab.pieces import Piece
from skinfab.wire_exits import WirePad

MATERIAL = load_material()
#: The same with upright walls, where a length by hand is to be exact.
UPRIGHT = replace(MATERIAL, mould=replace(MATERIAL.mould, draft_deg=0.0))


def piece_from_cells(cells: list[tuple[int, int]], size: float, *, joins: list[tuple[int, int]] | None = None) -> Piece:
    """Squares laid edge to edge; `joins` names which pairs share vertices (all neighbours if None)."""
    UV, F = [], []
    owner: dict[tuple[int, tuple[int, int]], int] = {}
    group = list(range(len(cells)))
    joined = {frozenset(j) for j in joins} if joins is not None else None
    for k, (cx, cy) in enumerate(cells):
        ids = []
        for dx, dy in ((0, 0), (1, 0), (1, 1), (0, 1)):
            at = (cx + dx, cy + dy)
            shared = None
            for j in group[:k]:
                near = abs(cells[j][0] - cx) + abs(cells[j][1] - cy) == 1
                if (j, at) in owner and near and (joined is None or frozenset((j, k)) in joined):
                    shared = owner[(j, at)]
            if shared is None:
                UV.append(at)
                shared = len(UV) - 1
            owner[(k, at)] = shared
            ids.append(shared)
        F += [[ids[0], ids[1], ids[2]], [ids[0], ids[2], ids[3]]]
    flat = np.array(UV, dtype=float) * size
    return make_piece(flat - flat.min(axis=0), np.array(F))


def make_piece(UV: NDArray[np.float64], F: NDArray[np.int64]) -> Piece:
    return Piece("P1", np.arange(len(F)), np.arange(len(UV)), F, UV)


def piece_from_outline(outline: NDArray[np.float64]) -> Piece:
    """Ear-free triangulation of a simple polygon: its constrained Delaunay triangles."""
    triangles = shapely.constrained_delaunay_triangles(shapely.Polygon(outline))
    index = {tuple(p): k for k, p in enumerate(outline)}
    F = np.array([[index[tuple(c)] for c in np.asarray(shapely.orient_polygons(t).exterior.coords)[:3]] for t in triangles.geoms])
    return make_piece(outline - outline.min(axis=0), F)


def dart_piece(opening: float) -> Piece:
    """A 60 x 40 plate with a 30 mm dart from its upper edge, `opening` wide at the edge."""
    return piece_from_outline(np.array([[0, 0], [60, 0], [60, 40], [30 + opening / 2, 40], [30, 10], [30 - opening / 2, 40], [0, 40.0]]))


def noisy_outline() -> NDArray[np.float64]:
    rng = np.random.default_rng(7)
    angle = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    radius = 40 + 6 * np.sin(5 * angle) + rng.normal(0, 0.3, 300)
    return radius[:, None] * np.c_[np.cos(angle), np.sin(angle)]


PIECES = {
    "rectangle": piece_from_cells([(0, 0), (1, 0)], 20.0),
    "L": piece_from_cells([(0, 0), (1, 0), (0, 1), (0, 2)], 15.0),
    "cube net": piece_from_cells([(1, 0), (1, 1), (1, 2), (1, 3), (0, 2), (2, 2)], 22.0),
    # A ring of squares that is open between the first and the last: the two lie edge on edge.
    "closed dart": piece_from_cells(
        [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)], 15.0, joins=[(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (1, 4)]
    ),
    # Two arms whose ends meet in one corner point.
    "corner contact": piece_from_cells([(1, 0), (0, 0), (0, 1), (0, 2), (1, 2), (2, 2), (2, 1)], 10.0),
    "sharp dart": dart_piece(4.0),
    "noisy": piece_from_outline(noisy_outline()),
}


def pad_at(x: float, y: float, *, terminal: int = 1) -> WirePad:
    return WirePad("C1", terminal, np.array([x, y]))


def read_back(mould: CastingMould, folder: Path) -> trimesh.Trimesh:
    write_mould(mould, folder / "P1.stl")
    return trimesh.load_mesh(folder / "P1.stl")


def filled(solid: trimesh.Trimesh, points: list[list[float]]) -> NDArray[np.bool_]:
    """Whether each point is inside the plastic, by the winding number."""
    return igl.fast_winding_number(np.array(solid.vertices), np.array(solid.faces, dtype=np.int64), np.array(points)) > 0.5


@pytest.mark.parametrize("name", PIECES)
def test_stl_is_watertight_and_its_cavity_is_area_times_depth(name: str, tmp_path: Path) -> None:
    piece = PIECES[name]
    pads = [pad_at(*piece.UV.mean(axis=0)), pad_at(*piece.UV[0], terminal=2)]
    mould = casting_mould(piece, material=MATERIAL, pads=pads)
    solid = read_back(mould, tmp_path)
    assert solid.is_watertight and solid.is_winding_consistent and solid.volume > 0 and mould.watertight
    assert len(solid.split(only_watertight=False)) == 1

    # The cavity by slices: at each height the plate's hollow is the inside of the wall's section.
    area = np.abs(igl.doublearea(piece.UV, piece.F)).sum() / 2
    heights = np.linspace(mould.floor_z, mould.fill_z, 8)[1:-1]
    hollow = []
    for z in heights:
        section = solid.section(plane_origin=[0, 0, z], plane_normal=[0, 0, 1])
        loops = [shapely.Polygon(loop[:, :2]) for loop in section.discrete]
        plastic = loops[0]
        for loop in loops[1:]:
            plastic = plastic ^ loop
        inside = shapely.union_all(loops) - plastic
        # Pockets between two outer walls are hollow too, but they hold no silicone.
        seeds = shapely.points(piece.UV[piece.F].mean(axis=1))
        hollow.append(sum(part.area for part in shapely.get_parts(inside) if shapely.contains(part, seeds).any()))
    # The walls lean about half the depth: the sections grow, and what the lower ones lack the upper ones have.
    assert (np.diff(hollow) > 0).all() and np.mean(hollow) == pytest.approx(area, rel=0.005)
    mitred = [float(cavity_region(piece).buffer((z - heights.mean()) * np.tan(np.radians(2)), join_style="mitre").area) for z in heights]
    np.testing.assert_allclose(hollow, mitred, rtol=1e-3)
    assert mould.cavity_ml == pytest.approx(area * 2.5 / 1000, rel=0.005)
    assert mould.top_z - mould.fill_z == FREEBOARD_MM
    assert solid.bounds[1, 2] == pytest.approx(mould.top_z, abs=1e-5) and solid.bounds[0, 2] == 0


def test_volume_by_hand(tmp_path: Path) -> None:
    # 40 x 20 piece, wall 1.6, plate 6 beyond it; grooves 0.8 wide and 0.8 deep, an L of 6 + 6 + 0.8/2 corner.
    mould = casting_mould(PIECES["rectangle"], material=UPRIGHT)
    outer, plate = 43.2 * 23.2, (43.2 + 12) * (23.2 + 12)
    groove = 2 * 6.4 * 0.8 - 0.8**2
    by_hand = plate * 1.6 + (outer - 800) * 3.0 - 3 * groove * 0.8
    assert read_back(mould, tmp_path).volume == pytest.approx(by_hand, rel=1e-4)
    np.testing.assert_allclose(mould.marks, [[-4.6, -4.6], [44.6, -4.6], [-4.6, 24.6]], atol=1e-9)


@pytest.mark.parametrize("draft", [0.5, 2.0, 5.0, 20.0])
def test_volume_of_a_drafted_cavity_in_closed_form(draft: float) -> None:
    # A frustum of a 40 x 20 plate: the integral of (40 + 2t)(20 + 2t), t from -h to h at half the depth's lean h.
    leaning = replace(MATERIAL, mould=replace(MATERIAL.mould, draft_deg=draft))
    h = 1.25 * np.tan(np.radians(draft))
    mould = casting_mould(PIECES["rectangle"], material=leaning)
    assert mould.cavity_ml * 1000 == pytest.approx(2.5 * (40 * 20 + 4 / 3 * h**2), rel=1e-5)  # the grid is 1e-4 mm
    assert mould.cavity_ml * 1000 == pytest.approx(40 * 20 * 2.5, rel=0.005)


@pytest.mark.parametrize("name", PIECES)
def test_the_cast_comes_out(name: str, tmp_path: Path) -> None:
    # No face of the mould looks down but its underside, and every wall round the silicone leans by the draft.
    piece = PIECES[name]
    ring = np.vstack([piece.outline, piece.outline[:1]])
    mould = casting_mould(piece, material=MATERIAL, lips=[ring[:3]], pads=[pad_at(*piece.UV.mean(axis=0))])
    solid = read_back(mould, tmp_path)
    real = solid.area_faces > 1e-4
    down = solid.face_normals[:, 2] < -1e-3
    assert (solid.triangles_center[real & down, 2] < 1e-6).all()
    leaning = np.degrees(np.arcsin(solid.face_normals[real, 2]))
    middle = solid.triangles_center[real]
    slanted = (leaning > 0.1) & (leaning < 89)
    assert slanted.any()
    share = np.average(np.abs(leaning[slanted] - 2.0) < 0.3, weights=solid.area_faces[real][slanted])
    assert share > 0.97, share
    assert ((middle[slanted, 2] > mould.floor_z) & (middle[slanted, 2] < mould.top_z)).all()


def test_lips_hold_their_volume_beside_leaning_walls() -> None:
    for piece in PIECES.values():
        ring = np.vstack([piece.outline, piece.outline[:1]])
        for draft in (2.0, 10.0):
            leaning = replace(MATERIAL, mould=replace(MATERIAL.mould, draft_deg=draft))
            mould = casting_mould(piece, material=leaning, lips=[ring[:3]])
            assert mould.cavity_ml * 1000 == pytest.approx(piece.area * 2.5, rel=0.005)


def test_a_jagged_outline_keeps_its_volume() -> None:
    # Spikes gain more by a lean outwards than they lose inwards: leaning about the outline itself holds 1.4 % too much.
    angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    radius = 2 + 4.0 * (np.arange(16) % 2)
    piece = piece_from_outline(radius[:, None] * np.c_[np.cos(angle), np.sin(angle)])
    cavity, h = cavity_region(piece), 1.25 * np.tan(np.radians(10))
    naive = sum(w * cavity.buffer(by, join_style="mitre").area for w, by in ((1, -h), (4, 0), (1, h))) / 6
    assert naive > 1.005 * piece.area
    leaning = replace(MATERIAL, mould=replace(MATERIAL.mould, draft_deg=10.0))
    mould = casting_mould(piece, material=leaning)
    assert not any("upright" in note for note in mould.warnings)
    assert mould.cavity_ml * 1000 == pytest.approx(piece.area * 2.5, rel=0.002)


def test_a_sliver_gets_upright_walls_and_says_so() -> None:
    # At 2 degrees the floor of a strip 0.08 mm wide would be gone.
    strip = piece_from_cells([(0, 0)], 1.0)
    strip = make_piece(strip.UV * [20, 0.08], strip.F)
    mould = casting_mould(strip, material=MATERIAL)
    assert mould.watertight and mould.cavity_ml * 1000 == pytest.approx(20 * 0.08 * 2.5, rel=0.005)
    assert "too fine for leaning walls, so they are upright" in mould.warnings[-1]


def test_a_draft_that_eats_the_wall_is_refused() -> None:
    leaning = replace(MATERIAL, mould=replace(MATERIAL.mould, draft_deg=30.0))
    with pytest.raises(InputError, match=r"mould\.draft_deg is 30.*lower it to 24"):
        casting_mould(PIECES["rectangle"], material=leaning)
    casting_mould(PIECES["rectangle"], material=replace(MATERIAL, mould=replace(MATERIAL.mould, draft_deg=24.0)))
    with pytest.raises(InputError, match="must be below 90"):
        casting_mould(PIECES["rectangle"], material=replace(MATERIAL, mould=replace(MATERIAL.mould, draft_deg=90.0)))


def test_marks_are_grooves_where_they_are_said_to_be(tmp_path: Path) -> None:
    mould = casting_mould(PIECES["L"], material=MATERIAL)
    solid = read_back(mould, tmp_path)
    for x, y in mould.marks:
        assert filled(solid, [[x, y, 0.4]])[0] and not filled(solid, [[x, y, 1.2]])[0]
        assert filled(solid, [[x - np.sign(x) * 1.0, y - np.sign(y) * 1.0, 1.2]])[0]  # beside the groove


def test_slots_let_the_wire_out_above_the_silicone_only(tmp_path: Path) -> None:
    mould = casting_mould(PIECES["rectangle"], material=MATERIAL, pads=[pad_at(3.0, 12.0)])
    solid = read_back(mould, tmp_path)
    in_wall = [-0.8, 12.0]
    assert not filled(solid, [[*in_wall, mould.fill_z + 0.25]])[0]
    assert filled(solid, [[*in_wall, mould.fill_z - 0.05]])[0]
    assert filled(solid, [[-0.8, 14.0, mould.fill_z + 0.25]])[0]


def test_slot_does_not_open_into_a_dart(tmp_path: Path) -> None:
    mould = casting_mould(PIECES["sharp dart"], material=MATERIAL, pads=[pad_at(27.0, 20.0)])
    plain = casting_mould(PIECES["sharp dart"], material=MATERIAL)
    solid = read_back(mould, tmp_path)
    dart_wall = [[30.0, y, mould.fill_z + 0.25] for y in (16.0, 20.0, 24.0)]
    assert filled(solid, dart_wall).all()
    assert solid.volume < read_back(plain, tmp_path).volume - 0.2


def test_a_lip_gives_way_to_a_slot(tmp_path: Path) -> None:
    lips = [np.array([[0.0, 0.0], [40.0, 0.0]])]
    whole = casting_mould(PIECES["rectangle"], material=UPRIGHT, lips=lips)
    mould = casting_mould(PIECES["rectangle"], material=UPRIGHT, lips=lips, pads=[pad_at(12.0, 3.0)])
    solid = read_back(mould, tmp_path)
    assert solid.is_watertight and mould.cavity_ml == pytest.approx(2.0, rel=1e-4)
    # 1.2 mm of slot and a wall of 1.6 mm either side of it: that much of the 4 x 0.5 mm lip is wall instead.
    assert (whole.lip_ml - mould.lip_ml) * 1000 == pytest.approx((1.2 + 2 * 1.6) * 4 * 0.5, rel=0.01)
    heights = (mould.fill_z - 0.2, mould.fill_z + 0.25)
    along = [[[12.0, y, z] for y in (-0.5, -2.0, -4.8)] for z in heights]
    assert filled(solid, along[0]).all() and not filled(solid, along[1]).any()
    assert filled(solid, [[12.0 + dx, -2.0, heights[0]] for dx in (-1.4, 1.4)]).all()
    assert not filled(solid, [[12.0 + dx, -2.0, heights[0]] for dx in (-2.6, 2.6)]).any()
    (slot,) = mould.wire_slots
    np.testing.assert_allclose([slot.at, slot.out], [[12, 0], [12, -5.6]], atol=1e-3)


def test_outer_size() -> None:
    # 40 x 20 piece, wall 1.6 and plate 6 on either side; floor 1.6, silicone 2.5, 0.5 above it.
    assert casting_mould(PIECES["rectangle"], material=MATERIAL).size_mm == (55.2, 35.2, 4.6)


def test_wall_fills_a_dart_and_a_thin_one_is_named(tmp_path: Path) -> None:
    wide = casting_mould(dart_piece(4.0), material=MATERIAL)
    assert filled(read_back(wide, tmp_path), [[30.0, 30.0, 3.0]])[0]
    # 4 mm over 30 mm: thinner than 0.4 mm over the last 3 mm. 1 mm: over the last 12 mm.
    narrow = casting_mould(dart_piece(1.0), material=MATERIAL)
    found = re.search(r"1 dart narrower than 0.4 mm over ([\d.]+) mm", narrow.warnings[0])
    assert found and float(found[1]) == pytest.approx(12, abs=0.4)  # a bead ends half its width early
    assert casting_mould(dart_piece(12.0), material=MATERIAL).warnings == ()


def test_closed_dart_is_cast_in_one_and_said_so() -> None:
    (note,) = casting_mould(PIECES["closed dart"], material=MATERIAL).warnings
    assert "touches itself over 15.0 mm" in note


def test_lip_is_a_shelf_of_the_top_layers_thickness(tmp_path: Path) -> None:
    # Along the lower edge of a 40 x 20 plate: 4 mm wide, 0.5 mm thick, a quarter disk of wall cut off either end.
    piece = PIECES["rectangle"]
    mould = casting_mould(piece, material=UPRIGHT, lips=[np.array([[0.0, 0.0], [40.0, 0.0]])])
    solid = read_back(mould, tmp_path)
    assert solid.is_watertight and mould.cavity_ml == pytest.approx(2.0, rel=1e-4)
    assert mould.lip_ml * 1000 == pytest.approx((40 * 4 - 2 * np.pi * 1.6**2 / 4) * 0.5, rel=0.01)
    heights = np.array([mould.fill_z - 0.6, mould.fill_z - 0.4, mould.top_z - 0.1])
    shelf, beyond = ([[20.0, y, z] for z in heights] for y in (-2.0, -4.8))
    assert filled(solid, shelf).tolist() == [True, False, False]
    assert filled(solid, beyond).all()
    # No film of plastic where the lip joins the piece.
    assert not filled(solid, [[20.0, y, mould.fill_z - 0.2] for y in np.linspace(-0.2, 0.2, 41)]).any()
    plain = casting_mould(piece, material=UPRIGHT)
    assert plain.lip_ml == 0 and mould.marks[0, 1] == pytest.approx(plain.marks[0, 1] - 4)


def test_lip_keeps_a_wall_from_the_other_flank_of_a_dart(tmp_path: Path) -> None:
    piece = dart_piece(12.0)
    mould = casting_mould(piece, material=MATERIAL, lips=[np.array([[36.0, 40.0], [30.0, 10.0]])])
    assert read_back(mould, tmp_path).is_watertight and 0 < mould.lip_ml * 1000 < 30.6 * 4 * 0.5
    # At y = 38 the dart is 11.2 mm wide: 4 mm of lip from the right, plastic before the left flank.
    row = [[x, 38.0, mould.fill_z - 0.2] for x in (33.0, 31.0, 30.0, 26.0, 25.0)]
    assert filled(read_back(mould, tmp_path), row).tolist() == [False, True, True, True, True]
    narrow = casting_mould(dart_piece(2.0), material=MATERIAL, lips=[np.array([[31.0, 40.0], [30.0, 10.0]])])
    assert narrow.lip_ml == 0 and "room along 0 of 30 mm" in narrow.warnings[-1]


def test_every_lip_on_every_piece_is_sound(tmp_path: Path) -> None:
    for piece in PIECES.values():
        ring = np.vstack([piece.outline, piece.outline[:1]])
        runs = [ring[k : k + 2] for k in range(len(ring) - 1)] if len(ring) < 50 else [ring[:40], ring[100:160]]
        mould = casting_mould(piece, material=MATERIAL, lips=runs)
        assert read_back(mould, tmp_path).is_watertight
        assert mould.cavity_ml * 1000 == pytest.approx(piece.area * 2.5, rel=0.005)
        assert mould.lip_ml > 0
        # A lip leaves no film of plastic behind: it adds no dart that cannot be printed.
        plain = [note for note in casting_mould(piece, material=MATERIAL).warnings if "narrower" in note]
        assert [note for note in mould.warnings if "narrower" in note] == plain


def test_same_mould_same_bytes(tmp_path: Path) -> None:
    for name in ("a.stl", "b.stl"):
        write_mould(casting_mould(PIECES["noisy"], material=MATERIAL), tmp_path / name)
    assert (tmp_path / "a.stl").read_bytes() == (tmp_path / "b.stl").read_bytes()


def test_overlapping_piece_is_refused() -> None:
    # Three wings of a fan wound past a full turn: the outline's area counts the overlap twice.
    angle = np.linspace(0, 2.6 * np.pi, 14)
    UV = np.vstack([[0, 0], 20 * np.c_[np.cos(angle), np.sin(angle)]])
    F = np.array([[0, k, k + 1] for k in range(1, 14)])
    with pytest.raises(RefusedError, match="check the flat piece for overlaps"):
        casting_mould(make_piece(UV - UV.min(axis=0), F), material=MATERIAL)


@pytest.mark.parametrize("field", ["wall", "floor", "mark"])
def test_unprintable_dimensions_are_refused(field: str) -> None:
    thin = replace(MATERIAL, mould=replace(MATERIAL.mould, **{field: 0.0}))
    with pytest.raises(InputError, match=rf"mould\.{field} is 0 mm"):
        casting_mould(PIECES["L"], material=thin)


def test_depth_must_be_positive() -> None:
    with pytest.raises(InputError, match="must be positive"):
        casting_mould(PIECES["L"], material=MATERIAL, depth=0)


def test_watertight_check_can_fail() -> None:
    box = trimesh.creation.box().faces.astype(np.int64)
    assert is_watertight(box)
    assert not is_watertight(box[1:])
    assert not is_watertight(np.vstack([box[1:], box[:1, ::-1]]))
    assert not is_watertight(np.zeros((0, 3), np.int64))


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6))
def test_what_the_bed_must_have_is_known_from_the_outline(seed: int) -> None:
    """No mould is larger than foretold, wherever its lips are."""
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0, 2 * np.pi, 5))
    if (np.diff(angle, append=angle[0] + 2 * np.pi) > 3).any():
        return
    uv = rng.uniform(20, 60, 5)[:, None] * np.c_[np.cos(angle), np.sin(angle)]
    uv = np.vstack([uv, [[0, 0]]]) - uv.min(axis=0)
    piece = Piece("P1", np.arange(5), np.arange(6), np.array([[5, k, (k + 1) % 5] for k in range(5)]), uv)
    mould = replace(load_material().mould, draft_deg=0.0)
    ring = np.vstack([piece.outline, piece.outline[:2]])
    for lips in ([ring[:5]], [ring[k : k + 2] for k in rng.permutation(5)[:3]]):
        x0, y0, x1, y1 = mould_plan(piece, mould=mould, depth=2.5, lips=lips).plate.bounds
        assert not mould_fits(piece.outline, mould=mould, bed=(x1 - x0 - 0.01, 1e3))
        assert not mould_fits(piece.outline, mould=mould, bed=(1e3, y1 - y0 - 0.01))


def test_a_lip_round_a_sharp_corner_reaches_far() -> None:
    # At 60 degrees both the lip and the wall round it reach twice their width past the corner.
    uv = np.array([[0.0, 0], [40, 0], [20, 20 * np.sqrt(3)]])
    piece = Piece("P1", np.arange(1), np.arange(3), np.array([[0, 1, 2]]), uv)
    mould = replace(load_material().mould, draft_deg=0.0)
    tip = [np.vstack([piece.outline[1:], piece.outline[:1]])]
    _, y0, _, y1 = mould_plan(piece, mould=mould, depth=2.5, lips=tip).plate.bounds
    assert y1 - uv[:, 1].max() == pytest.approx(mould.mark + 2 * (mould.lip + mould.wall), abs=1e-3)
    # The side below could get a lip too, as far as is known before there are seams.
    need = y1 - y0 + mould.lip
    assert mould_fits(uv, mould=mould, bed=(200, need + 0.7)) and not mould_fits(uv, mould=mould, bed=(200, need - 0.01))
