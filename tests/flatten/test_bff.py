"""Boundary first flattening: exact on developables, conformal in the limit, one factorisation and two solves."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.flatten import bff
from skinfab.flatten.bff import flatten_disk
from skinfab.flatten.distortion import measure, singular_values
from skinfab.linalg import Cholesky


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("sheet", [shapes.cylinder_sheet, shapes.cone_sheet, shapes.grid])
def test_developables_come_out_isometric(sheet, unit: float) -> None:
    V, F = sheet(24, 10)
    uv = flatten_disk(unit * V, F)
    np.testing.assert_allclose(singular_values(unit * V, F, uv), 1, atol=1e-9)
    assert measure(unit * V, F, uv).mean == pytest.approx(4, abs=1e-9)


def test_conformal_in_the_limit() -> None:
    """On a hemisphere the quasi-conformal error s1 / s2 - 1 falls with the edge length."""
    error = []
    for rings in (6, 12, 24, 48):
        V, F = shapes.cap(rings)
        s = singular_values(V, F, flatten_disk(V, F))
        assert s.min() > 0
        error.append((s[:, 0] / s[:, 1] - 1).mean())
    rate = np.log2(np.array(error[:-1]) / error[1:])
    assert (rate > 0.9).all() and error[-1] < 0.02


def test_hemisphere_has_the_closed_form_scale() -> None:
    """With u = 0 on the boundary the flat hemisphere is the disk of stereographic projection, of the boundary's radius."""
    V, F = shapes.cap(40)
    uv = flatten_disk(V, F)
    radius = np.linalg.norm(uv - uv[0], axis=1)
    polar = np.arccos(V[:, 2])
    np.testing.assert_allclose(radius, np.tan(polar / 2), atol=2e-3)


def test_prescribed_boundary_scale_gives_the_conformal_map() -> None:
    """u = log |f'| on the boundary of a flat square is the map f itself, here f = exp."""
    error = []
    for n in (8, 16, 32):
        V, F = shapes.grid(n, n)
        z = V[:, 0] + 1j * V[:, 1]
        uv = flatten_disk(V, F, scale=z.real)  # log |exp'(z)| = Re z
        got, want = uv @ [1, 1j], np.exp(z)
        got, want = got - got.mean(), want - want.mean()
        spin = np.vdot(got, want) / abs(np.vdot(got, want))
        error.append(np.abs(got * spin - want).max())
    assert error[-1] < 2e-3 and error[0] / error[1] > 3 and error[1] / error[2] > 3  # second order


def test_constant_scale_is_a_similarity() -> None:
    V, F = shapes.wavy()
    plain, larger = flatten_disk(V, F), flatten_disk(V, F, scale=np.full(len(V), np.log(3)))
    np.testing.assert_allclose(larger - larger[0], 3 * (plain - plain[0]), atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_motion_and_order_change_nothing(seed: int) -> None:
    V, F = shapes.wavy()
    s = singular_values(V, F, flatten_disk(V, F))
    W, G, _ = shapes.relabelled(V, F, seed)
    order = np.random.default_rng(seed)
    order.permutation(len(V))
    faces = order.permutation(len(F))
    W = 2.5 * W @ shapes.rotation(seed).T - 4
    np.testing.assert_allclose(singular_values(W, G, flatten_disk(W, G)), s[faces], atol=1e-9)


def test_one_factorisation_two_solves(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Cholesky] = []

    class Watched(Cholesky):
        def __init__(self, lower) -> None:
            super().__init__(lower)
            made.append(self)

    monkeypatch.setattr(bff, "Cholesky", Watched)
    flatten_disk(*shapes.wavy())
    assert [(c.factorisations, c.solves) for c in made] == [(1, 2)]
    flatten_disk(*shapes.grid(5, 1))  # no inner vertex: nothing to solve
    assert len(made) == 1


def pair(V, F):
    return np.vstack([V, V + 9]), np.vstack([F, F + len(V)])


@pytest.mark.parametrize(
    ("mesh", "says"),
    [
        (shapes.sphere(), "1 components, 0 boundary loops, Euler number 2"),
        (shapes.torus(), "1 components, 0 boundary loops, Euler number 0"),
        (shapes.holed(), "3 boundary loops, Euler number -1"),
        (pair(*shapes.wavy()), "2 components, 2 boundary loops"),
        ((np.vstack([shapes.wavy()[0], [9, 9, 9]]), shapes.wavy()[1]), "1 unused vertices"),
    ],
    ids=["sphere", "torus", "holes", "two components", "unused vertex"],
)
def test_what_is_no_disk_is_named(mesh, says: str) -> None:
    with pytest.raises(InputError, match=f"only a disk can be flattened: this has .*{says}.*; cut it first"):
        flatten_disk(*mesh)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_coordinates_that_are_no_numbers_are_named(value: float) -> None:
    V, F = shapes.wavy()
    V[77, 1] = value
    with pytest.raises(InputError, match="vertex 77 "):
        flatten_disk(V, F)
