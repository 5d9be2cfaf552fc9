"""How many factorisations and solves a whole call takes: what is slow when meshes are large, counted instead of timed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
import shapes
from numpy.typing import NDArray

from skinfab.bench.disks import bumpy_cap
from skinfab.flatten import bijective
from skinfab.flatten.bijective import flatten_bijective
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.methods import method
from skinfab.flatten.simplified import flatten_simplified
from skinfab.linalg import Cholesky
from skinfab.mesh.model import Mesh
from skinfab.seams.cones import flatten_with_cones

Disk = tuple[NDArray[np.float64], NDArray[np.int64]]


@dataclass
class Count:
    """Symbolic analyses, numeric factorisations, solves; and the largest system that was factored."""

    analyses: int = 0
    factorisations: int = 0
    solves: int = 0
    largest: int = 0


@pytest.fixture
def count(monkeypatch: pytest.MonkeyPatch) -> Count:
    found = Count()
    init, numeric, solve = Cholesky.__init__, Cholesky._numeric, Cholesky.solve

    def counted_init(self: Cholesky, lower: object) -> None:
        found.analyses += 1
        init(self, lower)  # type: ignore[arg-type]

    def counted_numeric(self: Cholesky) -> None:
        found.factorisations += 1
        found.largest = max(found.largest, self._matrix.size[0])
        numeric(self)

    def counted_solve(self: Cholesky, b: NDArray[np.float64]) -> NDArray[np.float64]:
        found.solves += 1
        return solve(self, b)

    monkeypatch.setattr(Cholesky, "__init__", counted_init)
    monkeypatch.setattr(Cholesky, "_numeric", counted_numeric)
    monkeypatch.setattr(Cholesky, "solve", counted_solve)
    return found


def test_bff_is_one_factorisation_and_two_solves(count: Count) -> None:
    method("bff")(*shapes.cap(12, 1.2))
    assert (count.analyses, count.factorisations, count.solves) == (1, 1, 2)


@pytest.mark.parametrize(
    ("disk", "most"),
    [(shapes.cap(12, 1.2), Count(2, 3, 9)), (bumpy_cap(20_000), Count(3, 3, 8)), (shapes.holed(), Count(2, 2, 3))],
    ids=["small", "large", "with holes"],
)
def test_isometric_is_bff_and_a_few_steps(disk: Disk, most: Count, count: Count) -> None:
    """The matrix of the steps is analysed once, and on large meshes factored once: the last factor serves the steps after."""
    method("isometric")(*disk)
    assert count.analyses <= most.analyses and count.factorisations <= most.factorisations and count.solves <= most.solves


def test_a_disk_that_does_not_overlap_costs_no_barrier(count: Count) -> None:
    flatten_isometric(*shapes.cap(12, 1.2))
    alone = Count(**vars(count))
    flatten_bijective(*shapes.cap(12, 1.2))
    assert (count.analyses - alone.analyses, count.factorisations - alone.factorisations) == (alone.analyses, alone.factorisations)


def test_a_wide_barrier_first_spares_steps(count: Count, monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps that feel the barrier before they run into it: without it the ramp of three turns takes several times as many."""
    ramp = shapes.helicoid(3.0, 120, 6)
    flatten_bijective(*ramp)
    wide = count.factorisations
    monkeypatch.setattr(bijective, "_WIDER", ())
    flatten_bijective(*ramp)
    assert 1.5 * wide < count.factorisations - wide


def test_cones_take_one_factorisation_to_place_and_one_to_lay_out(count: Count) -> None:
    flatten_with_cones(Mesh(*shapes.sphere(3)), count=8)
    assert count.factorisations <= 4 and count.analyses <= 4


def test_simplified_never_factors_the_fine_mesh(count: Count) -> None:
    V, F = bumpy_cap(18_000)
    assert flatten_simplified(V, F).n_coarse > 0
    assert 0 < count.largest < 2 * len(V) / 8
