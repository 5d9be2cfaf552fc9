"""Seams by hand on a skin: cut, glue, lock, forbid, and paint where seams should run.

Each function takes a skin and gives one with other seams or marks; what changes nothing gives the same skin. The flat
pieces stay as they were until `partial.reopen` opens the object along the new seams.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.seams.rules import edge_mask
from skinfab.seams.ways import Ways
from skinfab.skin import SeamMarks, Skin

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]


def preview_path(skin: Skin, start: int, end: int, *, ways: Ways | None = None) -> IntArray:
    """The way that `cut_path` would cut from vertex `start` to vertex `end`, (k,) vertices; empty where there is none.

    Parameters
    ----------
    ways : Ways, optional
        Kept from the last call: where it suits the skin and `start` is the same, nothing is searched anew.
    """
    return (ways if ways is not None and ways.suit(skin) else Ways(skin.mesh, skin.marks)).path(start, end)


def path_edges(mesh: Mesh, path: ArrayLike) -> IntArray:
    """Edge ids along a path of neighbouring vertices, (k - 1,).

    Raises
    ------
    InputError
        Two vertices in a row share no edge.
    """
    vertices = np.asarray(path, dtype=np.int64).reshape(-1)
    edges = mesh.topology.edge_ids(np.stack([vertices[:-1], vertices[1:]], axis=1))
    if (edges < 0).any():
        k = int(np.argmax(edges < 0))
        raise InputError(f"vertices {vertices[k]} and {vertices[k + 1]} share no edge; give a path over edges")
    return edges


def cut_path(skin: Skin, vertices: Sequence[int], *, ways: Ways | None = None) -> Skin:
    """Cut along the cheapest ways through `vertices`, creases preferred, marks respected.

    Parameters
    ----------
    skin : Skin
    vertices : sequence of int
        Mesh vertices in order; a closed loop ends where it began.
    ways : Ways, optional
        Of this skin, to save the search.

    Returns
    -------
    Skin
        The same one where all of it was cut already, or lies on the object's border.

    Raises
    ------
    InputError
        Fewer than two vertices, one that does not exist, or two that no way joins.
    """
    points = [int(v) for v in vertices]
    if len(points) < 2:
        raise InputError(f"a cut needs two points, {'this has one' if points else 'none was given'}; click where it is to end")
    missing = [v for v in points if not 0 <= v < len(skin.mesh.V)]
    if missing:
        raise InputError(f"vertex {missing[0]} does not exist; the mesh has vertices 0 to {len(skin.mesh.V) - 1}")
    if ways is None or not ways.suit(skin):
        ways = Ways(skin.mesh, skin.marks)
    cut = edge_mask(skin.mesh, skin.seams)
    for a, b in pairwise(points):
        path = ways.path(a, b)
        if not len(path):
            raise _no_way(skin, a, b)
        cut[path_edges(skin.mesh, path)] = True
    return _with_seams(skin, cut)


def chain(mesh: Mesh, seams: IntArray, edge: int) -> IntArray:
    """The unbroken seam that an edge is on: edge ids in order, (k,).

    It ends where seams end, branch or meet the object's border; one that meets none of these is a closed loop.

    Parameters
    ----------
    mesh : Mesh
    seams : (k, 2) int64
        Vertex pairs.
    edge : int
        Edge id of ``mesh.topology``.

    Raises
    ------
    InputError
        The edge is not on a seam.

    Examples
    --------
    >>> strip = Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 2, 0]]), np.array([[0, 1, 2], [1, 3, 2], [2, 3, 4]]))
    >>> inner = np.array([[1, 2], [2, 3]])
    >>> strip.topology.E[chain(strip, inner, strip.topology.edge_ids(inner)[0])].tolist()
    [[1, 2]]
    """
    topology = mesh.topology
    is_seam = edge_mask(mesh, seams) & ~topology.is_boundary
    if not 0 <= edge < len(is_seam) or not is_seam[edge]:
        raise InputError(f"edge {edge} is not on a seam; point at a seam")
    on_border = np.zeros(len(mesh.V), dtype=bool)
    on_border[topology.E[topology.is_boundary]] = True
    at: dict[int, list[int]] = {}
    for e in np.flatnonzero(is_seam).tolist():
        for v in topology.E[e].tolist():
            at.setdefault(v, []).append(e)
    a, b = topology.E[edge].tolist()
    forth = _walk(topology.E, at, on_border, edge, b)
    if forth and b != a and _closes(topology.E, forth, a, at, on_border):
        return np.array([edge, *forth], dtype=np.int64)
    back = _walk(topology.E, at, on_border, edge, a)
    return np.array([*back[::-1], edge, *forth], dtype=np.int64)


def glue(skin: Skin, edge: int) -> Skin:
    """Join the object again along the whole unbroken seam (`chain`) that an edge is on.

    Raises
    ------
    InputError
        The edge is on no seam, or the seam is locked.
    """
    edges = chain(skin.mesh, skin.seams, edge)
    if skin.marks is not None and edge_mask(skin.mesh, skin.marks.locked)[edges].any():
        raise InputError("this seam is locked; unlock it before gluing it")
    return _with_seams(skin, _less(edge_mask(skin.mesh, skin.seams), edges))


def lock(skin: Skin, edges: ArrayLike) -> Skin:
    """Keep `edges` (k,) cut whatever an automatic cut does; those that are no seams yet are cut.

    Raises
    ------
    InputError
        One of them is forbidden.
    """
    chosen, marks = _inner(skin, edges), _marks(skin)
    forbidden = edge_mask(skin.mesh, marks.forbidden)
    if forbidden[chosen].any():
        raise InputError("part of this is forbidden to cut; allow it before locking it")
    return _with_marks(
        _with_seams(skin, _more(edge_mask(skin.mesh, skin.seams), chosen)),
        locked=_more(edge_mask(skin.mesh, marks.locked), chosen),
    )


def unlock(skin: Skin, edges: ArrayLike) -> Skin:
    """Let an automatic cut decide about `edges` (k,) again; they stay seams until then."""
    return _with_marks(skin, locked=_less(edge_mask(skin.mesh, _marks(skin).locked), _inner(skin, edges)))


def forbid(skin: Skin, edges: ArrayLike) -> Skin:
    """Never cut `edges` (k,); those that are seams are glued.

    Raises
    ------
    InputError
        One of them is locked.
    """
    chosen, marks = _inner(skin, edges), _marks(skin)
    if edge_mask(skin.mesh, marks.locked)[chosen].any():
        raise InputError("part of this is a locked seam; unlock it before forbidding it")
    return _with_marks(
        _with_seams(skin, _less(edge_mask(skin.mesh, skin.seams), chosen)),
        forbidden=_more(edge_mask(skin.mesh, marks.forbidden), chosen),
    )


def allow(skin: Skin, edges: ArrayLike) -> Skin:
    """Let `edges` (k,) be cut again."""
    return _with_marks(skin, forbidden=_less(edge_mask(skin.mesh, _marks(skin).forbidden), _inner(skin, edges)))


def paint(skin: Skin, faces: ArrayLike, value: int) -> Skin:
    """Say of mesh `faces` (k,) that seams are wanted there (1), not wanted (-1), or either (0).

    Raises
    ------
    InputError
        A face that does not exist, or another value.
    """
    if value not in (-1, 0, 1):
        raise InputError(f"{value} is no preference; there are -1 (avoid), 0 and 1 (attract)")
    chosen = np.asarray(faces, dtype=np.int64).reshape(-1)
    if ((chosen < 0) | (chosen >= len(skin.mesh.F))).any():
        raise InputError(f"a face to paint does not exist; the mesh has faces 0 to {len(skin.mesh.F) - 1}")
    preference = _marks(skin).preference.copy()
    preference[chosen] = value
    return _with_marks(skin, preference=preference)


def _walk(E: IntArray, at: dict[int, list[int]], on_border: BoolArray, edge: int, vertex: int) -> list[int]:
    """Edges beyond `edge` over `vertex` as far as the seam is unbroken; a closed one ends before `edge` comes again."""
    first, walked = edge, []
    while len(at[vertex]) == 2 and not on_border[vertex]:
        edge = at[vertex][0] if at[vertex][1] == edge else at[vertex][1]
        if edge == first:
            break
        walked.append(edge)
        vertex = int(E[edge].sum()) - vertex
    return walked


def _closes(E: IntArray, forth: list[int], start: int, at: dict[int, list[int]], on_border: BoolArray) -> bool:
    """Whether the walk came round to where it began."""
    return start in E[forth[-1]].tolist() and len(at[start]) == 2 and not on_border[start]


def _no_way(skin: Skin, a: int, b: int) -> InputError:
    _, label = skin.mesh.topology.face_components()
    corner_of = {v: set(label[(skin.mesh.F == v).any(axis=1)].tolist()) for v in (a, b)}
    if corner_of[a] & corner_of[b]:
        return InputError(f"every way from vertex {a} to vertex {b} is forbidden; allow some edges, or click elsewhere")
    return InputError(f"vertices {a} and {b} lie on different parts of the object, which no seam can join; click two points of one part")


def _inner(skin: Skin, edges: ArrayLike) -> IntArray:
    """Edge ids without those on the object's border, which are open anyway."""
    chosen = np.asarray(edges, dtype=np.int64).reshape(-1)
    boundary = skin.mesh.topology.is_boundary
    if ((chosen < 0) | (chosen >= len(boundary))).any():
        raise InputError(f"an edge does not exist; the mesh has edges 0 to {len(boundary) - 1}")
    return chosen[~boundary[chosen]]


