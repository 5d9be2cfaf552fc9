"""A wrap encloses its object closely, bridges what the ball cannot enter, keeps what it can, and is the same each time."""

import igl
import numpy as np
import pytest
import trimesh

from skinfab.mesh.model import Mesh
from skinfab.mesh.wrap import WRAP_OFFSET, wrap


def of(solid: trimesh.Trimesh) -> Mesh:
    return Mesh(np.array(solid.vertices), np.array(solid.faces, dtype=np.int64), "part")


def drilled(width: float) -> trimesh.Trimesh:
    """A block of 40 x 30 x 20 mm with a hole straight through it."""
    hole = trimesh.creation.cylinder(radius=width / 2, height=60, sections=48)
    return trimesh.boolean.difference([trimesh.creation.box((40, 30, 20)), hole])


def genus(mesh: Mesh) -> int:
    assert mesh.topology.is_oriented_manifold and not mesh.topology.boundary_loops
    assert mesh.topology.face_components()[0] == 1
    return 1 - mesh.topology.euler // 2


@pytest.mark.parametrize(("width", "ball", "holes"), [(4.0, 8.0, 0), (7.0, 8.0, 0), (12.0, 8.0, 1), (4.0, 2.0, 1)])
def test_a_hole_is_bridged_by_a_ball_that_is_larger(width: float, ball: float, holes: int) -> None:
    block = of(drilled(width))
    assert genus(block) == 1
    wrapped = wrap(block, ball)
    assert genus(wrapped) == holes and wrapped.name == "part"
    outer = 2 * (40 * 30 + 40 * 20 + 30 * 20) - 2 * np.pi * width**2 / 4 * holes + np.pi * width * 20 * holes
    assert wrapped.area == pytest.approx(outer, rel=0.05)


def test_what_is_inside_is_not_there() -> None:
    outside = trimesh.creation.icosphere(subdivisions=4, radius=20)
    inside = trimesh.creation.icosphere(subdivisions=4, radius=17)
    inside.invert()
    hollow = of(trimesh.util.concatenate([outside, inside]))
    assert wrap(hollow, 5.0).area == pytest.approx(4 * np.pi * 20.125**2, rel=0.01)


@pytest.mark.parametrize("ball", [3.0, 8.0])
def test_it_encloses_and_is_as_close_as_it_says(ball: float) -> None:
    solid = drilled(12.0)
    wrapped = wrap(of(solid), ball)
    inner = of(solid)
    outward = igl.signed_distance(wrapped.V, inner.V, inner.F)[0]
    offset = ball * WRAP_OFFSET
    assert outward.min() == pytest.approx(offset, rel=0.1) and outward.max() < 1.5 * offset
    # Turned outward: the volume is that of the block and a layer of the offset.
    volume = np.einsum("ij,ij->i", wrapped.V[wrapped.F[:, 0]], wrapped.face_cross).sum() / 6
    assert 0 < volume - solid.volume < 1.5 * offset * solid.area


def test_the_same_each_time_and_whichever_way_faces_are_turned() -> None:
    part = of(drilled(4.0))
    first, second = wrap(part, 6.0), wrap(part, 6.0)
    assert first.V.tobytes() == second.V.tobytes() and first.F.tobytes() == second.F.tobytes()
    assert genus(wrap(Mesh(part.V, part.F[:, ::-1]), 6.0)) == 0
