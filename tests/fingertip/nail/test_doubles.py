"""The same readings twice in a table: a row given twice counts once, and what contradicts or overlaps is refused."""

from dataclasses import replace
from pathlib import Path

import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.doubles import without_doubles
from skinfab.fingertip.nail.labels import Label

TABLE = Path("some/labels.csv")
ROWS = [Label("a.csv", k / 1400 * 700, (k + 1) / 1400 * 700, "pin", "Ann", str(k), x_mm=3.0) for k in range(4)]


def asked(labels: list[Label], logs: list[str] | None = None) -> tuple[list[int], list[str]]:
    return without_doubles(labels, logs or [each.log for each in labels], TABLE)


def test_trials_one_after_the_other_all_count() -> None:
    assert asked(ROWS) == ([0, 1, 2, 3], [])
    rounded = [replace(each, start_s=round(each.start_s, 3), end_s=round(each.end_s + 3e-4, 3)) for each in ROWS]
    assert asked(rounded) == ([0, 1, 2, 3], [])


def test_a_row_given_twice_or_thrice_counts_once() -> None:
    copy = replace(ROWS[2], trial="17")
    assert asked([copy, *ROWS, copy])[0] == [0, 1, 2, 4]  # the first of the three stays
    assert asked([*ROWS, *ROWS]) == ([0, 1, 2, 3], ["labels.csv: 4 rows are there twice, and count once"])


def test_a_copy_of_the_log_is_the_same_log() -> None:
    other = [replace(each, log="b.csv") for each in ROWS]
    assert asked([*ROWS, *other])[0] == list(range(8))
    assert asked([*ROWS, *other], ["hash"] * 8)[0] == [0, 1, 2, 3]


@pytest.mark.parametrize(
    ("other", "says"),
    [
        (replace(ROWS[1], label="edge"), r"0\.5 to 1 s twice, with label 'pin' and 'edge'; leave one of the rows out"),
        (replace(ROWS[1], part="test"), "with part '' and 'test'"),
        (replace(ROWS[1], participant="Bo"), "with participant 'Ann' and 'Bo'"),
        (replace(ROWS[1], x_mm=float("nan")), "with x_mm 3.0 and nan"),
        (replace(ROWS[1], start_s=0.6), "readings in common, which would judge a model that knows them; shorten one"),
        (replace(ROWS[1], start_s=0.1, end_s=1.9), "readings in common"),
    ],
)
def test_what_contradicts_or_overlaps_is_refused(other: Label, says: str) -> None:
    with pytest.raises(InputError, match=rf"^some/labels.csv: .*{says}"):
        asked([*ROWS, other])


def test_a_long_row_hides_no_other_overlap() -> None:
    rows = [Label("a.csv", 0.0, 10.0, "pin"), Label("a.csv", 10.0, 11.0, "pin"), Label("a.csv", 10.5, 12.0, "pin")]
    with pytest.raises(InputError, match=r"10 to 11 s and of 10\.5 to 12 s"):
        asked(rows)
