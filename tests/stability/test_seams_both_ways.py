"""Where cutting fails, with usual and with fewest pieces: each test first shows the plain method fail, then what is done instead."""

from dataclasses import replace

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.flatten.distortion import measure
from skinfab.flatten.methods import method
from skinfab.flatten.neck import find_neck
from skinfab.mesh.inspect import inspect
from skinfab.mesh.model import Mesh
from skinfab.mesh.repair import clean
from skinfab.seams import auto
from skinfab.seams.auto import Aim, Seams, find_seams
from skinfab.seams.cut import open_pieces, seam_length
from skinfab.seams.disk import cut_to_disk
from skinfab.seams.graph import edge_graph, shortest_tree, trace
from skinfab.seams.judge import Limits
from skinfab.seams.manual import cut_along
from skinfab.seams.weights import seam_weights
from skinfab.tolerances import OVERLAP_FRACTION

AIMS: tuple[Aim, ...] = ("usual", "fewest")
LIMITS = Limits(neck=4.0)

both = pytest.mark.parametrize("aim", AIMS)


def accepted(mesh: Mesh, seams, limits: Limits = LIMITS) -> bool:
    """Every face once, in disks that keep to the limits by what is measured here."""
    covered = np.sort(np.concatenate([piece.faces for piece, _ in seams.pieces]))
    good = bool((covered == np.arange(len(mesh.F))).all())
    for piece, verdict in seams.pieces:
        d = measure(mesh.V[piece.vertices], piece.F, verdict.UV, topology=piece.topology)
        neck = find_neck(piece.F, verdict.UV, limits.neck, topology=piece.topology)
        flat = d.flipped == 0 and d.overlap_mm2 <= OVERLAP_FRACTION * mesh.face_areas[piece.faces].sum()
        good = good and piece.is_disk and flat and d.mean <= limits.mean and neck is None
    return good


def dumb_bell(waist: float) -> Mesh:
    """Two bulbs of 8 mm radius, open at their ends, on a waist of that radius."""
    rows, length = 40, 60.0
    V, F = shapes.cylinder_sheet(24, rows, 1, length)
    V[:, :2] *= waist + 8 * (1 - np.exp(-(((V[:, 2:] - length / 2) / 8) ** 2)))
    return Mesh(V, F)


@both
def test_neck_collapse(aim: Aim) -> None:
    """A disk, no flip, no overlap, d within the bound: and its halves hang on less silicone than goes round the waist, which tears."""
    mesh = dumb_bell(0.5)
    ((piece, verdict),) = find_seams(mesh, Limits(), aim=aim).pieces
    neck = find_neck(piece.F, verdict.UV, 4.0, topology=piece.topology)
    assert verdict.accepted and neck is not None and neck.width < np.pi  # all round the waist
    seams = find_seams(mesh, LIMITS, aim=aim)
    assert accepted(mesh, seams) and len(seams.pieces) == 2
    wide = dumb_bell(2.5)  # 15 mm round the waist hold
    assert len(find_seams(wide, LIMITS, aim=aim).pieces) == 1


@both
def test_seams_without_length(aim: Aim) -> None:
    """Some vertices lie on their neighbours: edges without length, which a search by length takes for nothing."""
    V, F = shapes.sphere(2)
    mesh = Mesh(20 * V, F)
    far = np.array([20, 60, 100, 140])
    one_ring = [int(mesh.topology.E[(mesh.topology.E == v).any(axis=1)][0].sum() - v) for v in far.tolist()]
    W = mesh.V.copy()
    W[far] = W[one_ring]
    flat = Mesh(W, F)
    assert (flat.edge_lengths == 0).sum() == len(far) and (flat.face_areas == 0).sum() == 2 * len(far)
    # By length alone each of these is cut for nothing, and its triangles have no d.
    assert seam_length(flat, flat.edge_lengths == 0) == 0 and (seam_weights(flat) > 0).all()
    sound, _ = clean(flat)
    assert (sound.edge_lengths > 0).all() and len(sound.F) == len(F) - 2 * len(far)
    seams = find_seams(sound, LIMITS, aim=aim)
    assert accepted(sound, seams) and len(seams.pieces) == 1
    assert seam_length(sound, seams.cut) < 1.3 * seam_length(mesh, find_seams(mesh, LIMITS, aim=aim).cut)


