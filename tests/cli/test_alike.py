"""Warnings of a kind are told once; what differs in more than names and numbers is told apart."""

import pytest

from skinfab.cli.alike import alike


def test_names_numbers_and_plurals_do_not_tell_warnings_apart() -> None:
    said = alike(
        [
            "piece P1: 2 darts narrower than 0.4 mm over 10.8 mm near (70.6, -2) mm",
            "piece P1: the outline touches itself",
            "piece P12: 1 dart narrower than 0.4 mm over 1.7 mm near (1e-05, 3) mm",
            "piece P3: 1 dart narrower than 0.4 mm over 1.7 mm near (7, 3) mm",
        ]
    )
    assert said == [
        "3 pieces, first P1: 2 darts narrower than 0.4 mm over 10.8 mm near (70.6, -2) mm",
        "piece P1: the outline touches itself",
    ]


def test_subjects_of_other_kinds_and_warnings_about_the_whole_stay_apart() -> None:
    warnings = ["sensor C1: 12 % off", "piece P1: 12 % off", "all 3 are off", "all 4 are off"]
    assert alike(warnings) == warnings


def test_a_sentence_without_a_colon_is_a_sentence_still() -> None:
    assert alike(["piece P9 is too small (3.9 mm^2)", "piece P10 is too small (1 mm^2)"]) == ["2 pieces, first P9 is too small (3.9 mm^2)"]


def test_one_piece_with_several_alike() -> None:
    assert alike(["piece P1: a hole at 3 mm", "piece P1: a hole at 5 mm"]) == ["piece P1: a hole at 3 mm (and 1 more like it)"]


@pytest.mark.parametrize(("number", "told"), [(7, "P1, P2, P3, P4, P5, P6 and P7"), (8, "P1, P2, P3, P4 and 4 more")])
def test_long_lists_are_cut_short(number: int, told: str) -> None:
    names = [f"P{k}" for k in range(1, number + 1)]
    assert alike([f"pieces {', '.join(names[:-1])} and {names[-1]} have no sensor"]) == [f"pieces {told} have no sensor"]
