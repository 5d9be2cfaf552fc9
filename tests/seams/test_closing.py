"""What closing a seam's end costs is told without closing: held against seams that are closed."""

import numpy as np
import pytest
import shapes

from skinfab.mesh.model import Mesh
from skinfab.seams.closing import closing_costs, closing_step, fringes
from skinfab.seams.growth import grow
from skinfab.seams.sheet import Sheet, Surface, lay_out, sheet_of
from skinfab.seams.weights import seam_weights


def grown(angle: float, bound: float) -> Sheet:
    """A cap with darts, at its least d."""
    mesh = Mesh(*shapes.cap(12, angle))
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    sheet = sheet_of(Surface(mesh, seam_weights(mesh), none), none)
    assert sheet is not None
    sheet = grow(lay_out(sheet), bound)
    uv = sheet.solver.refine(sheet.UV, tolerance=1e-7).UV
    return Sheet(sheet.surface, sheet.cut, sheet.F, sheet.origin, sheet.EF, sheet.loop, sheet.solver, uv)


def closed(sheet: Sheet, edges: np.ndarray) -> Sheet:
    cut = sheet.cut.copy()
    cut[edges] = False
    after = sheet_of(sheet.surface, cut)
    assert after is not None
    return after


def test_every_free_end_is_found() -> None:
    sheet = grown(np.pi / 2, 4.008)
    mesh = sheet.surface.mesh
    degree = np.bincount(mesh.topology.E[sheet.cut].ravel(), minlength=len(mesh.V))
    inside = np.ones(len(mesh.V), dtype=bool)
    inside[mesh.topology.E[mesh.topology.is_boundary]] = False
    ends = fringes(sheet, most=4)
    tips = sorted(int(np.intersect1d(mesh.topology.E[end.edges[0]], np.flatnonzero((degree == 1) & inside))[0]) for end in ends)
    assert len(ends) > 1 and tips == np.flatnonzero((degree == 1) & inside).tolist()
    for end in ends:
        assert sheet.cut[end.edges].all() and len(end.edges) <= 4
        np.testing.assert_array_equal(sheet.origin[end.pairs[:, 0]], sheet.origin[end.pairs[:, 1]])


@pytest.mark.parametrize(("angle", "bound"), [(0.6, 4.0004), (1.0, 4.003)])
def test_as_much_as_it_costs_in_truth(angle: float, bound: float) -> None:
    sheet = grown(angle, bound)
    d = float(sheet.d @ sheet.solver.weight)
    ends = fringes(sheet, most=6)
    told = closing_costs(sheet, ends)
    assert ends
    for end, costs in zip(ends, told, strict=True):
        assert (np.diff(costs) >= 0).all() and costs[0] >= 0
        for k in {0, len(costs) - 1}:
            after = lay_out(closed(sheet, end.edges[: k + 1]))
            uv = after.solver.refine(after.UV, tolerance=1e-7).UV
            true = after.solver.refine(uv, tolerance=1e-7).energy[-1] - d
            assert costs[k] == pytest.approx(true, rel=0.4 * angle**2, abs=2e-6)


def test_the_step_closes_the_gap() -> None:
    sheet = grown(1.0, 4.003)
    (end, *_) = fringes(sheet, most=5)
    moved = closing_step(sheet, end, len(end.edges))
    a, b = end.pairs.T
    gap = np.linalg.norm(sheet.UV[a] - sheet.UV[b], axis=1).max()
    assert gap > 1e-3 and np.linalg.norm(moved[a] - moved[b], axis=1).max() < 1e-4 * gap
    after = closed(sheet, end.edges)
    uv = np.empty((len(after.origin), 2))
    uv[after.F.ravel()] = moved[sheet.F.ravel()]
    assert after.solver.best_scale(uv)[1] > 0


def test_a_slit_keeps_two_edges() -> None:
    mesh = Mesh(*shapes.sphere(2))
    path = np.zeros(len(mesh.topology.E), dtype=bool)
    first = mesh.topology.E[0]
    other = next(e for e in range(1, len(path)) if first[1] in mesh.topology.E[e] and first[0] not in mesh.topology.E[e])
    path[[0, other]] = True
    sheet = sheet_of(Surface(mesh, seam_weights(mesh), np.zeros_like(path)), path)
    assert sheet is not None and fringes(sheet, most=8) == []