def two_cones() -> Mesh:
    """Two open cones that touch in their tips, which are one vertex: 0."""
    n = 24
    a = 2 * np.pi * np.arange(n) / n
    rings = [np.stack([r * np.cos(a), r * np.sin(a), np.full(n, s * r)], axis=1) for s in (1, -1) for r in (8.0, 16.0)]
    F = []
    for k, sign in ((1, 1), (1 + 2 * n, -1)):
        for i in range(n):
            j = (i + 1) % n
            three = [[0, k + i, k + j], [k + i, k + n + i, k + n + j], [k + i, k + n + j, k + j]]
            F += [f[::sign] for f in three]
    return Mesh(np.vstack([np.zeros((1, 3)), *rings]), np.array(F))


@both
def test_seam_through_a_vertex_where_sheets_touch(aim: Aim) -> None:
    """Cleaning doubles the vertex. By place alone the nearest of the two is taken, on whichever sheet: half the cuts lead nowhere."""
    file = two_cones()
    assert inspect(file.V, file.F).nonmanifold_vertices == 1
    mesh, _ = clean(file)
    n = 24
    up, down = [1 + n, 1, 0], [1 + 3 * n, 1 + 2 * n, 0]
    tips = np.flatnonzero((mesh.V == 0).all(axis=1))
    nearest = int(np.argmin(np.linalg.norm(mesh.V, axis=1)))
    inner = [int(np.argmin(np.linalg.norm(mesh.V - file.V[way[1]], axis=1))) for way in (up, down)]
    naive = mesh.topology.edge_ids(np.array([[v, nearest] for v in inner]))
    assert len(tips) == 2 and sorted(naive >= 0) == [False, True]
    cut = cut_along(mesh, [file.V[up], file.V[down]])
    assert cut.sum() == 4 and all(piece.is_disk for piece in open_pieces(mesh, cut))
    with pytest.raises(InputError, match="cut 1: vertices 0 and 1 lie on different components"):
        cut_along(mesh, [file.V[[1, 1 + 2 * n]]], numbers=np.array([0, 1])[(mesh.V[:, 2] < 0).astype(int)])
    seams = find_seams(mesh, LIMITS, aim=aim)
    assert accepted(mesh, seams) and len(seams.pieces) == 2
    assert seam_length(mesh, seams.cut) == pytest.approx(2 * 16 * np.sqrt(2))


@both
def test_tiny_components(aim: Aim) -> None:
    """Ten specks of a scan beside a ball: areas over 1e5 times smaller, on one scale with it all seams would be its own."""
    V, F = shapes.sphere(2)
    W, G = shapes.sphere(0)
    parts = [(20 * V, F)] + [(0.05 * W + [30 + 0.5 * k, 0, 0], G) for k in range(10)]
    starts = np.cumsum([0] + [len(v) for v, _ in parts[:-1]])
    mesh = Mesh(np.vstack([v for v, _ in parts]), np.vstack([f + k for (_, f), k in zip(parts, starts, strict=True)]))
    small = mesh.face_areas[len(F) :]
    assert small.sum() < 1e-4 * mesh.area and 0.1 * np.sqrt(mesh.area) > 2 * np.sqrt(small.sum())  # no step of a search sees them
    seams = find_seams(mesh, LIMITS, aim=aim)
    assert accepted(mesh, seams) and len(seams.pieces) == 11


