"""Which surface is flattened. How offsetting fails is tested in stability/test_offset_fails.py."""

import numpy as np
import pytest
from shapes import sphere

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.mesh.surface import surface

V, F = sphere(3)
BALL = Mesh(20 * V, F)


def test_no_thickness_is_the_object_itself() -> None:
    found = surface(BALL)
    assert found.mesh is BALL and found.thickness == 0 and found.remarks == ()


@pytest.mark.parametrize(("thickness", "neutral"), [(2.0, 0.5), (3.0, 1.0), (2.0, 0.0)])
def test_it_lies_so_far_outside(thickness: float, neutral: float) -> None:
    found = surface(BALL, thickness=thickness, neutral=neutral)
    radius = np.linalg.norm(found.mesh.V, axis=1)
    np.testing.assert_allclose(radius, 20 + thickness * neutral, rtol=2e-3)
    assert found.thickness == thickness and found.neutral == neutral


def test_the_usual_thickness_is_taken_where_none_is_asked_for() -> None:
    assert surface(BALL, usual=2.5).thickness == 2.5
    (remark,) = surface(BALL, thickness=2.0, usual=2.5).remarks
    assert remark == "flattened for a skin 2 mm thick, but the material profile pours 2.5 mm; change one of them"


def test_thicker_than_the_object_is_refused() -> None:
    with pytest.raises(InputError, match="a skin 41 mm thick does not go on an object 40 mm long"):
        surface(BALL, thickness=41)
