"""Cut until all is good: what comes out keeps to the limits, and what cannot is told."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError, RefusedError
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces, seam_length
from skinfab.seams.judge import Limits
from skinfab.seams.refine import refine_seams
from skinfab.seams.weights import seam_weights
from skinfab.tolerances import OVERLAP_FRACTION


def refined(V, F, limits: Limits, cut=None, **more):
    mesh = Mesh(V, F)
    cut = np.zeros(len(mesh.topology.E), dtype=bool) if cut is None else cut
    return mesh, *refine_seams(mesh, cut, limits, seam_weights(mesh), **more)


@pytest.mark.parametrize(
    ("surface", "mean", "most"),
    [
        (shapes.sphere(3), 4.05, 1),
        (shapes.torus(), 4.05, 1),
        (shapes.cap(12, 2.4), 4.02, 1),
        (shapes.cube(3), 4.01, 2),
        (shapes.holed(), 4.0001, 1),
    ],
    ids=["sphere", "torus", "cap", "cube", "holes"],
)
def test_few_good_disks(surface, mean: float, most: int) -> None:
    parts: list[float] = []
    mesh, cut, pieces = refined(*surface, Limits(mean=mean), progress=parts.append)
    assert len(pieces) <= most
    for piece, verdict in pieces:
        assert verdict.accepted and piece.is_disk
        assert verdict.distortion.mean <= mean and verdict.distortion.flipped == 0
        assert verdict.distortion.overlap_mm2 <= OVERLAP_FRACTION * mesh.area
    for (piece, _), again in zip(pieces, open_pieces(mesh, cut), strict=True):
        np.testing.assert_array_equal(piece.F, again.F)
    assert parts == sorted(parts) and parts[-1] == pytest.approx(1)


def test_seams_that_are_there_stay() -> None:
    V, F = shapes.torus(columns=36, rows=16)
    column = Mesh(V, F).topology.E // 16
    given = np.isin(column, [0, 18]).all(axis=1) & (column[:, 0] == column[:, 1])  # two rings that part it in halves
    assert given.sum() == 32
    _, cut, pieces = refined(V, F, Limits(), cut=given)
    assert (cut >= given).all() and len(pieces) >= 2


def test_a_strip_longer_than_the_bed_is_parted_across() -> None:
    V, F = shapes.grid(60, 3, lambda s, t: np.stack([600 * s, 30 * t, 0 * s], axis=1))
    mesh, cut, pieces = refined(V, F, Limits(size=(200, 150)))
    assert 4 <= len(pieces) <= 6
    for _, verdict in pieces:
        w, h = verdict.UV.max(axis=0)
        assert w <= 200 and h <= 150
    assert seam_length(mesh, cut) == pytest.approx(30 * (len(pieces) - 1))  # straight across, each time


def test_a_triangle_wider_than_the_bed_is_told() -> None:
    V, F = shapes.cube()
    with pytest.raises(RefusedError, match=r"face \d+ alone is \d+ x \d+ mm and does not fit the bed \(30 x 30 mm\)"):
        refined(40 * V, F, Limits(size=(30, 30)))


def book():
    V, F = shapes.wavy(4)
    return np.vstack([V, [0.5, 0.5, 1.0]]), np.vstack([F, [6, 7, len(V)]])


def mixed():
    V, F = shapes.wavy(4)
    F[::2] = F[::2, ::-1]
    return V, F


def doubled():
    V, F = shapes.wavy(4)
    return V, np.vstack([F, F[9:10]])


@pytest.mark.parametrize("surface", [book, mixed, doubled])
def test_what_no_seam_opens_is_told(surface) -> None:
    with pytest.raises(InputError, match=r"no seam opens the \d+ faces about face 0 to a disk: edges are non-manifold or wound both ways"):
        refined(*surface(), Limits())
