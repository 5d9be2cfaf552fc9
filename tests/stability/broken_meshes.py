"""Broken and odd mesh files, each with what skinfab is to do with it."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

Corners = Sequence[Sequence[float]]
Faces = Sequence[Sequence[int]]


@dataclass(frozen=True)
class Case:
    """A file and its fate.

    Parameters
    ----------
    file : str
    data : bytes
    fate : str
        "as is" (nothing to mend), "cleaned" (mended without asking, and said), "repaired" (refused without
        ``--repair``, usable with it) or "refused".
    says : str
        A part of the note (cleaned) or of the error (repaired, refused).
    """

    file: str
    data: bytes
    fate: str
    says: str = ""


def obj(V: Corners, F: Faces) -> bytes:
    lines = ["v {:.17g} {:.17g} {:.17g}".format(*v) for v in V] + ["f " + " ".join(str(i + 1) for i in f) for f in F]
    return ("\n".join(lines) + "\n").encode()


def grid(n: int = 10, size: float = 50.0) -> tuple[list[list[float]], list[list[int]]]:
    """A wavy sheet."""
    V = [[i / n * size, j / n * size, size / 5 * np.sin(3 * i / n) * np.cos(2 * j / n)] for j in range(n + 1) for i in range(n + 1)]
    F = []
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i
            F += [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    return V, F


def box(low: Sequence[float], size: float = 20.0) -> tuple[list[list[float]], list[list[int]]]:
    V = [[low[0] + x * size, low[1] + y * size, low[2] + z * size] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return V, [[q[0], q[i], q[i + 1]] for q in quads for i in (1, 2)]


def sphere(n: int = 16, radius: float = 20.0) -> tuple[list[list[float]], list[list[int]]]:
    V = [[0.0, 0.0, radius]]
    for j in range(1, n):
        p = np.pi * j / n
        V += [
            [radius * np.sin(p) * np.cos(2 * np.pi * i / n), radius * np.sin(p) * np.sin(2 * np.pi * i / n), radius * np.cos(p)]
            for i in range(n)
        ]
    V.append([0.0, 0.0, -radius])
    F = [[0, 1 + i, 1 + (i + 1) % n] for i in range(n)]
    for j in range(n - 2):
        for i in range(n):
            a, b = 1 + j * n + i, 1 + j * n + (i + 1) % n
            F += [[a, a + n, b + n], [a, b + n, b]]
    last = len(V) - 1
    F += [[last, last - n + (i + 1) % n, last - n + i] for i in range(n)]
    return V, F


def moebius(n: int = 40) -> tuple[list[list[float]], list[list[int]]]:
    V, F = [], []
    for i in range(n):
        t = 2 * np.pi * i / n
        V += [
            [30 * (1 + s * np.cos(t / 2)) * np.cos(t), 30 * (1 + s * np.cos(t / 2)) * np.sin(t), 30 * s * np.sin(t / 2)]
            for s in (-0.3, 0, 0.3)
        ]
        for k in range(2):
            a = 3 * i + k
            c, d = (a + 3, a + 4) if i < n - 1 else (2 - k, 1 - k)
            F += [[a, c, d], [a, d, a + 1]]
    return V, F


def annulus(n: int = 60) -> tuple[list[list[float]], list[list[int]]]:
    V = [
        [30 * (1 + j / 10) * np.cos(2 * np.pi * i / n), 30 * (1 + j / 10) * np.sin(2 * np.pi * i / n), 0]
        for j in range(6)
        for i in range(n)
    ]
    F = []
    for j in range(5):
        for i in range(n):
            a, b = j * n + i, j * n + (i + 1) % n
            F += [[a, a + n, b + n], [a, b + n, b]]
    return V, F


def helicoid(turns: int = 2, n: int = 160) -> tuple[list[list[float]], list[list[int]]]:
    """A ramp of two turns: any isometric map of it covers itself."""
    angles = np.linspace(0, 2 * np.pi * turns, n + 1)
    V = [[(20 + 4 * k) * np.cos(t), (20 + 4 * k) * np.sin(t), 2 * t] for t in angles for k in range(9)]
    F = []
    for i in range(n):
        for k in range(8):
            a = i * 9 + k
            F += [[a, a + 1, a + 10], [a, a + 10, a + 9]]
    return V, F


def stl(triangles: np.ndarray, *, claimed: int | None = None) -> bytes:
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *t.ravel(), 0) for t in triangles)
    return bytes(80) + struct.pack("<I", len(triangles) if claimed is None else claimed) + body


def _joined(*parts: tuple[Corners, Faces]) -> bytes:
    V: list[Sequence[float]] = []
    F: list[list[int]] = []
    for v, f in parts:
        F += [[i + len(V) for i in face] for face in f]
        V += v
    return obj(V, F)


def _moved(mesh: tuple[Corners, Faces], by: Sequence[float], scale: float = 1.0) -> tuple[list[list[float]], Faces]:
    return [[scale * x + b for x, b in zip(v, by, strict=True)] for v in mesh[0]], mesh[1]


def _with_vertex(V: Corners, k: int, value: Sequence[float]) -> list[Sequence[float]]:
    return [value if i == k else v for i, v in enumerate(V)]


def all_cases() -> list[Case]:
    """Every case, in the order: sheets, closed shapes, scales, files that are no meshes."""
    return _sheets() + _solids() + _not_meshes()


def _sheets() -> list[Case]:
    V, F = grid()
    n = len(V)
    mirrored = [[-v[0], -v[1], v[2]] for v in V]
    bowtie = F + [[0 if i == 0 else i + n - 1 for i in f] for f in F]
    strip = [[3 * i, (i % 2) * 5, 0] for i in range(41)]
    quads = [[j * 11 + i, j * 11 + i + 1, (j + 1) * 11 + i + 1, (j + 1) * 11 + i] for j in range(10) for i in range(10)]
    ring = [[30 * np.cos(2 * np.pi * i / 300), 30 * np.sin(2 * np.pi * i / 300), 0] for i in range(300)]
    star = [[(30 if i % 2 else 12) * np.cos(np.pi * i / 5), (30 if i % 2 else 12) * np.sin(np.pi * i / 5), 0] for i in range(10)]
    return [
        Case("grid.obj", obj(V, F), "as is"),
        Case("single_triangle.obj", obj([[0, 0, 0], [30, 0, 0], [0, 30, 0]], [[0, 1, 2]]), "as is"),
        Case("two_triangles.obj", obj([[0, 0, 0], [30, 0, 0], [30, 30, 9], [0, 30, 0]], [[0, 1, 2], [0, 2, 3]]), "as is"),
        Case("quads.obj", obj(V, quads), "as is"),
        Case("polygon_300.obj", obj(ring, [list(range(300))]), "as is"),
        Case("polygon_star.obj", obj(star, [list(range(10))]), "as is"),
        Case("one_hole.obj", obj(V, F[:88] + F[92:]), "as is"),
        Case("annulus.obj", obj(*annulus()), "as is"),
        Case("helicoid.obj", obj(*helicoid()), "as is"),
        Case("strip.obj", obj(strip, [[i, i + 1, i + 2] if i % 2 == 0 else [i + 1, i, i + 2] for i in range(39)]), "as is"),
        Case("two_components.obj", _joined((V, F), _moved((V, F), (150, 0, 0))), "as is"),
        Case("sliver.obj", obj([[v[0], v[1] * 1e-5, v[2] * 0] for v in V], F), "as is"),
        Case("isolated_last.obj", obj([*V, [90, 90, 90]], F), "cleaned", "unreferenced vertex (first: vertex 121)"),
        Case(
            "isolated_first.obj",
            obj([[90, 90, 90], *V], [[i + 1 for i in f] for f in F]),
            "cleaned",
            "unreferenced vertex (first: vertex 0)",
        ),
        Case("duplicate_face.obj", obj(V, [*F, F[50]]), "cleaned", "duplicate face (first: face 200)"),
        Case("flipped_duplicate.obj", obj(V, [*F, F[50][::-1]]), "cleaned", "duplicate face (first: face 200)"),
        Case("corner_twice.obj", obj(V, [*F, [0, 0, 1]]), "cleaned", "degenerate face (first: face 200)"),
        Case("zero_area.obj", obj(_with_vertex(V, 60, V[61]), F), "cleaned", "without area"),
        Case("collinear.obj", obj([[0, 0, 0], [20, 0, 0], [40, 0, 0], [20, 20, 0]], [[0, 1, 2], [0, 2, 3]]), "cleaned", "without area"),
        Case("mixed_winding.obj", obj(V, [f[::-1] if k % 3 == 0 else f for k, f in enumerate(F)]), "cleaned", "turned over 67 faces"),
        Case("bowtie.obj", obj(V + mirrored[1:], bowtie), "cleaned", "doubled 1 vertex"),
        Case("moebius.obj", obj(*moebius()), "refused", "one-sided"),
        Case("fin.obj", obj([*V, [25, 25, 40]], [*F, [60, 61, n]]), "repaired", "non-manifold edge (first: edge 60-61)"),
        Case("nan.obj", obj(_with_vertex(V, 60, [1, 2, float("nan")]), F), "refused", "line 61"),
        Case("inf.obj", obj(_with_vertex(V, 60, [1, float("inf"), 2]), F), "refused", "line 61"),
    ]


def _solids() -> list[Case]:
    V, F = sphere()
    needle = _with_vertex(V, 0, [0, 0, 400.0])
    soup = np.array(V)[np.array(F)]
    one, two = box((0, 0, 0)), box((20, 20, 0))
    flat = [[v[0], 0, 0] for v in V]
    return [
        Case("sphere.obj", obj(V, F), "as is"),
        Case("needle.obj", obj(needle, F), "as is"),
        Case("sphere.stl", stl(soup), "as is"),
        Case("soup.obj", obj(soup.reshape(-1, 3), np.arange(3 * len(F)).reshape(-1, 3)), "cleaned", "coincident vertices"),
        Case("inside_out.obj", obj(V, [f[::-1] for f in F]), "cleaned", "faced inward"),
        Case("cubes_one_edge.obj", _joined(one, two), "as is"),
        Case(
            "cubes_one_edge.stl", stl(np.concatenate([np.array(b[0])[np.array(b[1])] for b in (one, two)])), "cleaned", "doubled 2 vertices"
        ),
        Case("hollow.obj", _joined((V, F), _moved((V, [f[::-1] for f in F]), (0, 0, 0), 0.5)), "as is"),
        Case("no_area.obj", obj(flat, F), "refused", "no area"),
        Case("tiny.obj", obj(*_moved(one, (0, 0, 0), 1e-7)), "as is"),
        Case("huge.obj", obj(*_moved(one, (0, 0, 0), 1e6)), "as is"),
        Case("far_away.obj", obj(*_moved(one, (1e7, 0, 0))), "as is"),
    ]


def _not_meshes() -> list[Case]:
    V, F = grid()
    good = obj(V, F)
    ply = b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    ply += b"element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    corner = b"v 0 0 0\nv 30 0 0\nv 0 30 0\n"
    return [
        Case("empty.obj", b"", "refused", "is empty"),
        Case("blank.obj", b"\n\n", "refused", "is empty"),
        Case("comments.obj", b"# nothing here\n", "refused", "no vertices"),
        Case("vertices_only.obj", obj(V, []), "refused", "no faces"),
        Case("faces_only.obj", b"f 1 2 3\n", "refused", "no vertices"),
        Case("out_of_range.obj", corner + b"f 1 2 9\n", "refused", "line 4: face 1 uses vertex 9"),
        Case("index_zero.obj", corner + b"f 0 1 2\n", "refused", "line 4"),
        Case("index_huge.obj", corner + b"f 1 2 99999999999999999999999\n", "refused", "line 4"),
        Case("index_back_too_far.obj", corner + b"f -1 -2 -4\n", "refused", "line 4"),
        Case("only_f_1_1_2.obj", corner + b"f 1 1 2\n", "refused", "no area"),
        Case("face_of_two.obj", corner + b"f 1 2 3\nf 1 2\n", "refused", "line 5"),
        Case("vertex_of_two.obj", b"v 0 0\n" + corner + b"f 1 2 3\n", "refused", "line 1"),
        Case("words.obj", b"\x01hello\nf a b c\nv 1 2\n", "refused", "line 2"),
        Case("zero_bytes.obj", b"\x00\x01hello\nf a b c\n", "refused", "not an OBJ text"),
        Case("comma_numbers.obj", b"v 0,5 1 2\n" + corner + b"f 1 2 3\n", "refused", "line 1: '0,5'"),
        Case("long_line.obj", good + b"# " + b"x" * 10_000_000 + b"\n", "as is"),
        Case("long_face.obj", corner + b"f" + b" 1 2 3" * 1_700_000 + b"\n", "refused", "line 4: face 1 has 5100000 corners"),
        Case("long_word.obj", b"v " + b"1" * 10_000_000 + b" 0 0\n" + corner + b"f 2 3 4\n", "refused", "line 1"),
        Case("cut_off.obj", good[: len(good) // 3], "refused", "no faces"),
        Case("picture.gif", good, "refused", "give one of .obj"),
        Case("claims_4e9.stl", stl(np.zeros((2, 3, 3)), claimed=4_000_000_000), "refused", "claims 4000000000"),
        Case("no_triangles.stl", stl(np.zeros((0, 3, 3))), "refused", "no triangles"),
        Case("short.stl", b"short", "refused", "no STL"),
        Case("text_cut.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n", "refused", "cut off"),
        Case("text_words.stl", b"solid a\n" + b"vertex a b c\n" * 3 + b"endsolid\n", "refused", "no numbers"),
        Case("nan.stl", stl(np.full((1, 3, 3), np.nan)), "refused", "not finite"),
        Case("good.ply", ply + b"0 0 0\n30 0 0\n0 30 0\n3 0 1 2\n", "as is"),
        Case("out_of_range.ply", ply + b"0 0 0\n30 0 0\n0 30 0\n3 0 1 7\n", "refused", "face 0"),
        Case("cut.ply", ply + b"0 0 0\n30 0", "refused", "cannot be read as PLY"),
        Case("claims.ply", ply.replace(b"vertex 3", b"vertex 4000000000") + b"0 0 0\n", "refused", "claims 4000000000"),
        Case("garbage.ply", bytes(range(1, 200)), "refused", "no PLY"),
        Case("good.off", b"OFF\n3 1 0\n0 0 0\n30 0 0\n0 30 0\n3 0 1 2\n", "as is"),
        Case("claims.off", b"OFF\n4000000000 1 0\n0 0 0\n", "refused", "claims more"),
        Case("cut.off", b"OFF\n3 1 0\n0 0 0\n", "refused", "cannot be read as OFF"),
        Case("garbage.off", bytes(range(1, 200)), "refused", "no OFF"),
        Case("garbage.glb", bytes(range(1, 200)), "refused", "no GLB"),
        Case("cut.glb", b"glTF" + struct.pack("<II", 2, 100) + b"\x10\0\0\0JSON{}", "refused", "cut off"),
        Case("huge_chunk.glb", b"glTF" + struct.pack("<III", 2, 22, 0xFFFFFFF0) + b"JSON{}", "refused", "huge_chunk.glb"),
    ]
