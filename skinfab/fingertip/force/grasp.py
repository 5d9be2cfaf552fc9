"""A four-fingered hand grasps a solid: what each fingertip's sensor reads, and where its joints say it is. Simulated.

The object is held still: the fingers' forces are their squeeze and, added to it, the least that balances gravity. Errors are
the joints': each fingertip is a little elsewhere and turned a little from where the hand thinks. Left out: the fingers'
kinematics (a fingertip is where it touches), give of finger and object, a contact's area, slip. The sensor's noise and fingers
whose axes do not point at the object were in and changed no figure: at 2 to 4 N noise is 0.05 mm where joints are off by 1.5.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from skinfab.errors import InputError
from skinfab.fingertip.force.contact import locate
from skinfab.fingertip.force.wrench import RADIUS_MM

FloatArray = NDArray[np.float64]

SPHERE, CYLINDER, CUBOID = "sphere", "cylinder", "cuboid"
SHAPES = (SPHERE, CYLINDER, CUBOID)
#: What is none of these, to see what is said of it.
CONE, PRISM, ELLIPSOID = "cone", "prism", "ellipsoid"
_SIZES = {SPHERE: 1, CYLINDER: 2, CUBOID: 3, CONE: 2, PRISM: 2, ELLIPSOID: 3}
FINGERS = 4
GRAVITY_M_S2 = 9.81
#: Directions from which the fingers come (azimuth, deg; None: from above). All round, and one over the top.
ROUND: tuple[float | None, ...] = (0.0, 90.0, 180.0, 270.0)
OVER: tuple[float | None, ...] = (0.0, 90.0, 180.0, None)


@dataclass(frozen=True)
class Solid:
    """An object.

    Parameters
    ----------
    shape : str
        One of `SHAPES`, or a cone, a (three-sided) prism or an ellipsoid.
    size : tuple of float, mm
        Radius of a sphere; radius and height of a cylinder and of a cone (at its base); the three sides of a cuboid; of a prism the
        radius of the circle in it, and its height; half axes of an ellipsoid.

    Examples
    --------
    >>> Solid("cuboid", (60.0, 80.0, 90.0)).name
    'cuboid 60 x 80 x 90'
    """

    shape: str
    size: tuple[float, ...]

    def __post_init__(self) -> None:
        wanted = _SIZES.get(self.shape)
        if wanted is None:
            raise InputError(f"{self.shape!r} is no shape; there are {', '.join(_SIZES)}")
        if len(self.size) != wanted or not all(math.isfinite(x) and x > 0 for x in self.size):
            raise InputError(f"a {self.shape} has {wanted} size(s) above 0 mm; {self.size} is none")

    @property
    def name(self) -> str:
        """Shape and size."""
        return f"{self.shape} {' x '.join(f'{x:g}' for x in self.size)}"


#: Two of each to learn from, and one of each that is new (the seed's fig. 15 shows sizes that the text does not tell).
LEARNED = (
    Solid(SPHERE, (45.0,)),
    Solid(SPHERE, (30.0,)),
    Solid(CYLINDER, (30.0, 120.0)),
    Solid(CYLINDER, (40.0, 120.0)),
    Solid(CUBOID, (60.0, 80.0, 90.0)),
    Solid(CUBOID, (50.0, 50.0, 90.0)),
)
#: What the paper reconstructs.
PAPER = (Solid(SPHERE, (45.0,)), Solid(CYLINDER, (30.0, 120.0)), Solid(CUBOID, (60.0, 80.0, 90.0)))
STRANGE = (Solid(CONE, (50.0, 120.0)), Solid(PRISM, (25.0, 120.0)), Solid(ELLIPSOID, (25.0, 45.0, 60.0)))
NEW = (Solid(SPHERE, (37.0,)), Solid(CYLINDER, (35.0, 120.0)), Solid(CUBOID, (55.0, 65.0, 90.0)))


@dataclass(frozen=True)
class HandScene:
    """How objects are grasped; scatters are standard deviations.

    Parameters
    ----------
    height_mm : float, mm
        Of the object over the palm.
    place_mm : float, mm
        Scatter of the object's place.
    yaw_deg, tilt_deg : float, deg
        The object's turn about the vertical, and from it, at most.
    azimuth_deg, along_mm : float
        Scatter of where the fingers come from, and how high they touch.
    joint_mm, joint_deg : float
        Scatter of a fingertip's place (each axis) and of its turn (about each axis) that the joints do not tell.
    squeeze_n : pair, N
    lone : float
        What a finger that none opposes pushes with, as a part of that.
    mass_kg : float
    friction_deg : float, deg
        A grasp in which a contact needs more than this would slip: another one is tried ...
    tries : int
        ... so often; then it is held all the same.
    pose_deg : float, deg
        The hand's turn from pose to pose, about any axis, at most.
    """

    height_mm: float = 140.0
    place_mm: float = 5.0
    yaw_deg: float = 180.0
    tilt_deg: float = 15.0
    azimuth_deg: float = 11.0
    along_mm: float = 12.0
    joint_mm: float = 1.5
    joint_deg: float = 4.0
    squeeze_n: tuple[float, float] = (2.0, 4.0)
    lone: float = 0.3
    mass_kg: float = 0.17
    friction_deg: float = 40.0
    tries: int = 50
    pose_deg: float = 45.0


@dataclass(frozen=True, eq=False)
class Grasp:
    """What a hand knows of an object it holds, in one pose or more with the same contacts.

    Parameters
    ----------
    position : (4, 3) float, mm
        Of the fingertips' domes (their centres) in the hand's frame, by the joints.
    turn : (4, 3) float, rad
        Rotation vectors from the fingertips' frames into the hand's, by the joints.
    force, moment : (k, 4, 3) float, N and N mm
        In the fingertips' frames, the moment about the dome's centre, for each of k poses of the hand.
    solid : Solid or None
        What it is, where that is known.
    object : int
        Number of the object, which must not be parted between training and test.
    centre : (3,) float, mm
        The object's true centre in the hand's frame; NaN where it is not known.
    simulated : bool
    """

    position: FloatArray
    turn: FloatArray
    force: FloatArray
    moment: FloatArray
    solid: Solid | None = None
    object: int = 0
    centre: FloatArray = field(default_factory=lambda: np.full(3, np.nan))
    simulated: bool = False


@dataclass(frozen=True, eq=False)
class Touches:
    """Contacts of a grasp in the hand's frame.

    Parameters
    ----------
    point : (4, 3) float, mm
    normal : (4, 3) float
        Out of the object.
    fault : str
        What is wrong with one of them; empty where nothing is.
    """

    point: FloatArray
    normal: FloatArray
    fault: str


def touches(grasp: Grasp) -> Touches:
    """Where the fingers touch, from the mean over the poses of what the sensors read.

    Examples
    --------
    >>> found = touches(simulate_grasp(NEW[0], seed=1))
    >>> found.point.shape, found.fault
    ((4, 3), '')
    """
    # In one pose or many, the contact and its frame are the same, so that p x f = m holds for the sums too.
    found = locate(grasp.force.mean(axis=0), grasp.moment.mean(axis=0))
    turn = Rotation.from_rotvec(grasp.turn)
    faults = [f"finger {k + 1}: {found.words(k)}" for k in range(len(found)) if not found.touching[k] or found.missed[k]]
    # No hand has four domes of this radius so near each other, and no turn is more than a full one.
    if np.linalg.norm(grasp.position[:, None] - grasp.position[None], axis=2).max() < RADIUS_MM:
        faults.append(f"all fingertips lie within {RADIUS_MM:g} mm; are their places in mm?")
    if np.linalg.norm(grasp.turn, axis=1).max() > 2 * math.pi:
        faults.append("a fingertip is turned by more than a full turn; are rotation vectors in rad?")
    return Touches(grasp.position + turn.apply(found.point), turn.apply(found.normal), "; ".join(faults))


def total_wrench(grasp: Grasp) -> tuple[FloatArray, FloatArray]:
    """Force (k, 3) N and moment (k, 3) N mm about the hand's origin that all fingers feel together, a row a pose: the object's weight."""
    turn = Rotation.from_rotvec(grasp.turn)
    force = np.array([turn.apply(each) for each in grasp.force])
    moment = np.array([turn.apply(each) for each in grasp.moment]) + np.cross(grasp.position, force)
    return force.sum(axis=1), moment.sum(axis=1)


def simulate_grasp(
    solid: Solid,
    *,
    seed: int | np.random.Generator = 0,
    scene: HandScene | None = None,
    fingers: Sequence[float | None] = ROUND,
    poses: int = 1,
    number: int = 0,
) -> Grasp:
    """One grasp of an object.

    Parameters
    ----------
    solid : Solid
    seed : int or Generator
    scene : HandScene
    fingers : sequence of float or None, deg
        Where each of the four comes from, `ROUND` or `OVER`.
    poses : int
        In which the hand holds it, turned; the first is upright.
    number : int
        Of the object.
    """
    scene = scene or HandScene()
    rng = np.random.default_rng(seed)
    down = np.vstack([[0, 0, -1.0], Rotation.from_rotvec(_turns(poses - 1, scene, rng)).apply([0, 0, -1.0])])
    for _ in range(scene.tries):
        place, point, normal, axes = _contacts(solid, fingers, rng, scene)
        force = _held(point, normal, place, down, rng, scene)
        lean = np.einsum("kfj,fj->kf", force, normal) / np.linalg.norm(force, axis=2)
        if lean.min() > math.cos(math.radians(scene.friction_deg)):
            break
    frames = _frames(axes, rng)
    # What the joints tell differs from where the domes are.
    position = point + RADIUS_MM * normal
    told = Rotation.from_rotvec(math.radians(scene.joint_deg) * rng.standard_normal((FINGERS, 3))) * frames
    inside = np.array([frames.inv().apply(each) for each in force])
    arm = frames.inv().apply(point - position)
    seen = position + scene.joint_mm * rng.standard_normal((FINGERS, 3))
    return Grasp(seen, told.as_rotvec(), inside, np.cross(arm, inside), solid, number, place, simulated=True)


def _contacts(
    solid: Solid, fingers: Sequence[float | None], rng: np.random.Generator, scene: HandScene
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """The object's place, contacts and outward normals (4, 3) on it, and the axes of the fingers that come there."""
    place = np.array([0, 0, scene.height_mm]) + scene.place_mm * rng.standard_normal(3)
    tilt, about = math.radians(scene.tilt_deg) * rng.uniform(-1, 1), rng.uniform(0, 2 * math.pi)
    yaw = math.radians(scene.yaw_deg) * rng.uniform(-1, 1)
    turned = Rotation.from_rotvec(tilt * np.array([math.cos(about), math.sin(about), 0])) * Rotation.from_rotvec([0, 0, yaw])
    where = [_direction(each, rng, scene) for each in fingers]
    own = [_surface(solid, turned.inv().apply(way), along) for way, along in where]
    axes = np.array([-way for way, _ in where])
    return place, place + turned.apply([p for p, _ in own]), turned.apply([n for _, n in own]), axes


