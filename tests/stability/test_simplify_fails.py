"""Where flattening a simplified mesh fails: each test first shows the plain way fail, then what is done instead."""

from pathlib import Path

import igl
import numpy as np
import pytest
import shapes

from skinfab.bench.disks import bumpy_cap
from skinfab.cli.main import main
from skinfab.errors import InputError
from skinfab.flatten.carry import carrier
from skinfab.flatten.disk import flatten_isometric
from skinfab.flatten.distortion import measure, singular_values
from skinfab.flatten.simplified import flatten_simplified
from skinfab.mesh.decimate import decimate


def flips(V: np.ndarray, F: np.ndarray, uv: np.ndarray) -> int:
    return int((singular_values(V, F, uv)[:, 1] <= 0).sum())


def interpolated(V: np.ndarray, P: np.ndarray, G: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """The textbook transfer: the nearest point of the whole coarse mesh, linear in its triangle."""
    _, face, foot = igl.point_mesh_squared_distance(V, P, G)
    a, b, c = (np.ascontiguousarray(P[G[face, k]]) for k in range(3))
    return np.einsum("nk,nkd->nd", igl.barycentric_coordinates(foot, a, b, c), uv[G[face]])


def test_nearest_points_mix_up_the_two_sides_of_a_seam() -> None:
    V, F = shapes.cylinder_sheet(192, 60)
    few = decimate(V, F, faces=len(F) // 16)
    flat = flatten_isometric(few.V, few.F)
    assert flips(V, F, interpolated(V, few.V, few.F, flat)) > 50
    carried = carrier(V, few).carry(flat)
    assert flips(V, F, carried) == 0
    found = flatten_simplified(V, F)
    assert found.n_coarse and measure(V, F, found.UV).max < 4.001


def test_linear_interpolation_turns_triangles_over_at_the_boundary() -> None:
    """Vertices beyond the coarse boundary would all land on it."""
    V, F = shapes.grid(399, 39, lambda s, t: np.stack([s * 6, t + 0.05 * np.sin(40 * s), 0.2 * np.sin(3 * s)], axis=1))
    few = decimate(V, F, faces=len(F) // 16)
    flat, onto = flatten_isometric(few.V, few.F), carrier(V, few)
    assert flips(V, F, onto.interpolation @ flat) > 0 == flips(V, F, onto.carry(flat))
    assert flatten_simplified(V, F).n_coarse


def test_a_decimation_that_closes_the_disk_is_not_used() -> None:
    """The opening of a nearly closed ball is what a decimation gives up first."""
    V, F = shapes.cap(54, 3.0)
    few = decimate(V, F, faces=len(F) // 128)
    with pytest.raises(InputError, match="0 boundary loops"):
        flatten_isometric(few.V, few.F)
    flat = flatten_simplified(V, F, share=128, least_coarse=100)
    assert flat.sentence == f"flattened on all {len(F)} triangles: simplifying would tear it or close it"
    assert measure(V, F, flat.UV).flipped == 0


def test_a_rough_surface_is_not_simplified_away() -> None:
    """Noise as high as the edges are long: the coarse layout turns triangles over, so all of them are solved for."""
    V, F = bumpy_cap(20_000)
    V = V + np.random.default_rng(3).normal(0, 0.35, V.shape)
    few = decimate(V, F, faces=len(F) // 16)
    flat, onto = flatten_isometric(few.V, few.F), carrier(V, few)
    assert flips(V, F, onto.carry(flat)) > 0
    found = flatten_simplified(V, F)
    least = measure(V, F, flatten_isometric(V, F))
    best = measure(V, F, found.UV)
    assert found.n_coarse == 0 and found.why == "the simplified mesh's layout turns some of them over"
    assert best.flipped == 0 and best.mean - least.mean <= max(found.effect, 1e-4 * (least.mean - 4))


def test_interrupted_it_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupted(*args: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("skinfab.flatten.simplified.relax", interrupted)
    V, F = bumpy_cap(17_000)
    mesh = tmp_path / "mesh.obj"
    mesh.write_text("".join("v {} {} {}\n".format(*v) for v in V.tolist()) + "".join("f {} {} {}\n".format(*f) for f in (F + 1).tolist()))
    assert main(["flatten", str(mesh), "-o", str(tmp_path / "o.obj"), "--units", "mm", "--simplify", "auto"]) == 130
    assert capsys.readouterr().err == "skinfab: interrupted; nothing half-written was left\n" and list(tmp_path.iterdir()) == [mesh]
