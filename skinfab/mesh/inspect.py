"""What a mesh is and what is wrong with it: every fault found once, at the door."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.mesh.fans import bowties, components, relative_heights, surplus_faces, unbalanced_edges, winding
from skinfab.mesh.faults import Fault, FaultList, edge_of, face, vertex
from skinfab.mesh.joined import joined
from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology
from skinfab.tolerances import DEGENERATE_HEIGHT, SLIVER_HEIGHT

IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Inspection:
    """What `inspect` found; every count refers to the mesh as given.

    `genus` has one entry a component: None where it is undefined (one-sided or not a manifold).
    """

    faces: int
    vertices: int
    components: int
    genus: tuple[int | None, ...]
    open_edges: int
    boundary_loops: int
    nonmanifold_edges: int
    nonmanifold_vertices: int
    degenerate_faces: int
    duplicate_faces: int
    nonfinite_vertices: int
    unreferenced_vertices: int
    inconsistent_edges: int
    one_sided_faces: int
    slivers: int
    size_mm: tuple[float, float, float]
    area_mm2: float
    faults: tuple[Fault, ...]

    @property
    def usable(self) -> bool:
        """No fault needs more than the harmless cleaning that is always done."""
        return not any(fault.blocks for fault in self.faults)

    @property
    def closed(self) -> bool:
        """There are faces, and no border."""
        return self.faces > 0 and self.open_edges == 0


def inspect(V: NDArray[np.float64], F: IntArray) -> Inspection:
    """Look a mesh over.

    Parameters
    ----------
    V : (n, 3) float64, mm
        May hold NaN and infinity.
    F : (m, 3) int64
        May use vertices that do not exist.

    Returns
    -------
    Inspection

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10]])
    >>> found = inspect(V, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))
    >>> found.genus, found.open_edges, found.usable
    ((0,), 0, True)
    """
    V = np.asarray(V, dtype=np.float64).reshape(-1, 3)
    F = np.asarray(F, dtype=np.int64).reshape(-1, 3)
    faults = FaultList()
    outside = np.asarray(((F < 0) | (F >= len(V))).any(axis=1))
    faults.look("index out of range", outside, face, "no", "export the mesh again")
    finite = np.asarray(np.isfinite(V).all(axis=1))
    faults.look("coordinate not finite", ~finite, vertex, "no", "export the mesh again")
    # A face with a fault above says nothing about shape; keep its place so that numbers stay the file's.
    readable = ~outside
    readable[readable] = finite[F[readable]].all(axis=1)
    repeated = (F == np.roll(F, 1, axis=1)).any(axis=1)
    height = np.ones(len(F))
    height[readable] = relative_heights(V, F[readable])
    flat = ~repeated & (height <= DEGENERATE_HEIGHT)
    sliver = ~repeated & ~flat & (height < SLIVER_HEIGHT)
    duplicate = surplus_faces(F) & ~repeated
    faults.look("degenerate face (a corner twice)", repeated, face, "clean", "dropped")
    faults.look("degenerate face (no area)", flat, face, "clean", "merged into its neighbours")
    faults.look("duplicate face", duplicate, face, "clean", "dropped, one is kept where the surface needs it")
    sound = F[readable & ~repeated & ~duplicate]
    unused = np.ones(len(V), dtype=bool)
    unused[F[~outside & ~repeated]] = False
    faults.look("unreferenced vertex", unused, vertex, "clean", "dropped")
    top = Topology(sound)
    bowtie = bowties(top, len(V))
    inconsistent, one_sided = _look_at_joins(top, bowtie, faults)
    faults.look("sliver", sliver, face, "nothing", "kept; flattening allows for it")
    faults.look("open edge", top.is_boundary, edge_of(top), "nothing", "kept as a border; --repair closes small holes")
    area = Mesh(V, sound).area if len(sound) else 0.0
    if not area > 0:
        faults.found.append(Fault("no area", 1, "the whole mesh", "export it as a surface mesh", "no"))
    count, label = components(top)
    size = np.ptp(V[~unused & finite], axis=0) if len(sound) else np.zeros(3)
    return Inspection(
        faces=len(F),
        vertices=len(V),
        components=count,
        genus=_genus(top, label, count, bowtie, one_sided),
        open_edges=int(top.is_boundary.sum()),
        boundary_loops=int(_loops(top, label, count).sum()),
        nonmanifold_edges=int(top.is_nonmanifold.sum()),
        nonmanifold_vertices=int(bowtie.sum()),
        degenerate_faces=int(repeated.sum() + flat.sum()),
        duplicate_faces=int(duplicate.sum()),
        nonfinite_vertices=int((~finite).sum()),
        unreferenced_vertices=int(unused.sum()),
        inconsistent_edges=int(inconsistent.sum()),
        one_sided_faces=int(one_sided.sum()),
        slivers=int(sliver.sum()),
        size_mm=(float(size[0]), float(size[1]), float(size[2])),
        area_mm2=area,
        faults=tuple(faults.found),
    )


def _look_at_joins(top: Topology, bowtie: NDArray[np.bool_], faults: FaultList) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Faults in how faces meet. Returns the inconsistent edges (e,) and the one-sided faces (m,)."""
    wound = winding(top)
    two = np.flatnonzero(top.edge_count == 2)
    (f, g), (i, j) = top.EF[two].T, top.EC[two].T
    inconsistent = np.zeros(len(top.E), dtype=bool)
    inconsistent[two] = (top.F[f, i] == top.F[g, j]) & ~wound.one_sided[f]
    unbalanced = unbalanced_edges(top, wound.turn)
    name = edge_of(top)
    corner = _first_edge_of(top, wound.one_sided)
    faults.look("inconsistent winding", inconsistent, name, "clean", "the smaller part of the faces is turned over")
    faults.look("one-sided surface (Moebius band)", corner, name, "no", "it has no outside: cut it open in a mesh editor")
    faults.look("non-manifold edge where sheets touch", top.is_nonmanifold & ~unbalanced, name, "clean", "the sheets are parted")
    faults.look("non-manifold edge", unbalanced, name, "repair", "faces are removed until two are left at each edge")
    faults.look("non-manifold vertex (bow-tie)", bowtie, vertex, "clean", "doubled: one for each fan of faces")
    return inconsistent, wound.one_sided


