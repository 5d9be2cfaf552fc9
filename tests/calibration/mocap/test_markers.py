"""Markers by their label, and what was not seen."""

from pathlib import Path

import numpy as np
import pytest

from calibration.mocap.markers import Markers, in_mm, masked, read_markers
from skinfab.errors import InputError


def made() -> Markers:
    here = np.ones((3, 3))
    positions = {"A:PIP": here, "B:PIP": 2 * here, "DIP": 3 * here, "A:DIP": 4 * here, "B:MCP": 5 * here, "gone": np.nan * here}
    return Markers("a.c3d", "", 100.0, np.arange(3) / 100, positions, ())


def test_a_label_with_and_without_its_subject() -> None:
    assert made().marker("MCP")[0, 0] == made().marker("B:MCP")[0, 0] == 5
    assert made().marker("DIP")[0, 0] == 3  # what is called just that goes first


@pytest.mark.parametrize(
    ("label", "says"), [("PIP", "2 markers 'PIP': A:PIP, B:PIP"), ("TIP", "no marker 'TIP'; it has A:PIP"), ("gone", "never seen")]
)
def test_labels_that_name_none(label: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        made().marker(label)


def test_one_coordinate_that_is_missing_is_the_marker_missing() -> None:
    at = np.array([[1.0, np.nan, 2.0], [1.0, -16512.0, 2.0], [np.inf, 1.0, 2.0], [1.0, 0.0, 0.0]])
    assert np.isnan(masked(at)).all(axis=1).tolist() == [True, True, True, False]


def test_units() -> None:
    assert [in_mm(unit, "") for unit in ("mm", "MM ", "m", "cm", "in")] == [1, 1, 1000, 10, 25.4]
    with pytest.raises(InputError, match="here: positions are in 'deg'"):
        in_mm("deg", "here")


def test_what_is_no_file(tmp_path: Path) -> None:
    for path, says in ((tmp_path, "no file"), (tmp_path / "none", "not there"), (Path("/dev/zero"), "no file")):
        with pytest.raises(InputError, match=says):
            read_markers(path)