def _direction(finger: float | None, rng: np.random.Generator, scene: HandScene) -> tuple[FloatArray, float]:
    """From the object towards a finger, and how high along the object it touches, mm."""
    if finger is None:
        off = math.radians(scene.azimuth_deg) * rng.standard_normal(2)
        way = np.array([math.tan(off[0]), math.tan(off[1]), 1.0])
        return way / np.linalg.norm(way), 0.0
    azimuth = math.radians(finger + scene.azimuth_deg * rng.standard_normal())
    return np.array([math.cos(azimuth), math.sin(azimuth), 0.0]), scene.along_mm * rng.standard_normal()


def _surface(solid: Solid, way: FloatArray, along: float) -> tuple[FloatArray, FloatArray]:
    """Contact and outward normal in the object's frame, for a finger that comes from `way`, `along` mm up."""
    if solid.shape == SPHERE:
        radius = solid.size[0]
        out = way + np.array([0, 0, along / radius])
        out = out / np.linalg.norm(out)
        return radius * out, out
    if solid.shape in (CONE, PRISM, ELLIPSOID):
        return _strange_surface(solid, way, along)
    upright = abs(way[2]) < math.sqrt(0.5)
    if solid.shape == CYLINDER:
        radius, height = solid.size
        if not upright:
            return np.array([0, 0, math.copysign(height / 2, way[2])]), np.array([0, 0, math.copysign(1, way[2])])
        out = np.array([way[0], way[1], 0]) / math.hypot(way[0], way[1])
        return radius * out + [0, 0, min(max(along, -height / 2), height / 2)], out
    half = np.array(solid.size) / 2
    axis = int(np.argmax(np.abs(way) / half)) if upright else 2
    if upright:
        axis = int(np.argmax(np.abs(way[:2]) / half[:2]))
    point = way * half[axis] / abs(way[axis])
    point[2] += along * upright
    out = np.zeros(3)
    out[axis] = math.copysign(1, way[axis])
    return np.clip(point, -half, half), out


