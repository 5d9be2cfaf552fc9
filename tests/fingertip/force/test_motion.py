"""Sliding, separation and rolling: each found once, in time, alike from a log and from a stream; and nothing else."""

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.force.motion import ROLLING, SEPARATION, SLIDING, Limits, Motion, MotionWatch, find_motions

RATE = 200
TIME = np.arange(4 * RATE) / RATE


def held(
    *, lean_deg: np.ndarray | float = 8.0, polar: np.ndarray | float = 0.0, size: np.ndarray | float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Force and moment of a contact on the dome, with the sensor's noise."""
    lean, angle, force = (np.broadcast_to(np.asarray(x, dtype=float), TIME.shape) for x in (np.radians(lean_deg), polar, size))
    out = np.column_stack([np.sin(angle), 0 * angle, np.cos(angle)])
    f = force[:, None] * (np.sin(lean)[:, None] * [0, 1, 0] - np.cos(lean)[:, None] * out)
    rng = np.random.default_rng(5)
    return f + 0.02 * rng.standard_normal(f.shape), np.cross(20 * out, f) + 0.2 * rng.standard_normal(f.shape)


def found(force: np.ndarray, moment: np.ndarray, time: np.ndarray = TIME) -> list[Motion]:
    return find_motions(time, force, moment, MotionWatch(Limits(30.0), rate_hz=RATE))


def bump(a: float, b: float, rise: float = 0.04) -> np.ndarray:
    return np.clip(np.minimum(TIME - a, b - TIME) / rise + 0.5, 0, 1)


SLIDE = {"lean_deg": 8 + 19 * bump(1, 2)}
ROLL = {"polar": np.clip(TIME - 1, 0, 1) * 0.6}
APART = {"size": 1 - bump(1, 2)}


@pytest.mark.parametrize(("what", "kind"), [(SLIDE, SLIDING), (ROLL, ROLLING), (APART, SEPARATION)], ids=["slide", "roll", "apart"])
def test_each_is_found_once_and_in_time(what: dict, kind: str) -> None:
    (only,) = found(*held(**what))
    assert only.kind == kind and (only.start, only.end) == pytest.approx((1, 2), abs=0.12)
    assert only.start <= only.told < 1.2


@pytest.mark.parametrize(
    "what",
    [{}, {"lean_deg": 8 + 15 * bump(1, 3, 0.8)}, {"size": 1 - 0.35 * bump(1, 3)}, {"size": 0.5}, {"lean_deg": 8 + 9 * bump(1, 3)}],
    ids=["held", "nearly slides", "held lighter", "held weakly", "tug"],
)
def test_what_only_looks_like_it_is_none(what: dict) -> None:
    assert found(*held(**what)) == []


@pytest.mark.parametrize("what", [SLIDE, ROLL, APART], ids=["slide", "roll", "apart"])
def test_a_stream_gives_what_a_log_gives(what: dict) -> None:
    force, moment = held(**what)
    watch = MotionWatch(Limits(30.0), rate_hz=RATE)
    streamed = [event for k in range(len(TIME)) for event in watch.step(float(TIME[k]), force[k], moment[k])]
    assert streamed == MotionWatch(Limits(30.0), rate_hz=RATE).run(TIME, force, moment)
    assert len(streamed) == 2 and streamed[0].lasting and not streamed[1].lasting


def test_a_lighter_grip_is_a_drop_that_settles() -> None:
    (only,) = found(*held(size=1.5 - np.clip((TIME - 1) / 0.1, 0, 1)))
    assert only.kind == SEPARATION and 1.5 < only.end < 2.0


def test_what_lasts_has_no_end_and_a_silence_ends_it() -> None:
    force, moment = held(lean_deg=8 + 19 * np.clip((TIME - 1) / 0.04, 0, 1))
    (only,) = found(force, moment)
    assert only.lasting
    late = TIME + 5 * (TIME > 2)
    first = found(force, moment, late)[0]
    assert first.end == pytest.approx(2, abs=0.05)


def test_samples_that_are_no_number_or_out_of_order_are_passed_over() -> None:
    force, moment = held(**SLIDE)
    whole = found(force, moment)
    force[300], moment[310] = np.nan, np.inf
    time = TIME.copy()
    time[320] = 0.0
    (only,) = found(force, moment, time)
    assert (only.start, only.end) == pytest.approx((whole[0].start, whole[0].end), abs=0.02)


def test_untouched_is_no_separation() -> None:
    assert found(*held(size=0.0)) == []


@pytest.mark.parametrize(
    "wrong", [{"friction_deg": 0}, {"friction_deg": 90}, {"friction_deg": np.nan}, {"friction_deg": 30, "slide_end": 0.95}]
)
def test_limits_that_are_none(wrong: dict) -> None:
    with pytest.raises(InputError):
        Limits(**wrong)


def test_a_rate_that_is_none() -> None:
    with pytest.raises(InputError, match="0 Hz"):
        MotionWatch(Limits(30.0), rate_hz=0)
