"""A surface opened to one disk: the same disk as by any other way, its layout carried along."""

import numpy as np
import pytest
import shapes

from skinfab.flatten.distortion import measure
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.disk import cut_to_disk
from skinfab.seams.sheet import Sheet, Surface, carried, lay_apart, lay_out, refined, sheet_of
from skinfab.seams.weights import seam_weights


def opened(mesh: Mesh, cut: np.ndarray) -> Sheet | None:
    return sheet_of(Surface(mesh, seam_weights(mesh), np.zeros(len(cut), dtype=bool)), cut)


def disk_cut(mesh: Mesh) -> np.ndarray:
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    cut[cut_to_disk(mesh.topology, seam_weights(mesh), len(mesh.V))] = True
    return cut


@pytest.mark.parametrize("shape", [shapes.sphere(2), shapes.torus(), shapes.holed(), shapes.cube(3), shapes.random_disk(3)])
def test_the_same_disk_as_an_open_piece(shape: tuple[np.ndarray, np.ndarray]) -> None:
    mesh = Mesh(*shape)
    cut = disk_cut(mesh)
    sheet = opened(mesh, cut)
    (piece,) = open_pieces(mesh, cut, faces=np.arange(len(mesh.F)))
    assert sheet is not None and piece.is_disk
    np.testing.assert_array_equal(sheet.F, piece.F)
    np.testing.assert_array_equal(sheet.origin, piece.vertices)
    (loop,) = piece.topology.boundary_loops
    start = int(np.flatnonzero(loop == sheet.loop[0])[0])
    np.testing.assert_array_equal(np.roll(loop, -start), sheet.loop)


def test_what_is_no_disk_is_none() -> None:
    for shape in (shapes.sphere(2), shapes.torus(), shapes.holed()):
        mesh = Mesh(*shape)
        assert opened(mesh, np.zeros(len(mesh.topology.E), dtype=bool)) is None
    mesh = Mesh(*shapes.wavy(6))
    parted = np.zeros(len(mesh.topology.E), dtype=bool)
    parted[mesh.topology.FE[20]] = True
    assert opened(mesh, parted) is None


def test_its_figures_are_the_measured_ones() -> None:
    mesh = Mesh(*shapes.cap(10))
    sheet = opened(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    assert sheet is not None
    sheet = lay_out(sheet)
    d = measure(mesh.V, sheet.F, sheet.UV)
    assert sheet.mean == pytest.approx(d.mean) and sheet.p99 == pytest.approx(d.p99) and sheet.is_simple
    np.testing.assert_allclose(sheet.d, d.d)
    assert sheet.within(d.mean + 1e-9, np.inf) and not sheet.within(d.mean - 1e-6, np.inf) and not sheet.within(5.0, d.p99 - 1e-6)


def test_carried_layouts_begin_where_they_were() -> None:
    mesh = Mesh(*shapes.cap(10))
    before = opened(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    assert before is not None
    before = lay_out(before)
    cut = before.cut.copy()
    rim, inner = mesh.topology.E[np.isin(mesh.topology.E, before.loop).sum(axis=1) == 1][0]
    cut[mesh.topology.edge_ids(np.array([[rim, inner]]))] = True
    after = opened(mesh, cut)
    assert after is not None and len(after.origin) == len(before.origin) + 1
    uv = carried(before, after)
    np.testing.assert_array_equal(uv[after.F], before.UV[before.F])
    assert refined(after, uv).mean < before.mean


def test_apart_it_does_not_cover_itself() -> None:
    mesh = Mesh(*shapes.helicoid(1.5, 60, 4))
    free = opened(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    assert free is not None
    free = lay_out(free)
    apart = lay_apart(free)
    assert not free.is_simple and apart.is_simple and apart.apart is not None and apart.mean > free.mean
    again = refined(apart, apart.UV)
    assert again.is_simple and again.mean <= apart.mean * (1 + 1e-6)
