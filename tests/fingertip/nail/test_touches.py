"""Which rows are of one touch: by their name, else where they follow one another; parts of a touch are held out together."""

from dataclasses import replace

from skinfab.fingertip.nail.labels import Label
from skinfab.fingertip.nail.touches import touches_of


def cut(touches: int, parts: int, label: str, *, gap: float = 0.5, start: float = 0.0) -> list[Label]:
    """Touches of 0.4 s, each cut into rows."""
    begin = [start + k * (0.4 + gap) for k in range(touches)]
    return [Label("a.csv", b + j * 0.4 / parts, b + (j + 1) * 0.4 / parts, label, "Ann") for b in begin for j in range(parts)]


def test_rows_that_follow_one_another_are_one_touch() -> None:
    rows = cut(3, 4, "pin") + cut(2, 4, "none", start=9.0)
    names, notes = touches_of(rows)
    assert [len({*names[k : k + 4]}) for k in range(0, 20, 4)] == [1] * 5 and len(set(names)) == 5
    assert notes == [
        "20 rows have no name in the column trial and are taken for 5 touches, where those of one label that follow one another without a "
        "gap are one; name them if they are not"
    ]
    assert touches_of(rows[::-1])[0] == touches_of(rows[::-1])[0] and len(set(touches_of(rows[::-1])[0])) == 5  # in any order
    assert len(set(touches_of([replace(each, log=f"{k}.csv") for k, each in enumerate(rows)])[0])) == 20
    other = [replace(each, participant="AB"[k % 2]) for k, each in enumerate(rows)]
    assert len(set(touches_of(other)[0])) == 20


def test_names_rule() -> None:
    named = [replace(each, trial=str(k // 2)) for k, each in enumerate(cut(1, 4, "pin"))]
    assert touches_of(named) == (["Ann/0", "Ann/0", "Ann/1", "Ann/1"], [])


def test_a_class_that_is_one_long_touch_is_held_out_row_by_row_and_told() -> None:
    rows = cut(3, 2, "pin") + cut(1, 4, "none", start=9.0)
    names, notes = touches_of(rows)
    assert len(set(names[:6])) == 3 and len(set(names[6:])) == 4
    assert "all rows of none follow one another and are held out one by one: if they are parts of one touch, more is right" in notes[1]
