"""What is taken for intact needs no cleaning and is not refused."""

import runpy
from pathlib import Path

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.mesh.door import load_usable
from skinfab.mesh.intact import is_intact
from skinfab.mesh.io import load_mesh
from skinfab.mesh.model import Mesh
from skinfab.mesh.repair import clean, require_usable

ROOT = Path(__file__).parents[2]
CASES = runpy.run_path(str(ROOT / "tests" / "stability" / "broken_meshes.py"))["all_cases"]()


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.file)
def test_broken_meshes_are_not_intact(case, tmp_path: Path) -> None:
    path = tmp_path / case.file
    path.write_bytes(case.data)
    try:
        mesh = load_mesh(path, units="mm").mesh
    except InputError:
        assert case.fate == "refused"
        return
    if case.fate != "as is":
        assert not is_intact(mesh)
    elif is_intact(mesh):
        assert clean(mesh) == (mesh, [])
        require_usable(mesh)


@pytest.mark.parametrize("shape", ["wavy", "sphere", "torus", "holed", "cap", "helicoid", "cone_sheet"])
def test_ordinary_meshes_are_intact(shape: str) -> None:
    V, F = getattr(shapes, shape)()
    assert is_intact(Mesh(V, F))


@pytest.mark.parametrize("path", sorted((ROOT / "meshes").glob("*.obj")), ids=lambda p: p.stem)
def test_the_projects_own_objects_are_intact(path: Path) -> None:
    assert is_intact(load_mesh(path).mesh)
    assert load_usable(path).mesh.topology.is_oriented_manifold


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 100_000))
def test_intact_is_never_said_of_what_cleaning_changes(seed: int) -> None:
    rng = np.random.default_rng(seed)
    V, F = [shapes.wavy, shapes.sphere, shapes.torus, shapes.holed, shapes.cube][seed % 5]()
    V, F = V.copy(), F.copy()
    kind = rng.integers(9)
    face, other = rng.integers(len(F), size=2)
    if kind == 0:
        F[face] = F[face, ::-1]
    elif kind == 1:
        F[face, 0] = rng.integers(len(V))
    elif kind == 2:
        V[F[face, 0]] = V[F[face, 1]]
    elif kind == 3:
        V[F[face, 0]] = (V[F[face, 1]] + V[F[face, 2]]) / 2
    elif kind == 4:
        F = np.vstack([F, F[[other], :: rng.choice([-1, 1])]])
    elif kind == 5:
        F = F[rng.random(len(F)) < 0.7]
    elif kind == 6:
        V, F = np.vstack([V, V]), np.vstack([F, F + len(V)])  # a copy at the same place
    elif kind == 7:
        F = F[:, ::-1]
    mesh = Mesh(V, F)
    if is_intact(mesh):
        cleaned, done = clean(mesh)
        assert cleaned is mesh and done == []
        require_usable(mesh)
    else:
        assert kind != 8


def test_numbers_that_are_none() -> None:
    V, F = shapes.wavy()
    for wrong in (-1, len(V)):
        G = F.copy()
        G[4, 1] = wrong
        assert not is_intact(Mesh(V, G))
    for value in (np.nan, np.inf):
        W = V.copy()
        W[7, 2] = value
        assert not is_intact(Mesh(W, F))
    assert not is_intact(Mesh(V, F[:0]))
    assert not is_intact(Mesh(np.vstack([V, V[:1] + 9]), F))  # a vertex no face uses


def test_a_cavity_is_looked_at_in_full() -> None:
    """Its negative volume may be right: that is for `clean` to say."""
    V, F = shapes.sphere()
    hollow = Mesh(np.vstack([2 * V, V]), np.vstack([F, F[:, ::-1] + len(V)]))
    assert not is_intact(hollow)
    assert clean(hollow) == (hollow, [])


def test_coincident_vertices_matter_only_at_a_border() -> None:
    V, F = shapes.wavy(4)
    torn = Mesh(V[F].reshape(-1, 3) * [1, 1, -0.0], np.arange(F.size).reshape(-1, 3))
    assert not is_intact(torn)
    V, F = shapes.sphere()
    touching = Mesh(np.vstack([V, V + V[0] * 2]), np.vstack([F, F + len(V)]))
    assert len(np.unique(touching.V.round(12), axis=0)) < len(touching.V)
    assert is_intact(touching) and clean(touching) == (touching, [])
