"""Numbers that no float can hold are refused where they stand."""

import pytest

from skinfab.strict_json import strict_json


def test_the_largest_numbers_are_read() -> None:
    said = strict_json("[1000000000000000000000, -9223372036854775809, 1.7976931348623157e308, -0.0, 5e-324, 1e-999]")
    assert said == [10**21, -(2**63) - 1, 1.7976931348623157e308, 0.0, 5e-324, 0.0]


@pytest.mark.parametrize("text", ["9" * 309, "-" + "9" * 309, "9" * 400, "9" * 5000, "1e309", "-1e309", "1" * 400 + ".5", "1e999999999999"])
def test_what_is_too_large_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=f"^{text[:20]} is too large a number$"):
        strict_json(f'{{"a": [{text}]}}')


@pytest.mark.parametrize("word", ["NaN", "Infinity", "-Infinity"])
def test_words_for_numbers_are_refused(word: str) -> None:
    with pytest.raises(ValueError, match=f"{word} is not a number"):
        strict_json(word)
