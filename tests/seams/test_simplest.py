"""Simplest pieces: compact, without darts, and by the same rules as any others."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from skinfab.errors import RefusedError
from skinfab.mesh.model import Mesh
from skinfab.seams.auto import Seams, find_seams
from skinfab.seams.cut import seam_length
from skinfab.seams.judge import Limits
from skinfab.seams.rules import EdgeRules
from skinfab.seams.simplest import regions
from skinfab.tolerances import OVERLAP_FRACTION

LIMITS = Limits(neck=1.0)


def bumpy(subdivisions: int = 2) -> Mesh:
    V, F = shapes.sphere(subdivisions)
    return Mesh(V * (10 + np.sin(3 * V[:, :1]) + V[:, 1:2] ** 2), F)


def no_rules(mesh: Mesh) -> EdgeRules:
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    return EdgeRules(np.ones(len(none)), none, none)


def inside(mesh: Mesh, seams: Seams) -> np.ndarray:
    """Seam edges with the same piece on both sides."""
    owner = np.empty(len(mesh.F), dtype=int)
    for k, (piece, _) in enumerate(seams.pieces):
        owner[piece.faces] = k
    EF = mesh.topology.EF
    return seams.cut & (EF[:, 1] >= 0) & (owner[EF[:, 0]] == owner[EF[:, 1]])


def simplest(mesh: Mesh, **options) -> Seams:
    seams = find_seams(mesh, LIMITS, neck=0.1, aim="simplest", **options)
    faces = np.sort(np.concatenate([piece.faces for piece, _ in seams.pieces]))
    np.testing.assert_array_equal(faces, np.arange(len(mesh.F)))
    for piece, verdict in seams.pieces:
        d = verdict.distortion
        assert piece.is_disk and verdict.accepted and d.flipped == 0 and d.mean <= LIMITS.mean
        assert d.overlap_mm2 <= OVERLAP_FRACTION * mesh.face_areas[piece.faces].sum()
    return seams


def test_a_cube_is_two_strips_of_three_sides() -> None:
    mesh = shapes.object_mesh("cube")
    seams = simplest(mesh)
    assert len(seams.pieces) == 2 and not inside(mesh, seams).any()
    assert seam_length(mesh, seams.cut) == pytest.approx(8 * 40)


def test_no_seam_ends_in_a_piece() -> None:
    mesh = bumpy()
    seams = simplest(mesh)
    assert 2 <= len(seams.pieces) <= 6 and not inside(mesh, seams).any()
    np.testing.assert_array_equal(seams.cut, simplest(mesh).cut)


def test_a_fine_mesh_takes_its_seams_from_a_coarse_one() -> None:
    mesh = bumpy(5)
    seams = simplest(mesh)
    assert len(mesh.F) > 20_000 and len(seams.pieces) <= 6
    assert mesh.edge_lengths[inside(mesh, seams)].sum() < 0.1 * seam_length(mesh, seams.cut)


def test_components_and_a_handle() -> None:
    V, F = shapes.sphere(1)
    W, G = shapes.torus(3, 1, 24, 10)
    mesh = Mesh(np.vstack([V, W + 9]), np.vstack([F, G + len(V)]))
    seams = simplest(mesh)
    assert all((piece.faces < len(F)).all() or (piece.faces >= len(F)).all() for piece, _ in seams.pieces)


def test_locked_seams_and_forbidden_edges() -> None:
    mesh = bumpy()
    first = simplest(mesh)
    EF = mesh.topology.EF
    above = mesh.V[mesh.F].mean(axis=1)[:, 2] > 0
    locked = above[EF[:, 0]] != above[EF[:, 1]]
    forbidden = first.cut & ~locked & (mesh.V[mesh.topology.E][:, :, 2] < 0).all(axis=1)
    assert forbidden.any()
    again = simplest(mesh, rules=replace(no_rules(mesh), locked=locked, forbidden=forbidden))
    assert again.cut[locked].all() and not again.cut[forbidden].any()
    rules = no_rules(mesh)
    with pytest.raises(RefusedError, match="forbidden edges leave no seam"):
        simplest(mesh, rules=replace(rules, forbidden=~rules.forbidden))


def test_regions_are_connected_and_heed_locked_seams() -> None:
    mesh = bumpy(3)
    above = mesh.V[mesh.F].mean(axis=1)[:, 2] > 0
    EF = mesh.topology.EF
    locked = above[EF[:, 0]] != above[EF[:, 1]]
    label = regions(mesh, 40, locked)
    assert label.min() == 0 and 20 <= label.max() + 1 <= 40
    across = label[EF[:, 0]] != label[EF[:, 1]]
    assert across[locked].all() and mesh.topology.face_components(across)[0] == label.max() + 1


def test_progress_rises_to_the_end() -> None:
    told: list[float] = []
    simplest(bumpy(), progress=told.append)
    assert told == sorted(told) and told and told[-1] <= 1
