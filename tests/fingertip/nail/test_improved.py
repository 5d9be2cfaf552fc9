"""The improved method on the paper's protocol: better than the published one on the very trials it is asked about."""

import numpy as np

from skinfab.fingertip.nail.improved import asked, improved_answers, label_of, usable
from skinfab.fingertip.nail.protocol import Protocol, published_answers, session, sessions
from skinfab.fingertip.nail.simulator import nail_stream


def test_better_than_published_on_the_same_trials() -> None:
    right: dict[str, list[float]] = {}
    for each in sessions("edges12", protocol=Protocol(participants=5, rounds=4, estimates=1, samples=256), seed=12):
        answers = {
            "published": published_answers(each, ["AxAyAzGxGyGz"])["AxAyAzGxGyGz"],
            "improved": improved_answers(each)["improved"],
            "short": improved_answers(each, 33)["improved"],
        }
        for name, said in answers.items():
            right.setdefault(name, []).append(float((said == each.rounds.classes).mean()))
    mean = {name: np.mean(each) for name, each in right.items()}
    assert mean["published"] + 0.02 < mean["short"] and mean["published"] + 0.04 < mean["improved"]


def test_readings_at_an_end_of_the_range_are_none() -> None:
    ends = np.array([channel.high for channel in nail_stream().channels])
    values = np.stack([0.5 * ends, ends, -ends])[None]
    assert np.isnan(usable(values)).sum(axis=(0, 2)).tolist() == [0, 6, 6]


def test_labels_say_what_was_aimed_at_and_where_it_lay() -> None:
    each = session("edges4", 1, protocol=Protocol(training=1, rounds=1, estimates=2, samples=32))
    nothing, first = label_of(each.training.touches[0]), label_of(each.training.touches[1])
    assert nothing.label == "none" and nothing.force_n == 0
    assert (first.label, first.x_mm, first.angle_deg) == ("longitudinal", 0.0, 90.0) and first.true_angle_deg != 90
    assert asked(each).shape == (4, 64, 6) and asked(each, 8).shape == (4, 8, 6)
