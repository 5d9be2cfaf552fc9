"""Following an edge all round: as the seed does by merged pins, and by a pose that is regressed from them.

The seed's way looks at one frame: a step along the feature's axis, its direction one of eight; where the feature has left the middle,
a step towards it; where there is none, back to where one was. The improved way keeps where the edge was (the seed's future work):
it steps along the way that the last points of the edge and what is felt agree on, corrects its distance at every step, and when the
edge is gone feels round on circles about where it must be.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.published import feature
from skinfab.fingertip.optical.rig import Robot
from skinfab.fingertip.optical.simulator import Image

FloatArray = NDArray[np.float64]
Feel = Callable[[Image], Edge | None]

#: Step (seed), mm, and the directions that a quantised one can have.
STEP_MM, DIRECTIONS = 1.0, 8
#: Frames without a good feature after which the edge is lost.
PATIENCE = 40
#: Of these, so many are answered by a step towards what is seen, the others by steps back to the last good feature.
TOWARDS = 8
#: Frames after which a robot that goes nowhere is stopped: the seed's longest edge has 370 steps of 1 mm.
MOST_FRAMES = 1000
#: A contour is closed where the start is as near again, mm (or 1.5 steps), after it was as far away.
NEAR_MM, AWAY_MM = 3.0, 15.0
#: An edge is believed that is no farther off, mm, ...
REACH_MM = 6.0
#: ... felt with this confidence (from 0.5 on one circle of twenty stops at its start; from 0.2 on 58 % of what lies just beside the
#: learned depths is believed), ...
LEAST_CONFIDENCE = 0.3
#: ... that turns by no more than a corner does, ...
TURN_RAD = math.radians(110)
#: ... and that goes on where the last ended, this near beyond a step, mm.
JUMP_MM = 3.0
#: Points of the edge that are remembered, and how much their line counts against what is felt now.
MEMORY, REMEMBERED = 4, 0.5
#: Circles on which a lost edge is felt for, mm, and points on each.
CIRCLES_MM, PALPATIONS = (2.0, 4.0, 6.0), 8


@dataclass(frozen=True, eq=False)
class Trace:
    """Where a follower went.

    Parameters
    ----------
    path : (n, 2) float, mm
        Where it believed to be at each good feature or believed edge.
    edge : (n, 2) float, mm
        Where it believed the edge to be then: for the seed's way the path itself.
    frames : int
    closed : bool
        Whether it came back to its start.
    recoveries : int
        How often the edge was gone and found again.
    """

    path: FloatArray
    edge: FloatArray
    frames: int
    closed: bool
    recoveries: int


@dataclass
class _Walk:
    """A trace in the making."""

    robot: Robot
    step_mm: float
    path: list[FloatArray] = field(default_factory=list)
    edge: list[FloatArray] = field(default_factory=list)
    frames: int = 0
    recoveries: int = 0
    away: bool = False

    def look(self) -> Image:
        self.frames += 1
        return self.robot.frame()

    def note(self, edge: FloatArray) -> bool:
        """Keep where it is and where the edge; true when that closes the contour."""
        self.path.append(self.robot.at.copy())
        self.edge.append(edge)
        # The edge, not the fingertip: that may have been put down beside it.
        far = float(np.linalg.norm(edge - self.edge[0]))
        self.away = self.away or far > AWAY_MM
        return self.away and far <= max(NEAR_MM, 1.5 * self.step_mm)

    def done(self, closed: bool) -> Trace:
        return Trace(np.array(self.path).reshape(-1, 2), np.array(self.edge).reshape(-1, 2), self.frames, closed, self.recoveries)


def quantised(v: FloatArray) -> FloatArray:
    """The same length in the nearest of eight directions.

    Examples
    --------
    >>> quantised(np.array([1.0, 0.2])).round(3).tolist()
    [1.02, 0.0]
    """
    part = math.tau / DIRECTIONS
    turn = round(math.atan2(v[1], v[0]) / part) * part
    return float(np.linalg.norm(v)) * np.array([math.cos(turn), math.sin(turn)])


def follow_published(robot: Robot, *, step_mm: float = STEP_MM, plate_is_white: bool = False, most_frames: int = MOST_FRAMES) -> Trace:
    """Follow an edge as the seed does (section 2.1 and figure 6).

    Parameters
    ----------
    robot : Robot
        On the edge, or near it. Its pictures' columns and rows lie along its x and y (see `Robot`).
    step_mm : float
    plate_is_white : bool
        See `published.feature`.
    most_frames : int
        After which it is stopped.

    Raises
    ------
    InputError
        The step is not a positive length, or the frames show no pins.
    """
    walk, missing = _Walk(robot, _length(step_mm)), 0
    while walk.frames < most_frames and missing < PATIENCE:
        found = feature(walk.look(), plate_is_white=plate_is_white)
        if found is not None and found.good:
            walk.recoveries += missing > 0
            missing = 0
            if walk.note(robot.at.copy()):
                return walk.done(closed=True)
            outward = found.angle_rad
            v = np.array([-math.sin(outward), math.cos(outward)])
        else:
            missing += 1
            if found is not None and missing <= TOWARDS:
                v = np.array(found.centroid)
            elif walk.path and np.linalg.norm(walk.path[-1] - robot.at) > step_mm / 2:
                v = walk.path[-1] - robot.at
            else:
                continue  # the noise of another frame may do
        robot.move(quantised(v / max(float(np.linalg.norm(v)), 1e-9) * step_mm))
    return walk.done(closed=False)


def follow_pose(
    robot: Robot,
    feel: Feel,
    *,
    step_mm: float = STEP_MM,
    quantise: bool = False,
    memory: bool = True,
    palpation: bool = True,
    most_frames: int = MOST_FRAMES,
) -> Trace:
    """Follow an edge by its pose, counter-clockwise round the plate.

    Parameters
    ----------
    robot : Robot
        On the edge, or within `REACH_MM` of it.
    feel : callable
        Takes an image and gives the edge in it, or None.
    step_mm : float
    quantise : bool
        Whether each move has one of eight directions, as the seed's.
    memory, palpation : bool
        Whether the last points of the edge are used, and whether a lost edge is felt for: without both, the next step depends on this
        frame alone.
    most_frames : int
        After which it is stopped.

    Raises
    ------
    InputError
        The step is not a positive length.
    """
    walk = _Walk(robot, _length(step_mm))
    while walk.frames < most_frames:
        found = _believed(feel(walk.look()), walk, memory=memory)
        if found is None and palpation:
            found = _palpate(walk, feel, memory=memory)
        if found is None:
            break
        here = robot.at + found.nearest
        if walk.note(here):
            return walk.done(closed=True)
        along = _direction(found, walk.edge) if memory else found.along
        v = here + step_mm * along - robot.at
        if quantise:
            v = quantised(v / np.linalg.norm(v) * step_mm)
        robot.move(v)
    return walk.done(closed=False)


def _length(step_mm: float) -> float:
    if not 0 < step_mm < math.inf:
        raise InputError(f"a step of {step_mm:g} mm; it must be a positive length")
    return step_mm


def _believed(found: Edge | None, walk: _Walk, *, memory: bool) -> Edge | None:
    """What was felt, unless it is too far off, too unlike what was learned, or no continuation of the edge."""
    if found is None or abs(found.offset_mm) > REACH_MM or not found.confidence >= LEAST_CONFIDENCE:
        return None
    if memory and len(walk.edge) > 1:
        on = walk.edge[-1] - walk.edge[max(-1 - MEMORY, -len(walk.edge))]
        turned = math.remainder(math.atan2(found.along[1], found.along[0]) - math.atan2(on[1], on[0]), math.tau)
        jump = float(np.linalg.norm(walk.robot.at + found.nearest - walk.edge[-1]))
        if abs(turned) > TURN_RAD or jump > JUMP_MM + 1.5 * walk.step_mm:
            return None
    return found


def _direction(found: Edge, edge: list[FloatArray]) -> FloatArray:
    """Along the edge, as it is felt and as its last points lie: a corner shows in what is felt first."""
    if len(edge) <= MEMORY:
        return found.along
    on = edge[-1] - edge[-1 - MEMORY]
    on = on / max(float(np.linalg.norm(on)), 1e-9)
    if on @ found.along < math.cos(math.pi / 6):
        return found.along
    v = REMEMBERED * on + (1 - REMEMBERED) * found.along
    out: FloatArray = v / np.linalg.norm(v)
    return out


def _palpate(walk: _Walk, feel: Feel, *, memory: bool) -> Edge | None:
    """Feel round on growing circles about where the edge was last, ahead first; stay where it is found."""
    centre = walk.edge[-1] if walk.edge else walk.robot.at.copy()
    on = walk.edge[-1] - walk.edge[max(-1 - MEMORY, -len(walk.edge))] if walk.edge else np.array([1.0, 0.0])
    ahead = math.atan2(on[1], on[0])
    for radius in CIRCLES_MM:
        for k in range(PALPATIONS):
            # Ahead, then in turns to its left and right, so that it is not taken up behind.
            turn = ahead + (k + 1) // 2 * (-1) ** k * math.tau / PALPATIONS
            walk.robot.move(centre + radius * np.array([math.cos(turn), math.sin(turn)]) - walk.robot.at)
            found = _believed(feel(walk.look()), walk, memory=memory)
            if found is not None:
                walk.recoveries += 1
                return found
    return None
