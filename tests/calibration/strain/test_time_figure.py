"""The figure over time: written whole, with gaps, many panels, and names that are no formulas."""

from pathlib import Path

import numpy as np
import pytest

from calibration.strain.time_figure import PANELS, Panel, draw_over_time

TIME = np.arange(500) / 100


@pytest.mark.parametrize("count", [1, 2, 7, PANELS + 3])
def test_it_is_drawn(tmp_path: Path, count: int) -> None:
    panels = [Panel(f"$S_{k}$_^", {f"$S_{k}$": np.where(TIME > 2, np.nan, np.sin(TIME + k))}) for k in range(count)]
    draw_over_time(TIME, panels, tmp_path / "a.png", title="a$b", simulated=True)
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_a_panel_of_two_curves_that_is_flagged_and_one_without_readings(tmp_path: Path) -> None:
    angle = Panel("angle (deg)", {"truth$": TIME, "read$": TIME + 1}, TIME > 4)
    for name, magic in (("a.png", b"\x89PNG"), ("a.pdf", b"%PDF")):
        draw_over_time(TIME, [angle, Panel("U", {"U": np.full(500, np.nan)})], tmp_path / name, title="t", simulated=False)
        assert (tmp_path / name).read_bytes().startswith(magic)


def test_every_channel_has_a_panel_with_an_axis_of_its_own(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """On one axis volts beside kiloohms, or a change of 1 % beside one of 40 %, are flat lines."""
    from matplotlib.figure import Figure

    drawn: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, stream, **options: drawn.append(figure))
    for count in (3, 10, PANELS + 1):
        panels = [Panel(f"S{k}", {f"S{k}": 10.0**k * (1 + 0.1 * np.sin(TIME))}) for k in range(count)]
        draw_over_time(TIME, panels, tmp_path / "a.png", title="t", simulated=False)
        axes = drawn[-1].axes
        assert len(axes) == min(count, PANELS)
        spans = [np.ptp(each.lines[0].get_ydata()) / np.ptp(each.get_ylim()) for each in axes]
        assert min(spans) > 0.8
        assert [each.get_xlabel() for each in axes].count("time (s)") >= 1
        said = drawn[-1].get_suptitle()
        assert ("the first 32 of 33" in said) is (count > PANELS)


def test_simulated_is_said_in_the_figure(tmp_path: Path) -> None:
    sizes = []
    for simulated in (False, True):
        draw_over_time(TIME, [Panel("q", {"a": TIME})], tmp_path / "a.png", title="t", simulated=simulated)
        sizes.append((tmp_path / "a.png").read_bytes())
    assert sizes[0] != sizes[1]
