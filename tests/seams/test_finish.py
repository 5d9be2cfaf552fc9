"""Driving accepted pieces to their least d."""

import numpy as np
import pytest
import shapes

from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import measure
from skinfab.mesh.model import Mesh
from skinfab.seams.auto import Seams, find_seams
from skinfab.seams.cut import open_pieces
from skinfab.seams.finish import finish
from skinfab.seams.judge import Limits, judge


def one_piece(V: np.ndarray, F: np.ndarray, limits: Limits) -> tuple[Mesh, Seams]:
    mesh = Mesh(V, F)
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    (piece,) = open_pieces(mesh, cut)
    return mesh, Seams(cut, [(piece, judge(mesh, piece, limits, tolerance=0.3))])


def test_it_reaches_the_least_d() -> None:
    V, F = shapes.cap(10, 1.2)
    limits = Limits(mean=5.0)
    mesh, seams = one_piece(V, F, limits)
    ((_, before),), ((_, after),) = seams.pieces, finish(mesh, seams, limits).pieces
    assert before.distortion.mean > after.distortion.mean + 1e-4
    assert after.distortion.mean == pytest.approx(measure(V, F, flatten_isometric(V, F)).mean, abs=1e-5)


def test_a_piece_that_would_cover_itself_is_kept_from_it() -> None:
    V, F = shapes.helicoid()
    limits = Limits(mean=6.0)
    mesh, seams = one_piece(V, F, limits)
    assert measure(V, F, flatten_isometric(V, F)).overlap_mm2 > 1
    ((_, before),), ((_, after),) = seams.pieces, finish(mesh, seams, limits).pieces
    assert before.accepted and after.accepted
    assert after.distortion.overlap_mm2 == 0 and after.distortion.mean <= before.distortion.mean


def test_overlap_that_is_taken_for_nothing_goes_where_the_bound_allows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("skinfab.seams.judge.OVERLAP_FRACTION", 1.0)
    V, F = shapes.helicoid()
    limits = Limits(mean=6.0)
    mesh, seams = one_piece(V, F, limits)
    ((_, before),), ((_, after),) = seams.pieces, finish(mesh, seams, limits).pieces
    assert before.accepted and before.distortion.overlap_mm2 > 1
    assert after.accepted and after.distortion.overlap_mm2 == 0
    tight = Limits(mean=before.distortion.mean + 1e-9)
    ((_, kept),) = finish(mesh, seams, tight).pieces
    assert kept.accepted and kept.distortion.overlap_mm2 > 1


def test_nothing_gets_worse() -> None:
    mesh = Mesh(*shapes.sphere())
    limits = Limits(mean=4.05)
    seams = find_seams(mesh, limits, neck=0.1)
    for (_, before), (_, after) in zip(seams.pieces, finish(mesh, seams, limits).pieces, strict=True):
        assert after.accepted and after.distortion.mean <= before.distortion.mean
