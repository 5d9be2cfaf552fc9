"""The charts of the nail's bench: whole marks, keys that cover nothing, classes with their names."""

from pathlib import Path
from typing import Any

import pytest

from skinfab.bench import nail_chart, nail_window_chart
from skinfab.fingertip.confusion import Confusion
from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.protocol import Outcome
from skinfab.fingertip.nail.published import CONDITIONS

FULL = "AxAyAzGxGyGz"


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The figures that are drawn."""
    figures: list[Any] = []
    for module in (nail_chart, nail_window_chart):
        monkeypatch.setattr(module, "png", lambda figure: figures.append(figure) or b"", raising=False)
    monkeypatch.setattr("skinfab.bench.marked.png", lambda figure, description: figures.append(figure) or b"")
    return figures


def test_a_mark_at_100_percent_is_whole_and_no_key_covers_it(drawn: list[Any], tmp_path: Path) -> None:
    row = {"test": "pins6", "condition": FULL, "method": "published", "percent": 92.0, "deviation": 5.0, "paper": 91.3, "around": 0}
    better = row | {"method": "improved", "percent": 100.0, "paper": None}
    nail_chart.draw_accuracy([row, row | {"condition": "AyAz", "paper": 50.0, "around": 1}, better], tmp_path / "a.png")
    (figure,) = drawn
    (axes,) = figure.axes
    figure.draw_without_rendering()
    # The triangle is 8 points high.
    assert axes.transData.transform((0, 100))[1] + 4 * figure.dpi / 72 < axes.transData.transform((0, axes.get_ylim()[1]))[1]
    assert axes.get_legend() is None
    (key,) = figure.legends
    assert not key.get_window_extent().overlaps(axes.get_window_extent())
    assert [text.get_text() for text in key.get_texts()] == ["paper", 'paper, "around 50 %"', "improved method", "published method"]


def test_the_windows_key_covers_no_curve(drawn: list[Any], tmp_path: Path) -> None:
    row = {"method": "improved", "samples": 33, "percent": 86.0, "low": 84.0, "high": 88.0, "latency_ms": 24.0, "angle_deg": 6.0}
    row |= {"weighted_angle_deg": 9.0, "default": 1}
    nail_window_chart.draw([row, row | {"samples": 8, "latency_ms": 6.0, "default": 0}], tmp_path / "w.png")
    (figure,) = drawn
    figure.draw_without_rendering()
    (key,) = figure.legends
    for axes in figure.axes:
        assert axes.get_legend() is None and not key.get_window_extent().overlaps(axes.get_window_extent())


@pytest.mark.parametrize("test", TESTS)
def test_the_confusions_classes_have_names_within_the_picture(test: str, drawn: list[Any], tmp_path: Path) -> None:
    names = tuple(str(k) for k in range(len(TESTS[test]) + 1))
    confusion = Confusion.of(names[1:], names[1:], names)
    nail_chart.draw_confusion(Outcome(test, {}, dict.fromkeys(CONDITIONS, confusion)), tmp_path / "c.png")
    (figure,) = drawn
    figure.draw_without_rendering()
    left, below = figure.axes[0], figure.axes[-1]
    assert [text.get_text() for text in left.get_yticklabels()] == [f"{k} {each.name}" for k, each in enumerate(TESTS[test], 1)]
    assert below.get_xticklabels()[0].get_text() == "0 no contact" and below.get_xlabel() == "taken for" and left.get_ylabel() == "was"
    for part in (left.yaxis.label, below.xaxis.label, *left.get_yticklabels(), *below.get_xticklabels()):
        box = part.get_window_extent()
        assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= figure.bbox.x1
    assert left.get_ylim() == (len(names) - 0.5, 0.5)
