"""Counts of an inspection against closed forms, and every fault with its first element."""

import runpy
from pathlib import Path

import numpy as np
import pytest

from skinfab.mesh.inspect import Inspection, inspect
from skinfab.mesh.io import load_mesh

ROOT = Path(__file__).parents[2]
SHAPES = runpy.run_path(str(ROOT / "tests" / "stability" / "broken_meshes.py"))


def look(V: object, F: object) -> Inspection:
    return inspect(np.array(V, dtype=float), np.array(F))


def faults(found: Inspection) -> dict[str, tuple[int, str, str]]:
    return {f.kind: (f.count, f.first, f.mended_by) for f in found.faults if f.mended_by != "nothing"}


@pytest.mark.parametrize(
    ("shape", "genus", "loops"),
    [("grid", (0,), 1), ("sphere", (0,), 0), ("annulus", (0,), 2), ("helicoid", (0,), 1), ("moebius", (None,), 1)],
)
def test_shapes(shape: str, genus: tuple[int | None, ...], loops: int) -> None:
    found = look(*SHAPES[shape]())
    assert (found.components, found.genus, found.boundary_loops) == (1, genus, loops)
    assert found.closed == (loops == 0)
    assert found.usable == (shape != "moebius")


def test_torus_and_cube_side_by_side() -> None:
    n = 12
    a = 2 * np.pi * np.arange(n) / n
    V = [[(30 + 10 * np.cos(q)) * np.cos(p), (30 + 10 * np.cos(q)) * np.sin(p), 10 * np.sin(q)] for p in a for q in a]
    at = np.arange(n * n).reshape(n, n)
    ring, tube = np.roll(at, -1, axis=0), np.roll(at, -1, axis=1)
    both = np.roll(ring, -1, axis=1)
    torus = np.concatenate([np.stack([at, ring, both], axis=-1), np.stack([at, both, tube], axis=-1)]).reshape(-1, 3)
    box_V, box_F = SHAPES["box"]((100, 0, 0))
    found = look(V + box_V, np.vstack([torus, np.array(box_F) + n * n]))
    assert found.components == 2 and found.genus == (1, 0) and found.closed
    assert found.size_mm == pytest.approx((160, 80, 30))
    assert faults(found) == {}


def test_every_fault_is_named_with_its_first_element() -> None:
    V, F = SHAPES["grid"]()
    n = len(V)
    assert faults(look([*V, [0, 0, 9]], F)) == {"unreferenced vertex": (1, f"vertex {n}", "clean")}
    assert faults(look(V, [*F, F[3]])) == {"duplicate face": (1, "face 200", "clean")}
    assert faults(look(V, [*F, [7, 7, 8]])) == {"degenerate face (a corner twice)": (1, "face 200", "clean")}
    assert faults(look(V, [F[0][::-1], *F[1:]])) == {"inconsistent winding": (2, "edge 0-12", "clean")}
    assert faults(look([*V, [25, 25, 40]], [*F, [60, 61, n]])) == {"non-manifold edge": (1, "edge 60-61", "repair")}
    assert faults(look(V, [*F, [0, 1, n]])) == {"index out of range": (1, "face 200", "no")}
    assert faults(look([*V[:5], [np.nan, 0, 0], *V[6:]], F)) == {"coordinate not finite": (1, "vertex 5", "no")}
    assert "one-sided surface (Moebius band)" in faults(look(*SHAPES["moebius"]()))
    assert faults(look(V, np.zeros((0, 3), int))).keys() == {"no area", "unreferenced vertex"}


def test_open_edges_and_slivers_do_no_harm() -> None:
    V, F = SHAPES["grid"]()
    found = look([[x, 1e-5 * y, 0] for x, y, _ in V], F)
    assert (found.open_edges, found.slivers, found.usable) == (40, 200, True)
    assert {f.kind for f in found.faults} == {"sliver", "open edge"}


def test_relabelling_changes_no_count() -> None:
    mesh = load_mesh(ROOT / "meshes" / "cup.obj").mesh
    rng = np.random.default_rng(0)
    new = rng.permutation(len(mesh.V))
    V = np.empty_like(mesh.V)
    V[new] = mesh.V
    one, two = inspect(mesh.V, mesh.F), inspect(V, np.roll(new[mesh.F], 1, axis=1)[rng.permutation(len(mesh.F))])
    assert one.genus == two.genus == (1,) and one.faults == two.faults == ()
    assert one.area_mm2 == pytest.approx(two.area_mm2, rel=1e-12)
