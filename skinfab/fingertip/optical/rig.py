"""A simulated robot that presses the fingertip on a plate, moves it, and knows only what moves it asked for."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from skinfab.fingertip.optical.plates import Plate
from skinfab.fingertip.optical.simulator import DEPTH_MM, PLATE_MM, Fingertip, Image

FloatArray = NDArray[np.float64]


class Robot(Protocol):
    """What a follower needs: to feel, to move, and to know where it believes to be.

    Its x and y are those in which the edge is told. `follow_pose` takes what the model's labels say, so those must have been taken in
    the robot's axes; `follow_published` takes the picture's columns for x and its rows for y, so where the camera is turned or mirrored
    against the robot, `frame` must turn its pictures back.
    """

    @property
    def at(self) -> FloatArray:
        """(2,) mm, reckoned from the moves that were asked for."""
        ...

    def frame(self) -> Image:
        """What the fingertip sees here."""
        ...

    def move(self, by: FloatArray) -> None:
        """Go on by (2,) mm."""
        ...


@dataclass(frozen=True)
class Platform:
    """How a robot presses and moves.

    Parameters
    ----------
    step_mm : float
        Standard deviation of each move, each way: what is asked for is not quite what comes.
    depth_mm : float
        How deep the dome is pressed.
    depth_scatter_mm : float
        Its standard deviation from frame to frame.
    drag_mm : float
        How far the skin that touches is dragged behind a move.
    """

    step_mm: float = 0.02
    depth_mm: float = DEPTH_MM
    depth_scatter_mm: float = 0.1
    drag_mm: float = 0.2


@dataclass(eq=False)
class Rig:
    """A simulated robot over a plate; what it does depends on the seed alone.

    Parameters
    ----------
    plate : Plate
    tip : Fingertip
    start : (2,) float, mm
        Where the fingertip is put down.
    platform : Platform
    seed : int

    Examples
    --------
    >>> from skinfab.fingertip.optical.plates import HalfPlane
    >>> rig = Rig(HalfPlane(0.0, 0.0), Fingertip(), np.zeros(2), seed=1)
    >>> rig.move(np.array([0.0, 1.0]))
    >>> rig.at.tolist(), bool(np.linalg.norm(rig.true - rig.at) < 0.1), rig.frame().shape
    ([0.0, 1.0], True, (240, 240))
    """

    plate: Plate
    tip: Fingertip
    start: FloatArray
    platform: Platform = Platform()
    seed: int = 0
    at: FloatArray = field(init=False)
    true: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        self.at, self.true = np.array(self.start, dtype=float), np.array(self.start, dtype=float)
        self._dragged = np.zeros(2)
        self._rng = np.random.default_rng((self.seed, 3))

    def frame(self) -> Image:
        """The fingertip's image here."""
        p = self.platform
        depth = float(np.clip(p.depth_mm + p.depth_scatter_mm * self._rng.standard_normal(), 0.0, PLATE_MM))
        return self.tip.frame(self.plate, rng=self._rng, at=self.true, depth_mm=depth, shear_mm=self._dragged)

    def move(self, by: FloatArray) -> None:
        """Go on, and drag the skin behind."""
        far = float(np.linalg.norm(by))
        self.at = self.at + by
        self.true = self.true + by + self.platform.step_mm * self._rng.standard_normal(2)
        # A short move drags the skin no farther than it goes.
        self._dragged = -min(self.platform.drag_mm, far) * by / far if far else np.zeros(2)
