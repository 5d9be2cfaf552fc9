"""The paper's experiment: who is asked what, that nothing learnt is asked again, and that it comes out near the paper."""

import math

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.nail.paper import ACCURACY
from skinfab.fingertip.nail.patterns import TESTS
from skinfab.fingertip.nail.protocol import Outcome, Protocol, Session, published_answers, session, sessions, study
from skinfab.fingertip.nail.published import CONDITIONS

SMALL = Protocol(participants=2, training=2, rounds=2, estimates=3, samples=64)
FULL = "AxAyAzGxGyGz"


@pytest.fixture(scope="module")
def outcomes() -> dict[str, Outcome]:
    """Half as many participants again as in the paper; one estimate a trial for ten, which changes the accuracies by less than a point."""

    def full(of: Session) -> dict[str, np.ndarray]:
        return published_answers(of, (FULL, "AxAy"))

    protocol = Protocol(participants=15, rounds=4, estimates=1, samples=256)
    return {test: study(sessions(test, protocol=protocol), full) for test in TESTS}


@pytest.mark.parametrize("test", list(TESTS))
def test_with_all_channels_the_published_method_is_as_right_as_in_the_paper(test: str, outcomes: dict[str, Outcome]) -> None:
    """Within the participants' standard deviation."""
    of = outcomes[test]
    assert 100 * of.mean(FULL) == pytest.approx(ACCURACY[test][FULL], abs=100 * of.deviation(FULL))


def test_the_poorest_condition_is_the_papers(outcomes: dict[str, Outcome]) -> None:
    for test in ("pins6", "edges12"):
        assert outcomes[test].mean("AxAy") < 0.8 * outcomes[test].mean(FULL)


def test_most_errors_among_twelve_edges_stay_in_their_row(outcomes: dict[str, Outcome]) -> None:
    """Two thirds of the wrong classes lie in other rows: by chance 3 of 11 errors would stay."""
    counts = outcomes["edges12"].confusion[FULL].counts[1:, 1:]
    row = np.arange(12) // 4
    wrong = ~np.eye(12, dtype=bool)
    assert counts[wrong & (row[:, None] == row)].sum() > 0.6 * counts[wrong].sum()


def test_a_session_has_what_the_paper_records() -> None:
    made = session("pins6", 1, protocol=SMALL)
    assert made.training.classes.tolist() == [k for k in range(7) for _ in range(2)]
    assert made.rounds.classes.tolist() == [1, 2, 3, 4, 5, 6] * 2
    assert made.training.readings.shape == (14, 1, 64, 6) and made.rounds.readings.shape == (12, 3, 64, 6)
    for trials in (made.training, made.rounds):
        assert [each.pattern for each in trials.touches] == [None if k == 0 else TESTS["pins6"][k - 1] for k in trials.classes]


def test_nothing_that_was_learnt_is_asked() -> None:
    made = session("edges4", 1, protocol=SMALL)
    learnt = {(each.x_mm, each.y_mm) for each in made.training.touches if not math.isnan(each.x_mm)}
    assert not learnt & {(each.x_mm, each.y_mm) for each in made.rounds.touches}


def test_the_same_person_comes_to_all_tests_and_others_with_another_seed() -> None:
    a, b, other, seeded = (
        session("edges4", 2, protocol=SMALL),
        session("edges12", 2, protocol=SMALL),
        session("edges4", 1, protocol=SMALL),
        session("edges4", 2, protocol=SMALL, seed=1),
    )
    assert a.finger.contact_n_per_m == b.finger.contact_n_per_m
    assert len({each.finger.contact_n_per_m for each in (a, other, seeded)}) == 3
    again = session("edges4", 2, protocol=SMALL)
    np.testing.assert_array_equal(a.rounds.readings, again.rounds.readings)


def test_outcomes_count_what_was_said() -> None:
    """A method that knows everything but takes every third trial for no contact."""

    def answers(of: Session) -> dict[str, np.ndarray]:
        said = of.rounds.classes.copy()
        said[::3] = 0
        return {"ours": said}

    seen: list[int] = []
    found = study(sessions("edges4", protocol=SMALL), answers, told=lambda each: seen.append(each.participant))
    assert seen == [1, 2]
    assert found.accuracy["ours"].tolist() == [5 / 8, 5 / 8] and found.deviation("ours") == 0.0
    counts = found.confusion["ours"].counts
    assert counts[0].sum() == 0 and counts[1:, 0].sum() == 6 and np.trace(counts) == 10 == counts.sum() - 6


def test_the_published_method_learns_nothing_from_noise() -> None:
    """The same classes, and readings that hold none of them."""
    made = session("edges4", 1, protocol=Protocol(training=5, rounds=10, estimates=1, samples=64))
    rng = np.random.default_rng(0)
    for trials in (made.training, made.rounds):
        trials.readings[:] = rng.normal(size=trials.readings.shape)
    right = [(said == made.rounds.classes).mean() for said in published_answers(made).values()]
    assert len(right) == len(CONDITIONS) and np.mean(right) < 0.35


def test_what_is_no_test_is_refused() -> None:
    with pytest.raises(InputError, match="no test 'edges5'"):
        session("edges5", 1)
    with pytest.raises(InputError, match="0 rounds"):
        Protocol(rounds=0)
    two = [session("edges4", 1, protocol=SMALL), session("pins6", 1, protocol=SMALL)]
    with pytest.raises(InputError, match="edges4 and pins6"):
        study(two)
    with pytest.raises(InputError, match="no session"):
        study([])
