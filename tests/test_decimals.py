"""Numbers from bytes and bytes from numbers agree with Python's own, digit by digit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.decimals import SIGNIFICANT, counts, read_floats, read_ints, words, write_rows


def read(text: str) -> list[float] | None:
    data = np.frombuffer(f" {text}\n".encode(), np.uint8)
    found = read_floats(data, *words(data))
    return None if found is None else found.tolist()


plain = st.builds(
    lambda sign, whole, decimals: f"{sign}{whole}{decimals}",
    st.sampled_from(["", "-", "+"]),
    st.integers(0, 10**12).map(str),
    st.one_of(st.just(""), st.just("."), st.text("0123456789", min_size=1, max_size=20).map(".{}".format)),
)


@given(st.lists(plain, min_size=1, max_size=8))
def test_plain_numbers_are_read_as_python_reads_them(numbers: list[str]) -> None:
    assert read(" ".join(numbers)) == [float(n) for n in numbers]


@given(st.lists(st.floats(allow_nan=False), min_size=1, max_size=8))
def test_every_double_is_read_back(numbers: list[float]) -> None:
    assert read(" ".join(map(repr, numbers))) == numbers


def test_digits_that_a_double_cannot_hold_are_rounded_right() -> None:
    # 2**53 + 1 lies half-way between two doubles; over ten it must not be rounded twice.
    hard = ["9007199254740993", "900719925474099.3", "0.1000000000000000055511151231257827", "5e-324", ".5", "5.", "-0.0"]
    assert read("  ".join(hard)) == [float(n) for n in hard]


@pytest.mark.parametrize(
    "text", ["1.2.3", "1.2 3.4.5", ".", "1 . 2", "-", "1-2", "0x10", "1,5", "1.5 abc", "1_000", "--5", "1.5 2."[:4] + "e"]
)
def test_what_is_no_number_is_not_read(text: str) -> None:
    assert read(text) is None


def test_dots_that_another_word_lacks_are_not_lent_to_it() -> None:
    # As many dots as words, but two in one of them.
    assert read("1.2.3 4") is None
    assert read("1 2.5 3") == [1.0, 2.5, 3.0]


def test_a_few_exponents_among_many_plain_numbers() -> None:
    numbers = [f"{k}.25" for k in range(200)]
    numbers[7], numbers[150] = "-8.02e-05", "1E3"
    assert read(" ".join(numbers)) == [float(n) for n in numbers]
    assert read(" ".join([*numbers, "1e"])) is None
    assert read(" ".join([*numbers, "12_5.0"])) is None


def test_whole_numbers() -> None:
    text = np.frombuffer(b" 7 -3\r\n 12\t0\n", np.uint8)
    found = read_ints(text, *words(text))
    assert found is not None and found.tolist() == [7, -3, 12, 0]
    for wrong in (b" 1.5\n", b" 1 -\n", b" +\n"):
        text = np.frombuffer(wrong, np.uint8)
        assert read_ints(text, *words(text)) is None


@given(st.lists(st.floats(-1, 1), min_size=3, max_size=9), st.integers(-30, 30))
def test_written_numbers_keep_their_digits(values: list[float], power: int) -> None:
    rows = np.array(values[: len(values) // 3 * 3]).reshape(-1, 3) * 10.0**power
    lines = write_rows(b"v", rows).decode().splitlines()
    again = np.array([[float(word) for word in line.split()[1:]] for line in lines])
    assert [line.split()[0] for line in lines] == ["v"] * len(rows)
    np.testing.assert_allclose(again, rows, rtol=0, atol=0.51 * 10.0 ** (1 - SIGNIFICANT) * np.abs(rows).max())


@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1.0, 1e3, 1e6])
def test_nine_significant_digits_in_any_unit(unit: float) -> None:
    rows = np.random.default_rng(0).uniform(-90, 90, (500, 3)) * unit
    again = np.array([line.split()[1:] for line in write_rows(b"v", rows).decode().splitlines()], dtype=float)
    np.testing.assert_allclose(again, rows, rtol=1e-9)


def test_numbers_are_written_as_a_person_would() -> None:
    rows = np.array([[0.0, -0.0, 10.0], [-0.5, 1e-20, 9.9999999999999999], [0.1, 100.25, -7.0]])
    assert write_rows(b"vt", rows) == b"vt 0 0 10\nvt -0.5 0 10\nvt 0.1 100.25 -7\n"
    assert write_rows(b"v", np.zeros((1, 2))) == b"v 0 0\n"
    assert write_rows(b"v", np.zeros((0, 2))) == b""


def test_a_number_that_rounds_up_to_another_digit() -> None:
    just_below = np.nextafter(10.0, 0)
    assert write_rows(b"v", np.array([[just_below, 1.0]])) == b"v 10 1\n"


def test_numbers_beyond_plain_decimals_have_exponents() -> None:
    assert write_rows(b"v", np.array([[1e-9, 2.5e-9]])) == b"v 1e-09 2.5e-09\n"
    assert write_rows(b"v", np.array([[1e20, 1.0]])) == b"v 1e+20 1\n"


@given(st.lists(st.integers(0, 10**15), min_size=1, max_size=6))
def test_counts_spell_whole_numbers(numbers: list[int]) -> None:
    rows = counts(np.array(numbers))
    assert [bytes(row[row != 0]).decode() for row in rows] == [str(n) for n in numbers]
