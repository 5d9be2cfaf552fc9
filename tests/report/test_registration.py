"""Registration: every mark of every mould by its coordinates, and the right word on homing."""

import re

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.report.registration import MouldPlace, registration_steps

CORNERS = np.array([[0.0, 0.0], [80, 0], [0, 50]])
PLACES = [MouldPlace(f"P{k}", f"gcode/P{k}.gcode", CORNERS + np.array([100.125 * k, 40.25])) for k in (1, 2)]


def test_every_mark_is_given_in_machine_coordinates() -> None:
    text = " ".join(registration_steps(PLACES, home="xy"))
    found = [(float(x), float(y)) for x, y in re.findall(r"X(\d+\.\d\d) Y(\d+\.\d\d)", text)]
    np.testing.assert_allclose(found, np.vstack([p.marks for p in PLACES]), atol=0.005 + 1e-9)


@pytest.mark.parametrize(("home", "says"), [("xyz", "bed empty"), ("xy", "X and Y only"), ("none", "does not home")])
def test_homing(home: str, says: str) -> None:
    assert says in registration_steps(PLACES, home=home)[0]
    with pytest.raises(InputError, match="home is 'zyx'"):
        registration_steps(PLACES, home="zyx")


def test_height_of_the_glass_is_the_programs() -> None:
    assert any("G92 Z0.00" in step for step in registration_steps(PLACES, home="xy"))
    assert any("G92 Z-1.60" in step for step in registration_steps(PLACES, home="xy", glass_z=-1.6))


def test_nothing_to_print_is_nothing_to_register() -> None:
    assert registration_steps([], home="xy") == []
