"""Shared fixtures: the cube, open in the window."""

import pytest
from person import MESHES


@pytest.fixture
def cube(person):
    person.open(MESHES / "cube.obj")
    return person
