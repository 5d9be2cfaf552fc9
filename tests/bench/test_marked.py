"""A chart that marks no default, or gives no reason for it, is none; what the helper adds covers nothing and is in the file."""

import ast
from pathlib import Path

import pytest
from matplotlib.figure import Figure
from PIL import Image

from skinfab.bench import marked
from skinfab.bench.marked import ring, save

ROOT = Path(__file__).parents[2]
#: Pictures of a benchmark that show no choice, and what they show instead.
NO_CHOICE = {
    "array_chart.draw_seed": "figures of the paper, both ways",
    "nail_chart.draw_confusion": "what was taken for what",
    "nail_confidence.draw": "whether what is sure is right",
    "optical_chart.draw_reconstruction": "figures of the paper, both ways",
    "segment_growth.draw_growth": "how time and memory grow",
}


def test_each_chart_of_a_choice_is_saved_with_its_default() -> None:
    """Every function of the benchmarks that makes a PNG does so by `save`, which wants the default, but for those that show no choice."""
    saved, plain = set(), set()
    for path in [*(ROOT / "skinfab/bench").glob("*.py"), *(ROOT / "calibration/bench").glob("*.py"), ROOT / "gcode/bench_chart.py"]:
        for function in (node for node in ast.parse(path.read_text()).body if isinstance(node, ast.FunctionDef)):
            called = {node.func.id for node in ast.walk(function) if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
            methods = {node.func.attr for node in ast.walk(function) if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)}
            if path.stem != "marked":
                saved |= {f"{path.stem}.{function.name}"} if "save" in called else set()
                plain |= {f"{path.stem}.{function.name}"} if "png" in called or "savefig" in methods else set()
    assert plain == set(NO_CHOICE) and not saved & plain
    # docs/charts.md has a row for each of the others.
    assert len(saved) == (ROOT / "docs/charts.md").read_text().count("\n| [")


def a_figure() -> Figure:
    figure = Figure(figsize=(6.0, 3.0), layout="constrained")
    for axes in figure.subplots(1, 2):
        axes.plot([1, 2, 3], [9.0, 5.0, 4.9], "o-", label="a curve")
        axes.set_xlabel("what is varied")
    return figure


def test_a_chart_that_marks_nothing_is_refused(tmp_path: Path) -> None:
    figure = a_figure()
    figure.axes[0].plot(2, 5.0, "o", ms=14, mfc="none")  # some other mark is no ring
    with pytest.raises(ValueError, match=r"^a\.png: the default is marked nowhere; draw a ring round its point$"):
        save(figure, tmp_path / "a.png", default="two: a third gains 2 %")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("default", ["two", "two: ", ": a third gains 2 %"])
def test_a_default_without_a_reason_is_refused(default: str, tmp_path: Path) -> None:
    figure = a_figure()
    ring(figure.axes[1], 2, 5.0)
    with pytest.raises(ValueError, match="does not say what the default is and, after a colon, why"):
        save(figure, tmp_path / "a.png", default=default)
    assert not list(tmp_path.iterdir())


def test_the_reason_is_in_the_picture_and_in_its_file_and_covers_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[Figure] = []
    real = marked.png
    monkeypatch.setattr(marked, "png", lambda figure, description: drawn.append(figure) or real(figure, description=description))
    figure = a_figure()
    ring(figure.axes[0], 2, 5.0)
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", title="one key\nfor both")
    why = "two: " + "a third gains next to nothing and costs as much again, " * 6 + "µ"
    save(figure, tmp_path / "a.png", default=why, notes=["dots: measured"])
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.info["Description"] == f"The default is {why}."
    (words,) = figure.texts
    (key,) = figure.legends
    assert words.get_text().startswith("ring: the default, two: a third") and words.get_text().endswith("\ndots: measured")
    assert drawn == [figure] and words.get_text().count("\n") > 3
    box, of_key = words.get_window_extent(), key.get_window_extent()
    assert 0 <= box.x0 and box.x1 <= figure.bbox.x1 and box.y0 >= 0 and box.y1 <= of_key.y0
    assert all(axes.get_tightbbox().y0 >= of_key.y1 for axes in figure.axes)
    # The panels are as high as without the words: the figure grew.
    assert figure.get_figheight() > 3.6
