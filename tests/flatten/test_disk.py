"""The default method: never flips, never worse than what it starts from, the same for every pose and order."""

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.bench.disks import bumpy_cap
from skinfab.errors import InputError
from skinfab.flatten import disk
from skinfab.flatten.bff import flatten_disk
from skinfab.flatten.disk import flatten_isometric, lower
from skinfab.flatten.distortion import best_scale, measure, shaped_areas, singular_values


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000), st.floats(0, 0.5))
def test_no_flips_on_random_disks(seed: int, noise: float) -> None:
    V, F = shapes.random_disk(seed, 60, noise)
    assert (singular_values(V, F, flatten_isometric(V, F)) > 0).all()


@pytest.mark.parametrize("mesh", [shapes.wavy(), shapes.cap(8), shapes.cap(8, 2.4)], ids=["wavy", "hemisphere", "three quarters"])
def test_better_than_bff(mesh) -> None:
    V, F = mesh
    bff = flatten_disk(V, F)
    assert measure(V, F, flatten_isometric(V, F)).mean < measure(V, F, bff * best_scale(V, F, bff)).mean - 1e-4


@pytest.mark.parametrize("radians", [0.3, 0.6, 0.9])
def test_sphere_caps_keep_to_the_curvature_law(radians: float) -> None:
    """d - 4 is 0.0021 to 0.0035 K^2 for a compact piece of total curvature K (spec 02, section 2)."""
    V, F = shapes.cap(24, radians)
    K = 2 * np.pi * (1 - np.cos(radians))
    assert 0.0021 < (measure(V, F, flatten_isometric(V, F)).mean - 4) / K**2 < 0.0035


@pytest.mark.parametrize("sheet", [shapes.cylinder_sheet, shapes.cone_sheet, shapes.helicoid])
def test_developables_stay_isometric(sheet) -> None:
    V, F = sheet()
    flat = 1e-9 if sheet is not shapes.helicoid else 1e-3  # a ramp about a shaft is not developable, its facets nearly so
    assert measure(V, F, flatten_isometric(V, F)).mean == pytest.approx(4, abs=flat)


@pytest.mark.parametrize("seed", range(3))
def test_pose_order_and_unit_change_nothing(seed: int) -> None:
    V, F = shapes.cap(8, 2.0)
    d = measure(V, F, flatten_isometric(V, F)).mean
    W, G, _ = shapes.relabelled(V, F, seed)
    W = 10.0 ** (6 * (seed - 1)) * (W @ shapes.rotation(seed).T + 1)
    assert measure(W, G, flatten_isometric(W, G)).mean == pytest.approx(d, abs=1e-5)


def test_the_smallest_disks() -> None:
    V, F = shapes.grid(1, 1, lambda s, t: np.stack([s, t, s * t], axis=1))
    for faces in (F[:1] * 1, F):
        used, G = np.unique(faces, return_inverse=True)
        uv = flatten_isometric(V[used], G.reshape(-1, 3))
        np.testing.assert_allclose(singular_values(V[used], G.reshape(-1, 3), uv), 1, atol=1e-6)


def test_untangling_is_told() -> None:
    told: list[str] = []
    V, F = shapes.random_disk(0, 100, 0.3)
    assert (singular_values(V, F, flatten_disk(V, F))[:, 1] <= 0).any()
    assert (singular_values(V, F, flatten_isometric(V, F, say=told.append)) > 0).all()
    assert len(told) == 1 and f"of {len(F)} triangles over" in told[0]
    flatten_isometric(*shapes.wavy(), say=told.append)
    assert len(told) == 1


def test_a_triangle_without_width_is_untangled_too() -> None:
    told: list[str] = []
    V, F = shapes.random_disk(0, 100, 0.3)
    lower(V, F, V[:, :2] * [1.0, 1e-14], say=told.append)
    assert "begun anew" in told[0]


def test_so_many_triangles_without_area_that_it_would_be_worse_than_bff() -> None:
    V, F = shapes.wavy()
    V = np.round(V * 10) / 10
    assert (~shaped_areas(V, F)[1]).sum() > 20
    with pytest.raises(InputError, match=r"triangles have no area .*clean the mesh first"):
        flatten_isometric(V, F)


@pytest.mark.parametrize("n", [4000, 6000])
def test_rigid_steps_on_large_meshes_only(n: int, monkeypatch: pytest.MonkeyPatch) -> None:
    V, F = bumpy_cap(n)
    taken = []
    real = disk.rigid_steps
    monkeypatch.setattr(disk, "rigid_steps", lambda *a, **k: (taken.append(k["steps"]), real(*a, **k))[1])
    flatten_isometric(V, F)
    assert taken == ([2] if len(F) >= 5000 else [])
