"""Small shapes with known answers, for the tests: each gives (V, F), V in mm."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial import Delaunay

from skinfab.mesh.io import load_mesh
from skinfab.mesh.model import Mesh

MESHES = Path(__file__).resolve().parents[1] / "meshes"


def grid_faces(columns: int, rows: int) -> np.ndarray:
    """Two triangles a cell; vertex (i, j) has number j (columns + 1) + i."""
    i, j = np.meshgrid(np.arange(columns), np.arange(rows))
    a = (j * (columns + 1) + i).ravel()
    b, c, d = a + 1, a + columns + 2, a + columns + 1
    return np.stack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)], axis=1).reshape(-1, 3)


def grid(columns: int, rows: int, place=lambda s, t: np.stack([s, t, 0 * s], axis=1)):
    """A sheet: `place` puts the parameters s, t in [0, 1] into space."""
    s, t = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    return place(s.ravel(), t.ravel()), grid_faces(columns, rows)


def wavy(n: int = 12, height: float = 0.2):
    """A square with soft bumps: a disk that cannot lie flat."""
    return grid(n, n, lambda s, t: np.stack([s, t, height * np.sin(3 * s) * np.cos(2 * t)], axis=1))


def cylinder_sheet(columns: int = 24, rows: int = 10, radius: float = 1.0, height: float = 3.0):
    """A cylinder opened along one line: it lies flat as a rectangle."""
    a = 2 * np.pi
    return grid(columns, rows, lambda s, t: np.stack([radius * np.cos(a * s), radius * np.sin(a * s), height * t], axis=1))


def cone_sheet(columns: int = 24, rows: int = 10, low: float = 2.0, high: float = 1.0, height: float = 2.0):
    """A cone frustum opened along one line: it lies flat as a sector of a ring."""

    def place(s, t):
        r, a = low + (high - low) * t, 2 * np.pi * s
        return np.stack([r * np.cos(a), r * np.sin(a), height * t], axis=1)

    return grid(columns, rows, place)


def helicoid(turns: float = 2.0, columns: int = 160, rows: int = 8):
    """A spiral ramp about an open shaft: flat, two turns lie on each other."""

    def place(s, t):
        r, a = 0.5 + 0.8 * t, 2 * np.pi * turns * s
        return np.stack([r * np.cos(a), r * np.sin(a), 0.05 * a], axis=1)

    V, F = grid(columns, rows, place)
    return V, F[:, ::-1].copy()


def cap(rings: int = 10, angle: float = np.pi / 2, radius: float = 1.0):
    """A sphere cap of the half opening `angle`: pole, then rings of 6 k vertices; area 2 pi r^2 (1 - cos angle)."""
    V, first = [np.array([[0.0, 0.0, radius]])], [0, 1]
    for k in range(1, rings + 1):
        a, polar = 2 * np.pi * np.arange(6 * k) / (6 * k), angle * k / rings
        V.append(radius * np.stack([np.sin(polar) * np.cos(a), np.sin(polar) * np.sin(a), np.full(6 * k, np.cos(polar))], axis=1))
        first.append(first[-1] + 6 * k)
    F = []
    for k in range(1, rings + 1):
        for side in range(6):
            for i in range(k):
                out = [first[k] + (side * k + i + s) % (6 * k) for s in (0, 1)]
                inner = [first[k - 1] + (side * (k - 1) + i + s) % max(6 * (k - 1), 1) for s in (0, 1)]
                F.append([inner[0], *out])
                if i < k - 1:
                    F.append([inner[0], out[1], inner[1]])
    return np.vstack(V), np.array(F)


def sphere(subdivisions: int = 2):
    """A closed icosphere of radius 1."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=subdivisions)
    return np.array(ball.vertices), np.array(ball.faces, dtype=np.int64)


def torus(major: float = 3.0, minor: float = 1.0, columns: int = 36, rows: int = 16):
    """A closed torus; its two generators measure 2 pi (major - minor) and 2 pi minor."""
    i, j = np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij")
    a, b = 2 * np.pi * i.ravel() / columns, 2 * np.pi * j.ravel() / rows
    r = major + minor * np.cos(b)
    here, right = i * rows + j, (i + 1) % columns * rows + j
    up, both = i * rows + (j + 1) % rows, (i + 1) % columns * rows + (j + 1) % rows
    F = np.stack([np.stack([here, right, both], axis=-1), np.stack([here, both, up], axis=-1)], axis=2).reshape(-1, 3)
    return np.stack([r * np.cos(a), r * np.sin(a), minor * np.sin(b)], axis=1), F


def holed(n: int = 12, holes: tuple[tuple[int, int], ...] = ((3, 3), (8, 8))):
    """A flat square of n x n cells without the cells named (column, row)."""
    V, F = grid(n, n)
    cell = [2 * (j * n + i) + k for i, j in holes for k in (0, 1)]
    return V * n, np.delete(F, cell, axis=0)


def random_disk(seed: int, count: int = 80, noise: float = 0.1):
    """Random points in the unit disk, triangulated, with random heights: slivers at its border and all."""
    rng = np.random.default_rng(seed)
    r, a = np.sqrt(rng.random(count)), 2 * np.pi * rng.random(count)
    flat = np.stack([r * np.cos(a), r * np.sin(a)], axis=1)
    F = Delaunay(flat).simplices.astype(np.int64)
    p = flat[F]
    e, f = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    turned = e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0] < 0
    F[turned] = F[turned][:, ::-1]
    return np.column_stack([flat, noise * rng.standard_normal(count)]), F


def cube(n: int = 1):
    """A closed cube of side 1 with n x n cells a side."""
    sheets = []
    for axis in range(3):
        for end in (0.0, 1.0):

            def place(s, t, axis=axis, end=end):
                p = np.empty((len(s), 3))
                p[:, axis], p[:, (axis + 1) % 3], p[:, (axis + 2) % 3] = end, s, t
                return p

            V, F = grid(n, n, place)
            sheets.append((V, F if end else F[:, ::-1]))
    V = np.vstack([v for v, _ in sheets])
    F = np.vstack([f + k * len(sheets[0][0]) for k, (_, f) in enumerate(sheets)])
    _, first, inverse = np.unique((V * n).round().astype(int), axis=0, return_index=True, return_inverse=True)
    return V[first], inverse.reshape(-1)[F]


def rotation(seed: int) -> np.ndarray:
    """A random proper rotation, (3, 3)."""
    q, r = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


def relabelled(V, F, seed: int):
    """The same surface with its vertices and faces in another order; also the new place of each vertex."""
    rng = np.random.default_rng(seed)
    place, order = rng.permutation(len(V)), rng.permutation(len(F))
    W = np.empty_like(V)
    W[place] = V
    return W, place[F][order], place


def object_mesh(name: str) -> Mesh:
    """One of the seven objects."""
    return load_mesh(MESHES / f"{name}.obj").mesh