def _strange_surface(solid: Solid, way: FloatArray, along: float) -> tuple[FloatArray, FloatArray]:
    """As `_surface`, from the side."""
    size = np.array(solid.size)
    if solid.shape == ELLIPSOID:
        out = way + np.array([0, 0, along / size[2]])
        point = out / math.sqrt(float(((out / size) ** 2).sum()))
        return point, point / size**2 / np.linalg.norm(point / size**2)
    height = min(max(along, -0.45 * size[1]), 0.45 * size[1])
    flat = np.array([way[0], way[1], 0]) / math.hypot(way[0], way[1])
    if solid.shape == CONE:
        radius, slope = size[0] * (0.5 - height / size[1]), size[0] / size[1]
        return radius * flat + [0, 0, height], (flat + np.array([0, 0, slope])) / math.hypot(1, slope)
    sides = [np.array([math.cos(a), math.sin(a), 0.0]) for a in 2 * math.pi * np.arange(3) / 3]
    side = max(sides, key=lambda each: float(each @ flat))
    return flat * size[0] / float(flat @ side) + [0, 0, height], side


def _frames(axes: FloatArray, rng: np.random.Generator) -> Rotation:
    """Frames whose z is a finger's axis, turned about it at will."""
    z = axes / np.linalg.norm(axes, axis=1)[:, None]
    x = np.cross(z, rng.standard_normal(z.shape))
    x /= np.linalg.norm(x, axis=1)[:, None]
    return Rotation.from_matrix(np.stack([x, np.cross(z, x), z], axis=2))


