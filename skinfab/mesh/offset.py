"""The surface at a distance outside a mesh, face by face parallel to it: where a skin's own middle lies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.tolerances import OFFSET_CREASE_RAD, OFFSET_LEAST_AREA, OFFSET_MITRE, OFFSET_NEAR

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Rounds of evening out before vertices are drawn in instead: what is not even by then lies in a groove with no way out.
_EVEN_ROUNDS = 12
#: Neighbourhoods that a round of evening out reaches at most, in rings of triangles.
_RINGS = 3
#: ... and no farther from a fold than this many times the offset: long triangles carry it across the whole object otherwise.
_REACH = 4.0
#: Where more of the surface than this would have to be rounded off, the offset is given up.
_MOST_ROUNDED = 0.5
#: A round draws the vertices of folded triangles in by this factor.
_DRAW_IN = 0.7
#: Then folds are gone everywhere, or the offset is under a thousandth there (0.7^20) and put to nothing.
_DRAW_ROUNDS = 20
#: The distance to the object is looked up at this many vertices, evenly chosen: a place without room has more than one.
_LOOKED_AT = 20_000
#: Cosine of the way out and the normal of a face on the other side: not of a corner's own faces, which stand at right angles.
_OPPOSITE = -0.5
#: Halvings in the search for the largest offset that does not fold.
_HALVINGS = 12


class OffsetError(InputError):
    """An offset surface that folds or passes through itself.

    Attributes
    ----------
    largest : float, mm
        The largest offset that does not fold; 0 where that would not help.
    """

    def __init__(self, sentence: str, *, largest: float = 0.0) -> None:
        super().__init__(sentence)
        self.largest = largest


@dataclass(frozen=True, eq=False)
class Offset:
    """A mesh and what was done to get it.

    Parameters
    ----------
    mesh : Mesh
        Same faces, same vertex numbers.
    remarks : tuple of str
        Where it is not at the distance asked for, or passes through itself: one sentence each.
    """

    mesh: Mesh
    remarks: tuple[str, ...] = ()


def offset_mesh(mesh: Mesh, distance: float, *, round_off: bool = False) -> Offset:
    """Move a surface outward so that its faces keep their directions and lie `distance` from where they were.

    Each vertex goes to where the planes of the faces about it, moved by `distance`, meet (least squares, each face weighted
    by its angle there): exact for polyhedra, cylinders and their rims, where steps along vertex normals would move faces by
    less and bend them. Faces that differ too little for their planes to meet well share one step along their mean normal.

    Parameters
    ----------
    mesh : Mesh
        Closed or open; wound counter-clockwise from outside.
    distance : float, mm
        0 or more.
    round_off : bool
        Where the surface would fold (concave places tighter than `distance`), even the steps of neighbouring vertices out
        until it does not, and say so, instead of refusing. Where that would be most of the surface, it stays the object's own.

    Raises
    ------
    OffsetError
        The surface folds or passes through itself and `round_off` is not set; names the place, and knows the largest offset
        that does not fold.
    InputError
        `distance` is negative or not finite.

    Examples
    --------
    >>> V = np.array([[x, y, z] for x in (0.0, 40) for y in (0.0, 40) for z in (0.0, 40)])
    >>> F = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
    ...               [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
    >>> offset_mesh(Mesh(V, F), 1.25).mesh.bbox.round(9).tolist()
    [[-1.25, -1.25, -1.25], [41.25, 41.25, 41.25]]
    """
    if not 0 <= distance < np.inf:
        raise InputError(f"the offset is {distance:g} mm; it must be 0 or more")
    if distance == 0 or not len(mesh.F):
        return Offset(mesh)
    step = outward_steps(mesh)
    wanted = mesh.V + distance * step
    folded = folds(mesh, wanted)
    even, V = step, wanted
    if folded.any() and round_off:
        even = _without_folds(mesh, step, distance)
        V = mesh.V + distance * even
        if (share := _share(mesh, _is_rounded(step, even))) > _MOST_ROUNDED:
            return Offset(mesh, (_given_up(folded, share, distance),))
    elif folded.any():
        raise OffsetError(
            f"the surface {distance:.3g} mm outside the object folds over at {_count(folded)}, {_place(mesh, folded)}: something there "
            "is more tightly hollow; open it on the object",
            largest=_largest(mesh, step, distance),
        )
    remarks = [_rounded_off(mesh, folded, step, even, distance)] if even is not step else []
    # Where it was rounded off it is nearer for that reason, which is said already.
    meeting = _meets_itself(mesh, V, distance) & (np.abs(even - step).max(axis=1) == 0)
    if meeting.any():
        where = _near(mesh.V[np.argmax(meeting)])
        share = _share(mesh, meeting)
        if not round_off:
            raise OffsetError(
                f"the surface {distance:.3g} mm outside the object passes through itself {where}, where two sides face each other; "
                "widen the gap there"
            )
        remarks.append(
            f"two sides of the object face each other so closely {where} that their skins press on each other ({_in_words(share)})"
        )
    return Offset(Mesh(V, mesh.F, mesh.name), tuple(remarks))


def outward_steps(mesh: Mesh) -> FloatArray:
    """How each vertex moves for every mm that the faces about it move outward, (n, 3); at most `tolerances.OFFSET_MITRE` long."""
    corner, normal, weight = mesh.F.ravel(), np.repeat(mesh.face_normals, 3, axis=0), _corner_angles(mesh).ravel()
    n = len(mesh.V)

    def mean(values: FloatArray) -> FloatArray:
        return np.bincount(corner, weight * values, n) / total

    total = np.maximum(np.bincount(corner, weight, n), np.finfo(float).tiny)
    towards = np.stack([mean(normal[:, k]) for k in range(3)], axis=1)
    length = np.linalg.norm(towards, axis=1)
    unit = towards / np.maximum(length, np.finfo(float).tiny)[:, None]
    # One step along the mean normal that brings the planes to their distance, in the least-squares sense.
    facing = mean(np.einsum("ij,ij->i", normal, unit[corner]) ** 2)
    step: FloatArray = unit * np.divide(length, facing, out=np.zeros(n), where=facing > 0)[:, None]
    low, high = np.sin(np.divide(OFFSET_CREASE_RAD, 2)) ** 2
    # The second eigenvalue is at most what the mean normal leaves over.
    sharp = np.flatnonzero((1 - facing > low) & (length > 0))
    spread = np.stack([mean(normal[:, i] * normal[:, j])[sharp] for i in range(3) for j in range(3)], axis=1).reshape(-1, 3, 3)
    size, axes = np.linalg.eigh(spread)
    planes = np.einsum("nij,ni->nj", axes, towards[sharp]) / np.maximum(size, np.finfo(float).tiny)
    along = np.einsum("nij,ni->nj", axes, step[sharp])
    t = np.clip((size - low) / (high - low), 0.0, 1.0)
    t *= t * (3 - 2 * t)  # no jump from one triangulation to the next
    step[sharp] = np.einsum("nij,nj->ni", axes, t * planes + (1 - t) * along)
    far = np.linalg.norm(step, axis=1)
    step *= np.minimum(1.0, OFFSET_MITRE / np.maximum(far, np.finfo(float).tiny))[:, None]
    return step


def folds(mesh: Mesh, V: FloatArray) -> BoolArray:
    """Faces of which, moved to the vertices `V`, hardly anything is left, or that are turned over once or both ways, (m,)."""
    p, q = mesh.V[mesh.F], V[mesh.F]
    a, b, c, d = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0], q[:, 1] - q[:, 0], q[:, 2] - q[:, 0]
    left = np.einsum("ij,ij->i", np.cross(c, d), mesh.face_normals)
    # The inside of a ball smaller than the offset comes out with its front in front, but turned by half a circle: the trace of
    # the map from the old face to the new one is negative.
    trace = np.einsum("ij,ij->i", np.cross(b, mesh.face_normals), c) + np.einsum("ij,ij->i", np.cross(mesh.face_normals, a), d)
    folded: BoolArray = (left < OFFSET_LEAST_AREA * 2 * mesh.face_areas) | (trace < 0)
    return folded


def _corner_angles(mesh: Mesh) -> FloatArray:
    """(m, 3) rad; the faces of one plane weigh the same at a vertex, however they are triangulated."""
    p = mesh.V[mesh.F]
    angles = np.empty(mesh.F.shape)
    double = 2 * mesh.face_areas
    for k in range(3):
        a, b = p[:, (k + 1) % 3] - p[:, k], p[:, (k + 2) % 3] - p[:, k]
        angles[:, k] = np.arctan2(double, np.einsum("ij,ij->i", a, b))
    angles[double == 0] = 0.0
    return angles


def _without_folds(mesh: Mesh, step: FloatArray, distance: float) -> FloatArray:
    """The steps, evened out about folded triangles; where that does not help, drawn in."""
    E, n = mesh.topology.E, len(mesh.V)
    ones = np.ones(2 * len(E))
    neighbours = csr_array((ones, (np.concatenate([E[:, 0], E[:, 1]]), np.concatenate([E[:, 1], E[:, 0]]))), shape=(n, n))
    degree = np.maximum(np.bincount(E.ravel(), minlength=n), 1)
    step = step.copy()
    within = None
    for k in range(_EVEN_ROUNDS):
        folded = folds(mesh, mesh.V + distance * step)
        if not folded.any():
            return step
        near = _corners(mesh, folded)
        if within is None:
            away, _ = cKDTree(mesh.V[near]).query(mesh.V, distance_upper_bound=_REACH * distance)
            within = np.isfinite(away)
        for _ in range(min(1 + k // 4, _RINGS)):
            near = _corners(mesh, np.asarray(near[mesh.F].any(axis=1)))
        at = np.flatnonzero(near & within)
        around, by = neighbours[at], degree[at][:, None]
        # Half a step of Jacobi at a time: it settles on any mesh.
        for _ in range(3 + k):
            step[at] = (step[at] + (around @ step) / by) / 2
    for k in range(len(mesh.F)):
        folded = folds(mesh, mesh.V + distance * step)
        if not folded.any():
            break
        # A face that does not move does not fold: this ends.
        step[_corners(mesh, folded)] *= _DRAW_IN if k < _DRAW_ROUNDS else 0.0
    return step


def _corners(mesh: Mesh, faces: BoolArray) -> BoolArray:
    mask = np.zeros(len(mesh.V), dtype=bool)
    mask[mesh.F[faces]] = True
    return mask


def _largest(mesh: Mesh, step: FloatArray, distance: float) -> float:
    """The largest offset under `distance` that does not fold, mm."""
    low, high = 0.0, distance
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if folds(mesh, mesh.V + middle * step).any() else (middle, high)
    return low


def _meets_itself(mesh: Mesh, V: FloatArray, distance: float) -> BoolArray:
    """Vertices of the offset surface that are nearer to an opposite side of the object than it should be anywhere, (n,)."""
    import igl

    used = mesh.topology.used_vertices
    looked = used[:: -(-len(used) // _LOOKED_AT)]
    tree = igl.AABB()
    tree.init(mesh.V, mesh.F)
    squared, face, _ = tree.squared_distance(mesh.V, mesh.F, V[looked])
    outward = V[looked] - mesh.V[looked]
    towards = np.einsum("ij,ij->i", outward, mesh.face_normals[face])
    opposite = towards < _OPPOSITE * np.linalg.norm(outward, axis=1)
    near = np.zeros(len(mesh.V), dtype=bool)
    near[looked] = opposite & (squared < (OFFSET_NEAR * distance) ** 2)
    return near


def _rounded_off(mesh: Mesh, folded: BoolArray, step: FloatArray, even: FloatArray, distance: float) -> str:
    length, share = np.linalg.norm(even, axis=1), _share(mesh, _is_rounded(step, even))
    least = float(min(length[_corners(mesh, folded)].min() * distance, distance))
    return (
        f"the skin's neutral surface, {distance:.3g} mm outside the object, would fold over at {_count(folded)}, "
        f"{_place(mesh, folded)}; it is rounded off there ({_in_words(share)}), down to {least:.2g} mm outside"
    )


def _given_up(folded: BoolArray, share: float, distance: float) -> str:
    return (
        f"the skin's neutral surface, {distance:.3g} mm outside the object, would fold over at {_count(folded)} ({_in_words(share)}), so "
        "the object's own surface was flattened: the skin will be stretched on; a model without its fine grooves would do better"
    )


def _is_rounded(step: FloatArray, even: FloatArray) -> BoolArray:
    rounded: BoolArray = np.linalg.norm(even - step, axis=1) > 1 - OFFSET_NEAR
    return rounded


def _place(mesh: Mesh, folded: BoolArray) -> str:
    """Where the largest of these faces is."""
    face = int(np.argmax(np.where(folded, mesh.face_areas, -1.0)))
    return _near(mesh.V[mesh.F[face]].mean(axis=0))


def _near(point: FloatArray) -> str:
    return "near ({:.1f}, {:.1f}, {:.1f}) mm".format(*(point + 0.0))


def _count(folded: BoolArray) -> str:
    number = int(folded.sum())
    return f"{number} triangle" + ("" if number == 1 else "s")


def _share(mesh: Mesh, vertices: BoolArray) -> float:
    """Part of the surface about these vertices."""
    return float(mesh.face_areas @ vertices[mesh.F].mean(axis=1)) / mesh.area


def _in_words(share: float) -> str:
    if share < 1e-4:
        return "less than 0.01 % of the surface"
    return f"{100 * share:.0f} % of the surface" if share >= 0.1 else f"{100 * share:.2g} % of the surface"
