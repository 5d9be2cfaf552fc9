"""Libigl's methods behind our door: right side up, at their best scale, on what each is known for."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError, RefusedError
from skinfab.flatten import classic
from skinfab.flatten.classic import arap, harmonic, lscm, slim
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import best_scale, measure, singular_values
from skinfab.tolerances import NEWTON_DECREASE

ALL = [lscm, harmonic, arap, slim]


@pytest.mark.parametrize("method", ALL)
@pytest.mark.parametrize("mesh", [shapes.wavy(), shapes.cap(8), shapes.cylinder_sheet()], ids=["wavy", "hemisphere", "cylinder"])
def test_right_side_up_at_the_best_scale(method, mesh) -> None:
    V, F = mesh
    uv = method(V, F)
    assert (singular_values(V, F, uv)[:, 1] > 0).all()
    assert best_scale(V, F, uv) == pytest.approx(1, rel=1e-9)


@pytest.mark.parametrize("method", ALL)
def test_mirrored_faces_too(method) -> None:
    V, F = shapes.wavy()
    G = F[:, ::-1].copy()
    assert (singular_values(V, G, method(V, G))[:, 1] > 0).all()


def test_lscm_is_conformal() -> None:
    error = []
    for rings in (6, 12, 24):
        V, F = shapes.cap(rings)
        s = singular_values(V, F, lscm(V, F))
        error.append((s[:, 0] / s[:, 1] - 1).mean())
    assert error[0] > 1.8 * error[1] > 3.2 * error[2] and error[2] < 0.03
    V, F = shapes.wavy()
    means = [(lambda s: (s[:, 0] / s[:, 1]).mean())(singular_values(V, F, uv)) for uv in (lscm(V, F), harmonic(V, F))]
    assert means[0] < 1.05 < 1.2 < means[1]  # a given circle is in a conformal map's way


@pytest.mark.parametrize("method", [lscm, arap, slim])
def test_cylinders_come_out_isometric(method) -> None:
    V, F = shapes.cylinder_sheet()
    assert measure(V, F, method(V, F)).mean == pytest.approx(4, abs=1e-4)


@pytest.mark.parametrize("mesh", [shapes.wavy(), shapes.cap(8)], ids=["wavy", "hemisphere"])
def test_slim_reaches_our_optimum_and_no_method_beats_it(mesh) -> None:
    V, F = mesh
    ours = measure(V, F, flatten_isometric(V, F)).mean
    d = {method.__name__: measure(V, F, method(V, F)).mean for method in ALL}
    assert d["slim"] == pytest.approx(ours, abs=2e-3 * (ours - 4) + 1e-5)
    assert min(d.values()) > ours - NEWTON_DECREASE * (ours - 4)


@pytest.mark.parametrize("method", ALL)
@pytest.mark.parametrize("mesh", [shapes.sphere(), shapes.torus(), (np.vstack([np.zeros((1, 3)), shapes.wavy()[0]]), shapes.wavy()[1] + 1)])
def test_what_would_end_the_process_is_refused_first(method, mesh) -> None:
    """Closed meshes and unused vertices crash libigl."""
    with pytest.raises(InputError, match="only a disk"):
        method(*mesh)


def test_a_result_that_is_no_number_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    V, F = shapes.wavy()
    monkeypatch.setattr(classic.igl, "lscm", lambda *_: (np.full((len(V), 2), np.nan), None))
    with pytest.raises(RefusedError, match="lscm gave coordinates that are not numbers"):
        lscm(V, F)


@pytest.mark.parametrize("method", [lscm, harmonic])
def test_a_failure_of_libigls_own_is_a_refusal(method, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_):
        raise RuntimeError("igl failed")

    monkeypatch.setattr(classic.igl, method.__name__, fails)
    with pytest.raises(RefusedError, match=rf"{method.__name__} found no map of this mesh \(igl failed\); use --method auto"):
        method(*shapes.wavy())


def purse_with_holes() -> tuple[np.ndarray, np.ndarray]:
    """Nine tenths of a sphere with a hole in its side, near the opening."""
    V, F = shapes.cap(12, 2.6)
    F = F[np.linalg.norm(V[F].mean(axis=1) - [np.sin(1.95), 0, np.cos(1.95)], axis=1) > 0.5]
    used, local = np.unique(F, return_inverse=True)
    return V[used], local.reshape(-1, 3)


def test_holes_whose_rims_would_cover_themselves_stay_filled(monkeypatch: pytest.MonkeyPatch) -> None:
    V, F = purse_with_holes()
    figures = measure(V, F, slim(V, F))
    assert figures.flipped == 0 and figures.overlap_mm2 == 0
    monkeypatch.setattr(classic, "overlap_area", lambda *_, **__: 0.0)
    assert measure(V, F, slim(V, F)).overlap_mm2 > 0.01
