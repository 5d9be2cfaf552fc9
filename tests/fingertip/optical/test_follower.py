"""Followers on robots that feel exactly, so that what they do with it is seen alone; and on simulated images, a short way."""

import math
from dataclasses import dataclass, field

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.follower import PALPATIONS, follow_pose, follow_published, quantised
from skinfab.fingertip.optical.plates import Outline
from skinfab.fingertip.optical.rig import Platform, Rig
from skinfab.fingertip.optical.shapes import shapes
from skinfab.fingertip.optical.simulator import Image, paper_fingertip

ALL = pytest.mark.parametrize("shape", shapes(), ids=lambda each: each.name)


@dataclass
class Exact:
    """A robot whose frame is its place, and who feels the true edge there; blind at some frames, and misled at others."""

    plate: Outline
    at: np.ndarray
    blind: frozenset[int] = frozenset()
    misled: frozenset[int] = frozenset()
    frames: int = 0
    been: list[np.ndarray] = field(default_factory=list)

    def frame(self) -> Image:
        self.frames += 1
        self.been.append(self.at.copy())
        return np.zeros((1, 1), np.uint8)

    def move(self, by: np.ndarray) -> None:
        self.at = self.at + by

    def feel(self, _: Image) -> Edge | None:
        if self.frames in self.blind:
            return None
        h = 1e-6
        d = float(self.plate.distance(self.at))
        g = [float(self.plate.distance(self.at + h * e)) - d for e in np.eye(2)]
        turn = math.pi if self.frames in self.misled else 0.0
        return Edge(d, math.atan2(g[1], g[0]) + turn)


@ALL
@pytest.mark.parametrize("step", [0.5, 1.0, 3.0])
def test_an_edge_that_is_felt_exactly_is_followed_exactly(shape, step: float) -> None:  # type: ignore[no-untyped-def]
    robot = Exact(shape.plate, shape.plate.start)
    trace = follow_pose(robot, robot.feel, step_mm=step)
    assert trace.closed and trace.recoveries == 0
    assert np.abs(shape.plate.distance(trace.edge)).max() < 0.01 + 0.05 * step
    assert len(trace.path) == pytest.approx(shape.plate.length / step, rel=0.1)


@ALL
def test_it_goes_counter_clockwise_and_comes_from_beside(shape) -> None:  # type: ignore[no-untyped-def]
    robot = Exact(shape.plate, shape.plate.start * 1.08)
    trace = follow_pose(robot, robot.feel)
    x, y = trace.edge.T
    assert trace.closed and (x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2 == pytest.approx(shape.plate.area, rel=0.03)


@ALL
def test_steps_of_eight_directions_stay_by_the_edge(shape) -> None:  # type: ignore[no-untyped-def]
    robot = Exact(shape.plate, shape.plate.start)
    trace = follow_pose(robot, robot.feel, quantise=True)
    moves = np.diff(np.array(robot.been), axis=0)
    turns = np.arctan2(moves[:, 1], moves[:, 0]) / (math.pi / 4)
    np.testing.assert_allclose(turns, np.rint(turns), atol=1e-6)
    assert trace.closed and np.abs(shape.plate.distance(trace.path)).max() < 1.5


def test_a_frame_that_tells_nothing_is_felt_round_and_costs_a_few() -> None:
    plate = shapes()[0].plate
    robot = Exact(plate, plate.start, blind=frozenset({30, 31, 90}))
    trace = follow_pose(robot, robot.feel)
    assert trace.closed and trace.recoveries == 2
    assert trace.frames - len(trace.path) == 3
    alone = Exact(plate, plate.start, blind=frozenset({30}))
    assert not follow_pose(alone, alone.feel, palpation=False).closed


def test_a_frame_that_tells_the_wrong_side_is_not_believed_and_without_memory_turns_back() -> None:
    plate = shapes()[-1].plate
    robot = Exact(plate, plate.start, misled=frozenset({30, 60, 90}))
    trace = follow_pose(robot, robot.feel)
    ahead = np.unwrap(np.arctan2(trace.edge[:, 1], trace.edge[:, 0]))
    assert trace.closed and trace.recoveries == 3 and np.diff(ahead[:-1]).min() > -math.radians(1)
    naive = Exact(plate, plate.start, misled=frozenset({30, 60, 90}))
    back = follow_pose(naive, naive.feel, memory=False, palpation=False)
    assert np.diff(np.unwrap(np.arctan2(back.edge[:, 1], back.edge[:, 0]))[:-1]).min() < -math.radians(1)


def test_an_edge_that_is_gone_for_good_ends_the_search_after_all_circles() -> None:
    plate = shapes()[-1].plate
    robot = Exact(plate, plate.start, blind=frozenset(range(20, 2000)))
    trace = follow_pose(robot, robot.feel)
    assert not trace.closed and len(trace.path) == 19 and trace.frames == 20 + 3 * PALPATIONS
    far = np.linalg.norm(np.array(robot.been[20:]) - trace.edge[-1], axis=1)
    np.testing.assert_allclose(np.unique(far.round(6)), [2, 4, 6])  # on the circles, and nowhere else
    ahead = trace.edge[-1] - trace.edge[-5]
    first = robot.been[20] - trace.edge[-1]
    assert first @ ahead > 0.99 * np.linalg.norm(first) * np.linalg.norm(ahead)  # ahead first


def test_never_having_felt_an_edge_is_an_empty_trace() -> None:
    plate = shapes()[-1].plate
    robot = Exact(plate, plate.start, blind=frozenset(range(2000)))
    trace = follow_pose(robot, robot.feel)
    assert trace.path.shape == trace.edge.shape == (0, 2) and not trace.closed


def test_a_pose_of_no_confidence_is_not_followed() -> None:
    plate = shapes()[-1].plate
    robot = Exact(plate, plate.start)
    assert len(follow_pose(robot, lambda _: Edge(0.0, 0.0, confidence=0.25)).path) == 0
    assert len(follow_pose(robot, lambda _: Edge(0.0, 0.0, confidence=math.nan)).path) == 0


def test_the_seeds_way_goes_along_the_circle() -> None:
    circle = shapes()[-1]
    rig = Rig(circle.plate, paper_fingertip(), circle.plate.start, Platform(), seed=1)
    trace = follow_published(rig, most_frames=50)
    assert trace.frames == 50 and np.abs(circle.plate.distance(trace.path)).mean() < 4
    turn = np.unwrap(np.arctan2(trace.path[:, 1], trace.path[:, 0]))
    assert turn[-1] - turn[0] > 15 / 30  # counter-clockwise, by half as many millimetres as a third of its steps


@pytest.mark.parametrize("step", [0.0, -1.0, math.nan, math.inf])
def test_a_step_that_is_no_length_is_refused(step: float) -> None:
    plate = shapes()[-1].plate
    robot = Exact(plate, plate.start)
    with pytest.raises(InputError, match="step"):
        follow_pose(robot, robot.feel, step_mm=step)
    with pytest.raises(InputError, match="step"):
        follow_published(robot, step_mm=step)


def test_quantised_directions_keep_the_length() -> None:
    for turn in np.linspace(-4, 4, 50):
        v = 2.5 * np.array([math.cos(turn), math.sin(turn)])
        q = quantised(v)
        assert np.linalg.norm(q) == pytest.approx(2.5) and q @ v >= 2.5**2 * math.cos(math.pi / 8) - 1e-9
