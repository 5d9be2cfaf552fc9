"""Fewest pieces: one for each component or part between locked seams, whatever its topology, with little seam."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from skinfab.errors import RefusedError
from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology
from skinfab.seams.auto import Seams, find_seams
from skinfab.seams.cut import open_pieces, seam_length
from skinfab.seams.fewest import _one_disk
from skinfab.seams.judge import Limits
from skinfab.seams.rules import EdgeRules
from skinfab.seams.sheet import Surface, sheet_of
from skinfab.seams.weights import seam_weights
from skinfab.tolerances import OVERLAP_FRACTION

LIMITS = Limits(mean=4.05)


def bumpy(subdivisions: int = 3) -> Mesh:
    V, F = shapes.sphere(subdivisions)
    return Mesh(V * (10 + np.sin(3 * V[:, :1]) + V[:, 1:2] ** 2), F)


def no_rules(mesh: Mesh) -> EdgeRules:
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    return EdgeRules(np.ones(len(none)), none, none)


def fewest(mesh: Mesh, **options: object) -> Seams:
    """As many pieces as the mesh's parts, each held against the limits anew."""
    seams = find_seams(mesh, LIMITS, aim="fewest", **options)  # type: ignore[arg-type]
    for (piece, verdict), again in zip(seams.pieces, open_pieces(mesh, seams.cut), strict=True):
        np.testing.assert_array_equal(piece.F, again.F)
        d = verdict.distortion
        area = mesh.face_areas[piece.faces].sum()
        assert piece.is_disk and d.flipped == 0 and d.mean <= LIMITS.mean and d.overlap_mm2 <= OVERLAP_FRACTION * area
    return seams


@pytest.fixture(scope="module")
def sphere() -> tuple[Mesh, Seams]:
    mesh = bumpy()
    return mesh, fewest(mesh)


def test_one_piece_and_less_seam_than_usual(sphere: tuple[Mesh, Seams]) -> None:
    mesh, seams = sphere
    usual = find_seams(mesh, LIMITS)
    assert len(seams.pieces) == 1 <= len(usual.pieces)
    assert seam_length(mesh, seams.cut) < 0.95 * seam_length(mesh, usual.cut)


def test_a_looser_bound_needs_less_seam(sphere: tuple[Mesh, Seams]) -> None:
    mesh, seams = sphere
    looser = find_seams(mesh, Limits(mean=4.1), aim="fewest")
    assert len(looser.pieces) == 1 and seam_length(mesh, looser.cut) < 0.95 * seam_length(mesh, seams.cut)


def test_little_of_the_bound_is_left(sphere: tuple[Mesh, Seams]) -> None:
    ((_, verdict),) = sphere[1].pieces
    assert verdict.distortion.mean - 4 > 0.9 * (LIMITS.mean - 4)


def test_the_same_every_time(sphere: tuple[Mesh, Seams]) -> None:
    mesh, seams = sphere
    again = find_seams(Mesh(mesh.V.copy(), mesh.F.copy()), LIMITS, aim="fewest")
    np.testing.assert_array_equal(seams.cut, again.cut)
    np.testing.assert_array_equal(seams.pieces[0][1].UV, again.pieces[0][1].UV)


def test_hot_spots_are_cut_to_a_bound_of_their_own(sphere: tuple[Mesh, Seams]) -> None:
    mesh, seams = sphere
    ((_, free),) = seams.pieces
    bound = 4 + 0.8 * (free.distortion.p99 - 4)
    within = find_seams(mesh, replace(LIMITS, p99=bound), aim="fewest")
    ((_, held),) = within.pieces
    assert held.accepted and held.distortion.p99 <= bound
    assert seam_length(mesh, within.cut) < 1.6 * seam_length(mesh, seams.cut)


def test_a_fine_mesh_needs_no_more(sphere: tuple[Mesh, Seams]) -> None:
    """5120 triangles, its darts found on 1500."""
    fine = bumpy(4)
    seams = fewest(fine)
    assert len(seams.pieces) == 1
    mesh, coarse = sphere
    assert seam_length(fine, seams.cut) / np.sqrt(fine.area) < 1.25 * seam_length(mesh, coarse.cut) / np.sqrt(mesh.area)


def test_components_and_a_handle() -> None:
    V, F = shapes.sphere(2)
    W, G = shapes.torus(3, 1, 24, 10)
    seams = fewest(Mesh(np.vstack([V, W + 9]), np.vstack([F, G + len(V)])))
    assert [int(piece.faces[0]) for piece, _ in seams.pieces] == [0, len(F)]


def test_holes() -> None:
    V, F = shapes.holed()
    mesh = Mesh(np.column_stack([10 * V[:, :2], 3 * np.sin(3 * V[:, 0]) * np.sin(3 * V[:, 1])]), F)
    assert len(mesh.topology.boundary_loops) == 3
    assert len(fewest(mesh).pieces) == 1


