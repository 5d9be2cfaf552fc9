"""A leaning wall against volumes by hand, on outlines whose two ends are not alike, and where it must refuse."""

import numpy as np
import pytest
import shapely
import trimesh
from shapely.geometry import MultiPolygon

from skinfab.errors import RefusedError
from skinfab.mould_taper import tapered


def as_trimesh(solid: object) -> trimesh.Trimesh:
    mesh = solid.to_mesh64()  # type: ignore[attr-defined]
    return trimesh.Trimesh(mesh.vert_properties[:, :3], mesh.tri_verts.astype(np.int64), process=True)


def test_a_plate_with_a_hole_by_hand() -> None:
    # Outwards by 1 outside and inwards by 1 in the hole, 2 mm high: both are frusta.
    low = MultiPolygon([shapely.box(0, 0, 30, 20) - shapely.box(10, 5, 20, 15)])
    high = MultiPolygon([low.buffer(1, join_style="mitre")])
    solid = tapered(low, high, z=(0.0, 1.0, 3.0, 4.0))
    mesh = as_trimesh(solid)
    t = np.linspace(0, 1, 20_001)
    between = np.trapezoid((30 + 2 * t) * (20 + 2 * t) - (10 - 2 * t) ** 2, t) * 2
    assert mesh.is_watertight and mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(low.area + between + high.area, rel=1e-8)


def test_outlines_that_are_not_alike() -> None:
    # Below: two islands; above: one plate, and a notch that closes on the way up.
    low = MultiPolygon([shapely.box(1, 1, 9, 9), shapely.box(11, 1, 19, 9)])
    high = MultiPolygon([shapely.box(0, 0, 20, 10)])
    mesh = as_trimesh(tapered(low, high, z=(0.0, 1.0, 2.0, 3.0)))
    assert mesh.is_watertight and 128 + 128 + 200 < mesh.volume < 128 + 200 + 200
    sections = [mesh.section(plane_origin=[0, 0, z], plane_normal=[0, 0, 1]).discrete for z in (0.5, 1.2, 1.5, 1.8, 2.5)]
    areas = [sum(shapely.Polygon(loop[:, :2]).area for loop in loops) for loops in sections]
    assert (np.diff(areas) > 0).all() and areas[0] == pytest.approx(128) and areas[-1] == pytest.approx(200)


def test_outlines_that_touch_are_refused() -> None:
    low, high = MultiPolygon([shapely.box(0, 0, 4, 4)]), MultiPolygon([shapely.box(0, -1, 5, 5)])
    with pytest.raises(RefusedError, match=r"lower mould\.draft_deg"):
        tapered(low, high, z=(0.0, 1.0, 2.0, 3.0))
