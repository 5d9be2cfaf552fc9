"""The chart of shapes: new objects are new, rejecting costs answers, and its sentence holds nothing that its tables do not."""

from pathlib import Path

import pytest

from skinfab.bench import shape
from skinfab.bench.flatten import read_csv, write_csv
from skinfab.bench.shape_chart import draw
from skinfab.fingertip.force.grasp import LEARNED, NEW


@pytest.fixture(scope="module")
def measured() -> tuple:
    with pytest.MonkeyPatch.context() as fewer:
        fewer.setattr(shape, "GRASPS", 8)
        return shape.measure(seeds=(0,), asked=8, yaws=(180.0,), repeats=1)


@pytest.fixture(scope="module")
def sizes() -> list[shape.Sizes]:
    return shape.reconstructions(grasps=6)


def test_new_objects_are_new() -> None:
    assert not set(LEARNED) & set(NEW)


def test_surer_answers_are_fewer(measured: tuple) -> None:
    rows, confusions = measured
    for features in shape.FEATURES:
        answered = [row.answered for row in rows if row.features == features]
        assert answered[0] == 1 and answered == sorted(answered, reverse=True)
        assert confusions[features].counts.sum() == 24
    right = {row.features: row.right for row in rows if row.confidence == 0}
    assert right["misfits"] > right["published"]


def test_all_sides_are_judged_both_ways_on_the_same_grasps(sizes: list[shape.Sizes]) -> None:
    assert [(row.solid.split()[0], row.way, row.side) for row in sizes] == [
        *(("sphere", way, 0) for way in ("published", "fit")),
        *(("cylinder", way, 0) for way in ("published", "fit")),
        *(("cuboid", way, side) for way in ("published", "fit") for side in range(3)),
    ]
    assert all(abs(row.median_mm - row.true_mm) < 15 for row in sizes)


def test_the_sentence_and_the_chart_come_from_the_tables(measured: tuple, sizes: list, tmp_path: Path) -> None:
    write_csv(measured[0], tmp_path / "a.csv")
    write_csv(sizes, tmp_path / "b.csv")
    table, solved = read_csv(tmp_path / "a.csv"), read_csv(tmp_path / "b.csv")
    said = shape.sentence(table, [{"features": "misfits", "grasps": 1.7, "right": 0.987}], solved)
    assert "1.7 grasps" in said and "98.7%" in said and "simulated" in said
    draw(table, solved, tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