def _turns(count: int, scene: HandScene, rng: np.random.Generator) -> FloatArray:
    about = rng.standard_normal((count, 3))
    about /= np.linalg.norm(about, axis=1)[:, None]
    return about * np.radians(scene.pose_deg) * rng.uniform(-1, 1, (count, 1))


def _held(
    point: FloatArray, normal: FloatArray, centre: FloatArray, down: FloatArray, rng: np.random.Generator, scene: HandScene
) -> FloatArray:
    """Forces (k, 4, 3) on the fingers: a squeeze, and the least that is to be added so that nothing moves in each pose."""
    weight = scene.mass_kg * GRAVITY_M_S2 * down
    wrench = np.column_stack([weight, np.cross(centre, weight)])
    # Six rows: the sum of the forces, and of their moments about the origin.
    balance = np.vstack([np.tile(np.eye(3), FINGERS), np.hstack([_cross_matrix(p) for p in point])])
    # A finger that none opposes cannot squeeze: what it pushes, the others must hold by friction.
    opposed = (normal @ normal.T).min(axis=1) < -math.sqrt(0.5)
    sizes = rng.uniform(*scene.squeeze_n, FINGERS) * np.where(opposed, 1.0, scene.lone)
    squeeze = (sizes[:, None] * normal).ravel()
    # What pushes harder can hold more.
    share = np.repeat(sizes**2, 3)[:, None] * balance.T
    inverse = share @ np.linalg.pinv(balance @ share)
    return (squeeze + (wrench - balance @ squeeze) @ inverse.T).reshape(-1, FINGERS, 3)


def _cross_matrix(p: FloatArray) -> FloatArray:
    return np.array([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])
