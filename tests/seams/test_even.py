"""Hot spots evened out within the bound on the mean."""

import numpy as np
import pytest
import shapes

from skinfab.errors import RefusedError
from skinfab.flatten.distortion import measure
from skinfab.flatten.isometric import IsometricSolver
from skinfab.mesh.model import Mesh
from skinfab.seams.auto import Seams, find_seams
from skinfab.seams.cut import open_pieces
from skinfab.seams.even import evened
from skinfab.seams.finish import finish
from skinfab.seams.judge import Limits, judge
from skinfab.seams.manual import seams_by_hand
from skinfab.seams.refine import Judged


def at_its_least(V: np.ndarray, F: np.ndarray) -> tuple[Mesh, Judged]:
    mesh = Mesh(V, F)
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    return mesh, (piece, judge(mesh, piece, Limits(mean=6.0), tolerance=1e-6))


@pytest.mark.parametrize("spare", [0.002, 0.01, 0.05])
def test_much_less_where_it_is_worst_for_little_on_the_mean(spare: float) -> None:
    mesh, item = at_its_least(*shapes.cap(16, 1.4))
    before = item[1].distortion
    piece, verdict = evened(mesh, item, Limits(mean=before.mean + spare * (before.mean - 4)))
    after = verdict.distortion
    assert verdict.accepted and after.flipped == 0 and after.overlap_mm2 == 0
    rise, gain = after.mean - before.mean, before.p99 - after.p99
    assert 0 < rise <= spare * (before.mean - 4) and gain > 5 * rise
    own = measure(mesh.V[piece.vertices], piece.F, verdict.UV)
    assert (own.mean, own.p99) == pytest.approx((after.mean, after.p99))


def test_more_to_spend_gains_more() -> None:
    mesh, item = at_its_least(*shapes.cap(16, 1.4))
    mean = item[1].distortion.mean
    p99 = [evened(mesh, item, Limits(mean=mean + spare * (mean - 4)))[1].distortion.p99 for spare in (0.0, 0.002, 0.01, 0.05)]
    assert p99[0] == item[1].distortion.p99 and (np.diff(p99) < 0).all()


def test_what_leaves_much_of_the_bound_stays_at_its_least_mean() -> None:
    mesh, item = at_its_least(*shapes.cap(10, 1.0))
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    for share, gains in ((1.5, False), (1.2, True)):
        limits = Limits(mean=4 + share * (item[1].distortion.mean - 4))
        ((_, verdict),) = finish(mesh, Seams(cut, [item]), limits).pieces
        assert (verdict.distortion.p99 < item[1].distortion.p99 - 1e-3) == gains


def test_seams_by_hand_are_not_refused_for_hot_spots_that_can_be_evened_out() -> None:
    mesh, item = at_its_least(*shapes.cap(16, 1.4))
    before = item[1].distortion
    cut = np.zeros(len(mesh.topology.E), dtype=bool)
    limits = Limits(mean=4 + 1.1 * (before.mean - 4), p99=before.p99 - 1e-3)
    ((_, verdict),) = seams_by_hand(mesh, cut, limits).pieces
    assert verdict.accepted and verdict.distortion.p99 <= limits.p99
    with pytest.raises(RefusedError, match="p99"):
        seams_by_hand(mesh, cut, Limits(mean=limits.mean, p99=4 + 0.5 * (before.p99 - 4)))


def test_what_is_flat_stays_so() -> None:
    mesh, item = at_its_least(*shapes.wavy(6, 0.0))
    _, verdict = evened(mesh, item, Limits(mean=4.0 + 1e-12))
    assert verdict.distortion.p99 == pytest.approx(4, abs=1e-9)


def test_sides_in_contact_do_not_pass() -> None:
    """A ramp of more than one turn covers itself at its least mean d, and so it does at weights of any kind."""
    V, F = shapes.helicoid()
    mesh = Mesh(V, F)
    (piece,) = open_pieces(mesh, np.zeros(len(mesh.topology.E), dtype=bool))
    limits = Limits(mean=6.0)
    ((_, least),) = finish(mesh, find_seams(mesh, limits, aim="fewest"), limits).pieces
    assert least.distortion.overlap_mm2 == 0
    near = Limits(mean=4 + 1.01 * (least.distortion.mean - 4))
    _, verdict = evened(mesh, (piece, least), near)
    assert verdict.accepted and verdict.distortion.overlap_mm2 == 0 and verdict.distortion.p99 < least.distortion.p99
    free = IsometricSolver(V, F).refine(verdict.UV).UV
    assert measure(V, F, free).overlap_mm2 > 0


def test_a_bound_on_the_p99_takes_no_seam_where_evening_out_will_do() -> None:
    mesh = Mesh(*shapes.sphere(2))
    limits = Limits(mean=4.05)
    plain = find_seams(mesh, limits, aim="fewest")
    p99 = finish(mesh, plain, limits).pieces[0][1].distortion.p99
    assert p99 < plain.pieces[0][1].distortion.p99
    bounded = Limits(mean=4.05, p99=p99 + 1e-9)
    found = find_seams(mesh, bounded, aim="fewest")
    assert (found.cut == plain.cut).all() and all(verdict.accepted for _, verdict in finish(mesh, found, bounded).pieces)
    tight = Limits(mean=4.05, p99=4 + 0.6 * (p99 - 4))
    tighter = find_seams(mesh, tight, aim="fewest")
    assert tighter.cut.sum() > plain.cut.sum()
    assert all(verdict.accepted for _, verdict in finish(mesh, tighter, tight).pieces)