def _first_edge_of(top: Topology, faces: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(e,) marks one edge: a side of the first of `faces`; none if there are no such faces."""
    out = np.zeros(len(top.E), dtype=bool)
    if faces.any():
        out[top.FE[np.argmax(faces), 0]] = True
    return out


def _loops(top: Topology, label: IntArray, count: int) -> IntArray:
    """Boundary loops of each component (c,); loops that touch at a bow-tie count as one."""
    edges = np.flatnonzero(top.is_boundary)
    if not len(edges):
        return np.zeros(count, dtype=np.int64)
    vertices, ends = np.unique(top.E[edges], return_inverse=True)
    a, b = ends.reshape(-1, 2).T
    found, loop = joined(a, b, len(vertices))
    owner = np.empty(found, dtype=np.int64)
    owner[loop[a]] = label[top.EF[edges, 0]]
    return np.bincount(owner, minlength=count)


def _genus(top: Topology, label: IntArray, count: int, bowtie: NDArray[np.bool_], one_sided: NDArray[np.bool_]) -> tuple[int | None, ...]:
    """2 - 2g - b = V - E + F for each component that is an orientable manifold."""
    if not count:
        return ()
    n = int(top.F.max()) + 1
    vertex_owner = np.unique(label[:, None] * n + top.F) // n
    euler = np.bincount(vertex_owner, minlength=count) + np.bincount(label, minlength=count)
    euler -= np.bincount(label[top.EF[:, 0]], minlength=count)
    undefined = np.zeros(count, dtype=bool)
    undefined[label[bowtie[top.F].any(axis=1) | top.is_nonmanifold[top.FE].any(axis=1) | one_sided]] = True
    twice = 2 - _loops(top, label, count) - euler
    return tuple(None if bad else int(g) for bad, g in zip(undefined, twice // 2, strict=True))