def _marks(skin: Skin) -> SeamMarks:
    return skin.marks if skin.marks is not None else SeamMarks.none(len(skin.mesh.F))


def _more(mask: BoolArray, edges: IntArray) -> BoolArray:
    mask[edges] = True
    return mask


def _less(mask: BoolArray, edges: IntArray) -> BoolArray:
    mask[edges] = False
    return mask


def _with_seams(skin: Skin, cut: BoolArray) -> Skin:
    topology = skin.mesh.topology
    cut = cut & ~topology.is_boundary
    if np.array_equal(cut, edge_mask(skin.mesh, skin.seams)):
        return skin
    return replace(skin, seams=topology.E[cut])


def _with_marks(
    skin: Skin, *, locked: BoolArray | None = None, forbidden: BoolArray | None = None, preference: NDArray[np.int8] | None = None
) -> Skin:
    """The skin with some of its marks replaced; itself where they say the same."""
    E, old = skin.mesh.topology.E, _marks(skin)
    new = SeamMarks(
        old.locked if locked is None else E[locked],
        old.forbidden if forbidden is None else E[forbidden],
        old.preference if preference is None else preference,
    )
    if all(np.array_equal(getattr(new, name), getattr(old, name)) for name in ("locked", "forbidden", "preference")):
        return skin
    return replace(skin, marks=None if new.empty else new)
