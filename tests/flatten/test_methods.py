"""Every method by its name: one table, one contract."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.flatten.distortion import best_scale, measure, singular_values
from skinfab.flatten.methods import METHODS, method


@pytest.mark.parametrize("name", METHODS)
def test_flattens_a_disk_right_side_up(name: str) -> None:
    V, F = shapes.wavy()
    uv = method(name)(V, F)
    assert uv.shape == (len(V), 2) and uv.dtype == np.float64
    assert (singular_values(V, F, uv) > 0).all()


def bent(V: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A flat sheet of 12 x 12 rolled to a third of a cylinder."""
    r = 18 / np.pi
    return np.column_stack([r * np.sin(V[:, 0] / r), V[:, 1], r * np.cos(V[:, 0] / r)]), F


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("mesh", [shapes.holed(), bent(*shapes.holed())], ids=["flat", "bent"])
def test_holes_are_no_hindrance(name: str, mesh) -> None:
    V, F = mesh
    figures = measure(V, F, method(name)(V, F))
    assert figures.flipped == 0 and figures.overlap_mm2 == 0
    # A circle is in the way of harmonic maps; ARAP stops after 30 rounds.
    assert figures.mean == pytest.approx(4, abs={"harmonic": 2.0, "arap": 1e-3}.get(name, 1e-4))


UNIT = {"wavy": shapes.wavy(), "holes": bent(*shapes.holed()), "obtuse": shapes.random_disk(1, 100, 0.1)}


@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1e3, 1e6])
@pytest.mark.parametrize("mesh", UNIT)
@pytest.mark.parametrize("name", METHODS)
def test_unit_changes_nothing(name: str, mesh: str, unit: float) -> None:
    V, F = UNIT[mesh]
    here = method(name)(V, F)
    np.testing.assert_allclose(method(name)(unit * V, F) / unit, here, atol=1e-6 * np.abs(here).max())


def pair(V: np.ndarray, F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.vstack([V, V + 9]), np.vstack([F, F + len(V)])


def pierced_torus() -> tuple[np.ndarray, np.ndarray]:
    V, F = shapes.torus()
    return V, F[1:]


@pytest.mark.parametrize(
    ("mesh", "says"),
    [
        (shapes.sphere(), r"this is closed; cut it first \(skinfab segment, or --method auto\)"),
        (shapes.torus(), "this is closed; cut it first"),
        (pierced_torus(), "this has a handle; cut it first"),
        (pair(*shapes.wavy()), "this has 2 components; take them one by one"),
        ((np.vstack([shapes.wavy()[0], [[9, 9, 9]]]), shapes.wavy()[1]), "this has 1 unused vertices; remove them"),
    ],
    ids=["sphere", "torus", "pierced torus", "two", "unused vertex"],
)
@pytest.mark.parametrize("name", METHODS)
def test_refuses_what_is_no_disk(name: str, mesh, says: str) -> None:
    with pytest.raises(InputError, match=f"only a disk can be flattened, with holes or without: {says}"):
        method(name)(*mesh)


@pytest.mark.parametrize("name", METHODS)
def test_coordinates_that_are_no_numbers_are_named(name: str) -> None:
    V, F = shapes.holed()
    V[77, 1] = np.inf
    with pytest.raises(InputError, match="vertex 77 has a coordinate that is not a finite number"):
        method(name)(V, F)


def test_names_what_there_is() -> None:
    with pytest.raises(InputError, match="no flattening method 'bfff'; there are bff, "):
        method("bfff")


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("squash", [[0, 0, 0], [1, 0, 0], [1e-170, 1e-170, 1e-170]])
def test_no_area_at_all_is_refused(name: str, squash: list[float]) -> None:
    """libigl's lscm ended the process here, sooner or later: both of its held vertices were the same."""
    V, F = shapes.wavy()
    with pytest.raises(InputError, match=r"none of the .* has an area"):
        method(name)(V * squash, F)


@pytest.mark.parametrize("name", METHODS)
def test_faults_of_the_mesh_are_named(name: str) -> None:
    V, F = shapes.wavy()
    for G, says in (
        (np.vstack([F, [[0, 0, 1]]]), "a corner twice.*first: face 288"),
        (np.vstack([F, F[:1]]), "duplicate face .first: face"),
        (np.vstack([F[:-1], F[-1:, ::-1]]), "inconsistent winding .first: edge"),
        (np.vstack([F[:-1], [[0, 1, 10_000]]]), "face 287 uses vertices"),
    ):
        with pytest.raises(InputError, match=says):
            method(name)(V, G)


def test_the_scale_is_that_of_the_least_d() -> None:
    V, F = shapes.cap(8, 1.0)
    for name in METHODS:
        uv = method(name)(V, F)
        assert best_scale(V, F, uv) == pytest.approx(1, abs=1e-4), name
