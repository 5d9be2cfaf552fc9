"""From where and how large the object is seen, without perspective: lengths across the view are true everywhere."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]

#: Right, up and towards the viewer as rows, by the names of the six sides.
SIDES: dict[str, tuple[tuple[int, int, int], ...]] = {
    "front": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    "back": ((-1, 0, 0), (0, 0, 1), (0, 1, 0)),
    "left": ((0, -1, 0), (0, 0, 1), (-1, 0, 0)),
    "right": ((0, 1, 0), (0, 0, 1), (1, 0, 0)),
    "top": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "bottom": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
}

#: Share of the window an object that is fitted into it takes.
_FILL = 0.86

#: Nearest and farthest zoom, as a multiple of the zoom that shows the whole object.
_ZOOM = (0.05, 400.0)


@dataclass(frozen=True, eq=False)
class Camera:
    """A view along parallel rays.

    Parameters
    ----------
    turn : (3, 3) float
        Right, up and towards the viewer as rows, unit vectors.
    middle : (3,) float, mm
        The object's middle, about which it turns.
    half : (3,) float, mm
        Half the sides of the box about the middle that holds the object.
    width, height : int, pixels
    zoom : float
        1 shows the whole ball round that box.
    pan : (2,) float, pixels
        Where the middle is, right and down from the middle of the window.

    Examples
    --------
    >>> camera = Camera.fitted(np.array([[0.0, 0, 0], [10, 20, 30]]), 400, 300).seen_from("front")
    >>> camera.to_screen([[5.0, 10, 15]]).tolist()
    [[200.0, 150.0, 0.0]]
    """

    turn: FloatArray
    middle: FloatArray
    half: FloatArray
    width: int
    height: int
    zoom: float = 1.0
    pan: tuple[float, float] = (0.0, 0.0)

    @staticmethod
    def fitted(V: ArrayLike, width: int, height: int) -> Camera:
        """The whole of the points (n, 3) mm from the front, a little from above and from the right."""
        points = np.asarray(V, dtype=np.float64).reshape(-1, 3)
        low, high = (points.min(axis=0), points.max(axis=0)) if len(points) else (np.zeros(3), np.ones(3))
        half = (high - low) / 2
        half = half if half.any() else np.ones(3)
        start = Camera(np.array(SIDES["front"], dtype=np.float64), (low + high) / 2, half, width, height)
        return start.turned(np.radians(-30), 0.0).turned(0.0, np.radians(25)).whole()

    @property
    def radius(self) -> float:
        """Of the ball about the middle that holds the object, mm."""
        return float(np.linalg.norm(self.half))

    @property
    def scale(self) -> float:
        """Pixels per mm."""
        return _FILL * min(self.width, self.height) / (2 * self.radius) * self.zoom

    def projection(self, sharper: float = 1) -> tuple[FloatArray, FloatArray]:
        """Rows (3, 3) and shift (3,) that give column, row and depth (mm); with `sharper` times as many pixels either way."""
        s = self.scale
        rows = self.turn * np.array([[s], [-s], [-1.0]])
        shift = np.array([self.width / 2 + self.pan[0], self.height / 2 + self.pan[1], 0.0]) - rows @ self.middle
        grow = np.array([sharper, sharper, 1.0])
        return rows * grow[:, None], shift * grow

    def to_screen(self, points: ArrayLike) -> FloatArray:
        """Column, row and depth of points (k, 3) mm: (k, 3)."""
        rows, shift = self.projection()
        return np.asarray(points, dtype=np.float64).reshape(-1, 3) @ rows.T + shift

    def to_space(self, column: float, row: float, depth: float) -> FloatArray:
        """The point (3,) mm at a place of the screen."""
        s = self.scale
        x, y = (column - self.width / 2 - self.pan[0]) / s, -(row - self.height / 2 - self.pan[1]) / s
        point: FloatArray = self.middle + x * self.turn[0] + y * self.turn[1] - depth * self.turn[2]
        return point

    def turned(self, right: float, down: float) -> Camera:
        """Turned about the screen's axes as if the near side were pushed right and down, rad."""
        cy, sy, cx, sx = np.cos(right), np.sin(right), np.cos(down), np.sin(down)
        about_up = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
        about_right = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
        return replace(self, turn=_orthonormal(about_right @ about_up @ self.turn))

    def dragged(self, start: tuple[float, float], end: tuple[float, float]) -> Camera:
        """Turned like a ball that the pointer rolls from one pixel to another.

        Beside the ball (Bell's: a sphere that runs out into a hyperbolic sheet) the object turns in the plane of the screen.
        """
        a, b = self._on_ball(start), self._on_ball(end)
        axis = np.cross(a, b)
        sine, cosine = float(np.linalg.norm(axis)), float(a @ b)
        if sine == 0:
            return self
        x, y, z = axis / sine
        K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        # Twice the ball's angle: dragging across it turns the object once around, so that its back is within reach.
        angle = 2 * np.arctan2(sine, cosine)
        return replace(self, turn=_orthonormal((np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K) @ self.turn))

    def panned(self, right: float, down: float) -> Camera:
        """Moved across the screen, pixels."""
        return replace(self, pan=(self.pan[0] + right, self.pan[1] + down))

    def zoomed(self, factor: float, at: tuple[float, float]) -> Camera:
        """Larger by `factor`; what is at that pixel stays there."""
        zoom = float(np.clip(self.zoom * factor, *_ZOOM))
        grown = zoom / self.zoom
        px, py = at[0] - self.width / 2, at[1] - self.height / 2
        return replace(self, zoom=zoom, pan=(px + (self.pan[0] - px) * grown, py + (self.pan[1] - py) * grown))

    def whole(self) -> Camera:
        """All of the object in the middle, as large as it can be, from where it is seen now."""
        wide, high = np.abs(self.turn[:2]) @ self.half
        room = min(self.width / max(2 * wide, self.radius / 4), self.height / max(2 * high, self.radius / 4))
        return replace(self, zoom=room / (min(self.width, self.height) / (2 * self.radius)), pan=(0.0, 0.0))

    def sized(self, width: int, height: int) -> Camera:
        """The same in a window of another size."""
        grown = min(width, height) / max(min(self.width, self.height), 1)
        return replace(self, width=width, height=height, pan=(self.pan[0] * grown, self.pan[1] * grown))

    def seen_from(self, side: str) -> Camera:
        """From one of `SIDES`, z up (y up from above)."""
        return replace(self, turn=np.array(SIDES[side], dtype=np.float64))

    def _on_ball(self, pixel: tuple[float, float]) -> FloatArray:
        size = min(self.width, self.height) / 2
        x, y = (pixel[0] - self.width / 2) / size, (self.height / 2 - pixel[1]) / size
        square = x * x + y * y
        z = np.sqrt(1 - square) if square < 0.5 else 0.5 / np.sqrt(square)
        point: FloatArray = np.array([x, y, z]) / np.sqrt(square + z * z)
        return point


def _orthonormal(turn: FloatArray) -> FloatArray:
    """The nearest rotation: thousands of small turns must not make it a skewed one."""
    u, _, v = np.linalg.svd(turn)
    result: FloatArray = u @ v
    return result