def test_what_is_flat_is_not_cut() -> None:
    assert not fewest(Mesh(*shapes.wavy(10, 0.0))).cut.any()


@pytest.mark.parametrize("subdivisions", [3, 4])
def test_locked_seams_part_and_forbidden_edges_stay(subdivisions: int) -> None:
    """The equator is locked, the lower half's first seams are forbidden; on the mesh itself and by way of a coarse one."""
    mesh = bumpy(subdivisions)
    E, low = mesh.topology.E, mesh.V[:, 2] < -1e-9
    EF = mesh.topology.EF
    above = mesh.V[mesh.F].mean(axis=1)[:, 2] > 0
    locked = above[EF[:, 0]] != above[EF[:, 1]]
    rules = replace(no_rules(mesh), locked=locked)
    first = fewest(mesh, rules=rules)
    assert len(first.pieces) == 2 and first.cut[locked].all()
    rules = replace(rules, forbidden=first.cut & ~locked & low[E].any(axis=1))
    assert rules.forbidden.any()
    again = fewest(mesh, rules=rules)
    assert again.cut[locked].all() and not again.cut[rules.forbidden].any()


def test_a_painted_part_is_avoided() -> None:
    mesh = bumpy(2)
    seams = fewest(mesh)
    avoided = mesh.V[mesh.topology.E].mean(axis=1)[:, 0] > 0
    dear = fewest(mesh, rules=replace(no_rules(mesh), factor=np.where(avoided, 4.0, 1.0)))
    assert mesh.edge_lengths[dear.cut & avoided].sum() < mesh.edge_lengths[seams.cut & avoided].sum()


def test_all_forbidden_is_refused() -> None:
    mesh = bumpy(2)
    rules = no_rules(mesh)
    with pytest.raises(RefusedError, match="forbidden edges leave no seam"):
        find_seams(mesh, LIMITS, rules=replace(rules, forbidden=~rules.forbidden), aim="fewest")


def test_a_large_piece_is_parted_for_the_bed() -> None:
    mesh, bed = Mesh(*shapes.cylinder_sheet(24, 30, radius=30, height=360)), Limits(size=(200, 200))
    seams = find_seams(mesh, bed, aim="fewest")
    assert 2 <= len(seams.pieces) <= len(find_seams(mesh, bed).pieces)
    assert all(verdict.accepted for _, verdict in seams.pieces)


def test_progress_rises_and_can_end_it() -> None:
    mesh = bumpy(2)
    told: list[float] = []

    def report(done: float) -> None:
        told.append(done)
        if done > 0.3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        find_seams(mesh, LIMITS, aim="fewest", progress=report)
    assert told == sorted(told) and len(told) >= 3


@pytest.mark.parametrize("factor", [2.0**-9, 10.0, 25.4])
def test_neither_the_unit_nor_the_place_matters(sphere: tuple[Mesh, Seams], factor: float) -> None:
    mesh, seams = sphere
    other = find_seams(Mesh(factor * mesh.V + [factor, 0, -3], mesh.F), LIMITS, aim="fewest")
    np.testing.assert_array_equal(other.cut, seams.cut)


def test_flat_sides_of_any_size_are_coarsened_to_sound_triangles() -> None:
    """Of 20 m: decimated as it was, it had 57 triangles without area, and no layout could be begun."""
    V, F = shapes.object_mesh("cube").V, shapes.object_mesh("cube").F
    for _ in range(4):
        topology = Topology(F)
        a, b, c = F.T
        ab, bc, ca = (topology.FE + len(V)).T
        F = np.concatenate([np.stack(corners, axis=1) for corners in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
        V = np.vstack([V, V[topology.E].mean(axis=1)])
    seams = find_seams(Mesh(1024 * V, F), LIMITS, aim="fewest")
    assert len(seams.pieces) == 1


def test_seams_that_part_a_surface_or_leave_a_hole_are_mended_to_a_disk() -> None:
    mesh = bumpy(2)
    topology = mesh.topology
    surface = Surface(mesh, seam_weights(mesh), np.zeros(len(topology.E), dtype=bool))
    first, second = topology.EF.T
    for rings in ((0.5,), (0.5, -0.5)):
        cut = np.zeros(len(topology.E), dtype=bool)
        for height in rings:
            above = mesh.V[mesh.F].mean(axis=1)[:, 2] > 10 * height
            cut |= above[first] != above[second]
        assert sheet_of(surface, cut) is None
        mended = _one_disk(surface, cut)
        assert sheet_of(surface, mended) is not None and (cut & ~mended).sum() == len(rings)
    whole = np.zeros(len(topology.E), dtype=bool)
    assert sheet_of(surface, _one_disk(surface, whole)) is not None
