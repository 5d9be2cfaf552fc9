"""The figure over time: written whole, with gaps, many curves, and names that are no formulas."""

from pathlib import Path

import numpy as np
import pytest

from calibration.strain.time_figure import CURVES, draw_over_time


@pytest.mark.parametrize("count", [1, 2, CURVES + 3])
def test_it_is_drawn(tmp_path: Path, count: int) -> None:
    time = np.arange(500) / 100
    curves = {f"$S_{k}$_^": np.where(time > 2, np.nan, np.sin(time + k)) for k in range(count)}
    for name, magic in (("a.png", b"\x89PNG"), ("a.pdf", b"%PDF")):
        draw_over_time(time, curves, tmp_path / name, title="a$b", quantity="angle (deg)", simulated=True, flagged=time > 4)
        assert (tmp_path / name).read_bytes().startswith(magic)


def test_simulated_is_said_in_the_figure(tmp_path: Path) -> None:
    time = np.arange(10.0)
    sizes = []
    for simulated in (False, True):
        draw_over_time(time, {"a": time}, tmp_path / "a.png", title="t", quantity="q", simulated=simulated)
        sizes.append((tmp_path / "a.png").read_bytes())
    assert sizes[0] != sizes[1]
