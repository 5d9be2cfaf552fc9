"""The unit guess at the sizes it was made for, and at its borders."""

import pytest

from skinfab.errors import InputError
from skinfab.mesh.units import guess_units, mm_per


@pytest.mark.parametrize(
    ("extent", "units"),
    [(0.19, "m"), (0.024, "m"), (0.5, "m"), (1.99, "cm"), (12, "cm"), (0.989, "in"), (15, "mm"), (55, "mm"), (1000, "mm")],
)
def test_usual_sizes(extent: float, units: str) -> None:
    guess = guess_units(extent)
    assert guess.units == units and guess.sure
    assert f"taken as {units}" in guess.reason


@pytest.mark.parametrize("extent", [0.0, 1e-6, 0.0149, 1001, 1e6])
def test_unusual_sizes_say_so(extent: float) -> None:
    guess = guess_units(extent)
    assert guess.units == "mm" and not guess.sure
    assert "--units" in guess.reason


def test_unknown_unit() -> None:
    with pytest.raises(InputError, match="'ft' is not known; use one of mm, cm, m, in"):
        mm_per("ft")
