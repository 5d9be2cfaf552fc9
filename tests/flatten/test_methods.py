"""Every method by its name: one table, one contract."""

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.flatten.distortion import singular_values
from skinfab.flatten.methods import METHODS, method


@pytest.mark.parametrize("name", METHODS)
def test_flattens_a_disk_right_side_up(name: str) -> None:
    V, F = shapes.wavy()
    uv = method(name)(V, F)
    assert uv.shape == (len(V), 2) and uv.dtype == np.float64
    assert (singular_values(V, F, uv) > 0).all()


@pytest.mark.parametrize("name", METHODS)
def test_refuses_what_is_no_disk(name: str) -> None:
    with pytest.raises(InputError, match="only a disk"):
        method(name)(*shapes.torus())


def test_names_what_there_is() -> None:
    with pytest.raises(InputError, match="no flattening method 'bfff'; there are bff, "):
        method("bfff")