def noisy_frame(noise: float) -> Mesh:
    """A closed plate with eight windows (genus 8) of 6 mm cells, shaken as a bad scan is: `noise` times the cell."""
    solid = np.zeros((11, 7, 3), dtype=bool)
    solid[1:-1, 1:-1, 1] = True
    solid[2:-1:2, 2:-1:2, 1] = False
    quads = []
    for axis in range(3):
        u, v = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        for ahead in (0, 1):
            bare = solid & ~np.roll(solid, 1 - 2 * ahead, axis=axis)
            for cell in np.argwhere(bare):
                corner = cell + ahead * np.eye(3, dtype=int)[axis]
                quad = [corner, corner + u, corner + u + v, corner + v]
                quads.append(quad if ahead else quad[::-1])
    V, at = np.unique(np.array(quads).reshape(-1, 3), axis=0, return_inverse=True)
    q = at.reshape(-1, 4)
    shake = np.random.default_rng(0).normal(scale=noise, size=V.shape)
    return Mesh(6 * (V + shake), np.vstack([q[:, [0, 1, 2]], q[:, [0, 2, 3]]]))


def test_noisy_scan_of_genus_8(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fewest pieces end in more than one here, so that the usual ones are looked at as well: both answers of one search."""
    mesh = noisy_frame(0.1)
    assert mesh.topology.euler == 2 - 2 * 8 and mesh.topology.is_oriented_manifold
    graph = edge_graph(mesh.topology, mesh.edge_lengths, len(mesh.V))
    distance, before = shortest_tree(graph, np.array([0]))
    slit = np.zeros(len(mesh.topology.E), dtype=bool)
    slit[mesh.topology.edge_ids(trace(before, int(np.argmax(distance))))] = True
    assert not open_pieces(mesh, slit)[0].is_disk  # what opens a ball
    cut = np.zeros_like(slit)
    cut[cut_to_disk(mesh.topology, mesh.edge_lengths, len(mesh.V))] = True
    (opened,) = open_pieces(mesh, cut)
    flat = measure(mesh.V[opened.vertices], opened.F, method("lscm")(mesh.V[opened.vertices], opened.F, topology=opened.topology))
    assert opened.is_disk and (flat.mean > 5 or flat.overlap_mm2 > 0.01 * mesh.area)  # what opens it is not enough to lay it flat
    usual: list[Seams] = []
    search = auto._at_best

    def heard(*asked) -> Seams:
        usual.append(search(*asked))
        return usual[0]

    monkeypatch.setattr(auto, "_at_best", heard)
    seams = find_seams(mesh, LIMITS, aim="fewest")
    assert accepted(mesh, seams) and accepted(mesh, usual[0])
    assert len(seams.pieces) <= len(usual[0].pieces) <= 12


def with_needles(V, F, height: float):
    """A quarter of the triangles parted into three, one of which is a needle that high for its length."""
    V, F, rng = list(V), [list(f) for f in F], np.random.default_rng(0)
    for k in rng.choice(len(F), len(F) // 4, replace=False).tolist():
        a, b, c = F[k]
        F[k] = [a, b, len(V)]
        F += [[b, c, len(V)], [c, a, len(V)]]
        V.append((1 - height) * (V[a] + V[b]) / 2 + height * V[c])
    return np.array(V), np.array(F)


@both
def test_needles(aim: Aim) -> None:
    """Cotangents of ten million: a harmonic layout turns triangles over."""
    V, F = shapes.sphere(2)
    mesh = Mesh(*with_needles(10 * V, F, 1e-7))
    seams = find_seams(mesh, LIMITS, aim=aim)
    assert accepted(mesh, seams) and len(seams.pieces) == 1
    piece, _ = seams.pieces[0]
    flat = measure(mesh.V[piece.vertices], piece.F, method("harmonic")(mesh.V[piece.vertices], piece.F, topology=piece.topology))
    assert flat.flipped > 0 or flat.max > 100
    smooth = find_seams(Mesh(10 * V, F), replace(LIMITS, mean=4.04), aim=aim)
    assert seam_length(mesh, seams.cut) < 1.3 * seam_length(Mesh(10 * V, F), smooth.cut)  # no dart to every needle
