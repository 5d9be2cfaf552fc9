"""Pads: filled, outside the leads, one stroke with the conductor."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.pads import pad_stroke
from skinfab.patterns.strain_lines import StrainLines


@given(st.floats(0.2, 2), st.floats(2, 20), st.booleans())
def test_the_stroke_fills_its_square(bead: float, sides: float, upward: bool) -> None:
    side = sides * bead
    stroke = pad_stroke(at=(0, 0), side=side, bead=bead, upward=upward)
    low, high = stroke.bbox
    reach = side - bead
    np.testing.assert_allclose((low, high), ((-reach, 0), (0, reach)) if upward else ((-reach, -reach), (0, 0)), atol=1e-9)
    ink = shapely.LineString(stroke.to_polyline(tolerance=1)).buffer(bead / 2 * (1 + 1e-6), cap_style="square", join_style="mitre")
    assert ink.area == pytest.approx(side**2, rel=1e-4)


@pytest.mark.parametrize("pattern", [ContactSpiral(n=3, x=1.7, b=1.5, l=3, s=15), StrainLines(l1=60, l2=54, b=6)])
def test_one_stroke_pad_conductor_pad(pattern: ContactSpiral | StrainLines) -> None:
    printed, path = pattern.printed_path(), pattern.path()
    assert printed.length > path.length + 2 * (pattern.pad - pattern.bead)
    rows = [s for s in printed.segments if s.bbox[1, 0] <= 1e-9]  # everything left of the leads' ends
    lower = [s for s in rows if s.bbox[1, 1] <= 1e-9]
    upper = [s for s in rows if s.bbox[0, 1] >= pattern.b - 1e-9]
    assert len(lower) + len(upper) == len(rows) and len(lower) == len(upper) > 2
    assert [s.length for s in printed.segments[len(lower) : -len(upper)]] == [s.length for s in path.segments]
    assert printed.bbox[0, 0] == pytest.approx(-(pattern.pad - pattern.bead))


def test_no_pad() -> None:
    bare = StrainLines(l1=60, l2=54, b=6, pad=0)
    assert bare.printed_path().length == bare.path().length
