"""What is left over in the end: less seam, within the bounds."""

import numpy as np
import pytest
import shapes

from skinfab.flatten.distortion import measure
from skinfab.mesh.model import Mesh
from skinfab.seams.growth import grow
from skinfab.seams.polish import exchange, trim
from skinfab.seams.sheet import Sheet, Surface, lay_apart, lay_out, sheet_of
from skinfab.seams.weights import seam_weights


def grown(bound: float) -> Sheet:
    mesh = Mesh(*shapes.cap(14))
    none = np.zeros(len(mesh.topology.E), dtype=bool)
    sheet = sheet_of(Surface(mesh, seam_weights(mesh), none), none)
    assert sheet is not None
    return grow(lay_out(sheet), bound)


@pytest.fixture(scope="module")
def fine() -> Sheet:
    return grown(4.02)


def good(sheet: Sheet, bound: float) -> bool:
    d = measure(sheet.surface.mesh.V[sheet.origin], sheet.F, sheet.UV)
    return d.mean == pytest.approx(sheet.mean) and d.mean <= bound and d.flipped == 0 and d.overlap_mm2 == 0


def test_a_looser_bound_needs_less_seam(fine: Sheet) -> None:
    bound = 4.03
    less = trim(fine, bound)
    assert good(less, bound) and less.length < 0.9 * fine.length
    assert not (less.cut & ~fine.cut).any()


def test_nothing_is_closed_at_the_bound(fine: Sheet) -> None:
    assert trim(fine, fine.mean) is fine


def test_p99_holds_too(fine: Sheet) -> None:
    free, held = trim(fine, 4.05), trim(fine, 4.05, p99=fine.p99 + 0.02)
    assert held.p99 <= fine.p99 + 0.02 < free.p99 and held.length > free.length


def test_exchange_is_never_longer(fine: Sheet) -> None:
    told: list[float] = []
    other = exchange(fine, 4.02, rounds=6, report=told.append)
    assert good(other, 4.02) and other.length <= fine.length
    assert told and told == sorted(told) and told[-1] < 1


def test_what_is_apart_stays_apart(fine: Sheet) -> None:
    apart = lay_apart(fine)
    less = trim(apart, 4.04)
    assert less.apart is not None and less.is_simple and good(less, 4.04) and less.length < apart.length
