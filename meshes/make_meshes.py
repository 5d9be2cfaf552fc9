"""Make the seven objects of the source study, at its scale: ``python meshes/make_meshes.py``.

Sizes follow the patterns the study put on them (contact spirals s = 15 mm on the cube, 22 mm on the
dodecahedron, 20 and 45 mm on cylinder and cup, 32 and 38 mm on the grip; fingers about 90 mm long).
Every mesh is wound counter-clockwise from outside, welded, and the same at every run. The fingers
are open at the base, where they join the hand; the other five are closed.
"""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable
from pathlib import Path

import igl
import manifold3d
import numpy as np
import pymeshlab
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from skinfab.files import atomic_write
from skinfab.mesh.model import Mesh

Points = NDArray[np.float64]

CUBE_EDGE_MM = 40.0
DODECAHEDRON_EDGE_MM = 38.0
CYLINDER_RADIUS_MM, CYLINDER_HEIGHT_MM = 25.0, 100.0
GRIP_FACES = 84_982  # the study's count


def cube() -> Mesh:
    """Twelve triangles."""
    V = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]) * CUBE_EDGE_MM
    quads = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
    return Mesh(V, np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]), "cube")


def dodecahedron() -> Mesh:
    """Twelve pentagons, each a fan of three triangles."""
    golden = (1 + 5**0.5) / 2
    corners = [[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)]
    for a in (-1 / golden, 1 / golden):
        for b in (-golden, golden):
            corners += [[0, a, b], [a, b, 0], [b, 0, a]]
    V = np.array(corners, dtype=float)
    normals = np.unique(ConvexHull(V).equations[:, :3].round(9), axis=0)
    F = []
    for normal in normals:
        on = np.flatnonzero(V @ normal > (V @ normal).max() - 1e-6)
        across = V[on[0]] - V[on].mean(axis=0)
        turn = np.arctan2(V[on] @ np.cross(normal, across), V[on] @ across)
        ring = on[np.argsort(turn)]
        F += [[ring[0], ring[k], ring[k + 1]] for k in (1, 2, 3)]
    return Mesh(V * DODECAHEDRON_EDGE_MM * golden / 2, np.array(F), "dodecahedron")


def cylinder(sections: int = 96, rows: int = 24) -> Mesh:
    """A closed cylinder, h = 4 r, of well-shaped triangles; its side is a prism, so exactly developable."""
    heights = np.linspace(0, CYLINDER_HEIGHT_MM, rows + 1)
    side = [_circle(CYLINDER_RADIUS_MM, sections, z) for z in heights]
    top = [_circle(CYLINDER_RADIUS_MM * r, n, CYLINDER_HEIGHT_MM) for r, n in ((0.9, 96), (0.76, 48), (0.55, 48), (0.36, 24), (0.17, 12))]
    bottom = [ring * [1, 1, 0] for ring in top]
    base, cap = np.zeros((1, 3)), np.array([[0, 0, CYLINDER_HEIGHT_MM]])
    return _stack([base, *bottom[::-1], *side, *top, cap], "cylinder")


def cup() -> Mesh:
    """A conical drinking cup with a handle: outer and inner surface joined over the rim, genus 1."""
    height, wall, floor = 85.0, 4.0, 5.0
    low, high = 28.0, 36.0  # outer radius at foot and rim
    slope = (high - low) / height
    # Crisp rim, chamfered foot and floor: creases survive remeshing, fillets of this size would not.
    body = manifold3d.CrossSection([[[0, 0], [low - 3, 0], [low + 3 * slope, 3], [high, height], [0, height]]]).revolve(128)
    inner = [[low + slope * (floor + 4) - wall, floor + 4], [low - wall - 3, floor], [0, floor]]
    hollow = [[0, height + 1], *inner[::-1], [high - wall, height], [high - wall, height + 1]]
    drinkable = manifold3d.CrossSection([hollow]).revolve(128)
    t = np.linspace(0, 1, 41)[:, None]
    ends = np.array([[33.0, 0, 68], [72, 0, 76], [70, 0, 22], [29.5, 0, 21]])
    spine = (1 - t) ** 3 * ends[0] + 3 * t * (1 - t) ** 2 * ends[1] + 3 * t**2 * (1 - t) * ends[2] + t**3 * ends[3]
    handle = _to_manifold(_tube(spine, wide=6.0, thick=4.2))
    solid = (body + handle) - drinkable
    return _largest_outward(_remesh(_from_manifold(solid), 2.4, feature_deg=30.0), "cup")


def grip(faces: int = GRIP_FACES) -> Mesh:
    """An irregular hand-dynamometer-like grip after the Jamar: two bowed bars joined by a gauge bulge."""
    low, high, step = np.array([-46.0, -66, -24]), np.array([46.0, 90, 24]), 1.0
    shape = ((high - low) / step).astype(int) + 1
    axes = [np.linspace(low[k], low[k] + step * (shape[k] - 1), shape[k]) for k in range(3)]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    V, F = igl.marching_cubes(_grip_distance(points), points, *(int(n) for n in shape), 0.0)[:2]
    fine = _remesh(Mesh(V, F), 0.76 * (GRIP_FACES / faces) ** 0.5, feature_deg=180.0)
    reduced = _decimate(fine, faces)
    return _largest_outward(Mesh(_project(reduced.V, _grip_distance), reduced.F), "grip")


def human_finger() -> Mesh:
    """A right index finger, slightly bent, with joints, pad and nail; open at the base."""
    rows = np.concatenate([np.linspace(0, 80, 161), 80 + 10 * np.sin(np.linspace(0, np.pi / 2, 61)[1:-1])])
    angle = np.linspace(0, 2 * np.pi, 180, endpoint=False)
    rings = [_finger_section(z, angle) for z in rows]
    tip = _finger_section(90.0, angle[:1])
    dense = _stack([*rings, tip], "human_finger")
    even = _remesh(dense, 0.93, feature_deg=180.0)
    V = even.V.copy()
    rim = np.unique(even.topology.E[even.topology.is_boundary])
    V[rim, 2] = 0.0
    return _largest_outward(Mesh(V, even.F), "human_finger")


def robot_finger(sections: int = 72) -> Mesh:
    """A machined robot index finger: three flat-backed phalanges, short cones between, a chamfered flat tip.

    Every part is a prism, a cone or a plane, so that it bends flat without stretch once it is cut;
    open at the base.
    """
    stations = [(0, 1.0), (36, 1.0), (43, 0.94), (60, 0.94), (67, 0.88), (86.5, 0.88), (90, 0.70)]
    outline = _flat_backed_section(sections)
    rings = []
    for (z0, s0), (z1, s1) in itertools.pairwise(stations):
        count = max(round((z1 - z0) / 1.25), 2)
        for t in np.arange(count) / count:
            rings.append(_ring(outline * (s0 + t * (s1 - s0)), z0 + t * (z1 - z0)))
    rings += [_ring(outline[:: 72 // n] * s, 90.0) for s, n in ((0.70, 72), (0.60, 72), (0.48, 36), (0.33, 36), (0.18, 18), (0.08, 9))]
    return _stack([*rings, np.array([[0.0, 0.0, 90.0]])], "robot_finger")


# -- sections and fields -------------------------------------------------------------------------


def _circle(radius: float, count: int, z: float) -> Points:
    angle = 2 * np.pi * np.arange(count) / count
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, z)])


def _ring(outline: Points, z: float) -> Points:
    return np.column_stack([outline, np.full(len(outline), z)])


def _flat_backed_section(count: int) -> Points:
    """A half circle in front, straight flanks, a flat back with rounded corners; evenly spaced points."""
    half, depth, corner = 8.5, 6.0, 2.5
    front = np.linspace(-np.pi, 0, 181)
    right = np.linspace(0, np.pi / 2, 46)
    arcs = [
        half * np.column_stack([np.cos(front), np.sin(front)]),
        [half - corner, depth - corner] + corner * np.column_stack([np.cos(right), np.sin(right)]),
        [-half + corner, depth - corner] + corner * np.column_stack([-np.sin(right), np.cos(right)]),
    ]
    path = np.vstack([*arcs, arcs[0][:1]])
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    at = np.linspace(0, along[-1], count, endpoint=False)
    return np.column_stack([np.interp(at, along, path[:, 0]), np.interp(at, along, path[:, 1])])


def _bump(x: Points, centre: float, width: float) -> Points:
    return np.exp(-(((x - centre) / width) ** 2))


def _finger_section(z: float, angle: Points) -> Points:
    """The skin at height `z` before bending: back of the hand at +y, pad at -y."""
    height = np.full(len(angle), z)
    closing = np.sqrt(max(1 - (max(z - 78.0, 0.0) / 12.0) ** 2.3, 0.0))
    half_width = 9.3 - 0.018 * z + 0.75 * _bump(height, 43, 7) + 0.45 * _bump(height, 67, 5) - 0.25 * _bump(height, 55, 7)
    back = 8.8 - 0.026 * z + 0.8 * _bump(height, 43, 6) + 0.35 * _bump(height, 67, 4)
    pad = 8.8 - 0.014 * z + 0.9 * _bump(height, 78, 9) + 0.5 * _bump(height, 55, 8) + 0.6 * _bump(height, 22, 12)
    pad = pad - 0.55 * (_bump(height, 43, 1.6) + _bump(height, 67, 1.4))
    x = half_width * np.cos(angle) * closing
    y = np.where(np.sin(angle) > 0, back, pad) * np.sin(angle) * closing
    # The nail: a flatter plate, set off by a shallow groove all round.
    inside = 1 - ((x / 5.2) ** 4 + ((z - 81.0) / 7.5) ** 4)
    plate = np.clip(inside / 0.5, -1, 1) * (y > 0)
    y = y + np.where(plate > 0, 0.45 * plate, 0) - np.where((inside > -0.9) & (y > 0), 0.35 * np.exp(-((inside + 0.1) ** 2) / 0.04), 0)
    y = y - 4.5 * (z / 90.0) ** 2
    return np.column_stack([x, y, height])


def _bar(p: Points, spine: Points, radii: Points) -> Points:
    """Distance to a chain of round cones."""
    best = np.full(len(p), np.inf)
    for a, b, ra, rb in zip(spine, spine[1:], radii, radii[1:], strict=False):
        t = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        best = np.minimum(best, np.linalg.norm(p - a - t[:, None] * (b - a), axis=1) - (ra + t * (rb - ra)))
    return best


def _blend(a: Points, b: Points, width: float) -> Points:
    """Smooth minimum, polynomial of second degree."""
    h = np.clip(0.5 + 0.5 * (b - a) / width, 0, 1)
    return b + h * (a - b) - width * h * (1 - h)


def _grip_distance(p: Points) -> Points:
    """Signed distance to the grip, mm, negative inside (exact only near the surface)."""
    along = np.linspace(-46, 42, 23)
    zero = np.zeros_like(along)
    fixed = np.column_stack([-24 - 4 * np.cos(along / 46 * np.pi / 2), along, zero])
    moving = np.column_stack([21 + 5 * np.cos(along / 46 * np.pi / 2), along, zero])
    palm = _bar(p, fixed, 14.0 + 1.5 * _bump(along, -2, 20))
    fingers = _bar(p, moving, 11.0 + 0.7 * np.cos(along * 2 * np.pi / 22))
    bars = _blend(palm, fingers, 6.0)
    bridge = np.linalg.norm(np.maximum(np.abs(p - [0, 44, 0]) - [22, 6, 6], 0), axis=1) - 5.0
    from_axis = np.hypot(p[:, 0], p[:, 1] - 58) - 21.0
    from_middle = np.abs(p[:, 2] - 2) - 9.0
    gauge = np.hypot(np.maximum(from_axis, 0), np.maximum(from_middle, 0)) + np.minimum(np.maximum(from_axis, from_middle), 0) - 7.0
    return _blend(_blend(bars, bridge, 9.0), gauge, 9.0)


# -- surfaces ------------------------------------------------------------------------------------


def _stack(rings: list[Points], name: str) -> Mesh:
    """Closed rings joined one above the other, counter-clockwise seen from +z at the sides; one point closes an end."""
    V = np.vstack(rings)
    first = np.concatenate([[0], np.cumsum([len(r) for r in rings])])
    F = []
    for k in range(len(rings) - 1):
        n, m = len(rings[k]), len(rings[k + 1])
        i = j = 0
        # Advance on the ring whose next point comes first; a ring of one point never advances.
        while i < (n if n > 1 else 0) or j < (m if m > 1 else 0):
            a, b = first[k] + i % n, first[k + 1] + j % m
            if m == 1 or (n > 1 and (i + 0.5) / n <= (j + 0.5) / m):
                F.append([a, first[k] + (i + 1) % n, b])
                i += 1
            else:
                F.append([a, first[k + 1] + (j + 1) % m, b])
                j += 1
    return Mesh(V, np.array(F), name)


def _tube(spine: Points, *, wide: float, thick: float, count: int = 32) -> Mesh:
    """An elliptic tube along a curve in the plane y = 0, closed at both ends."""
    along = np.gradient(spine, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.cross(along, [0.0, 1.0, 0.0])
    angle = 2 * np.pi * np.arange(count) / count
    rings = [c + np.outer(thick * np.cos(angle), n) + np.outer(wide * np.sin(angle), [0, 1, 0]) for c, n in zip(spine, across, strict=True)]
    tube = _stack([spine[:1], *rings, spine[-1:]], "tube")
    return _largest_outward(tube, "tube")


def _to_manifold(mesh: Mesh) -> manifold3d.Manifold:
    solid = manifold3d.Manifold(manifold3d.Mesh(mesh.V.astype(np.float32), mesh.F.astype(np.uint32)))
    if solid.is_empty():
        raise RuntimeError(f"{mesh.name} is no solid: {solid.status()}")
    return solid


def _from_manifold(solid: manifold3d.Manifold) -> Mesh:
    out = solid.to_mesh()
    return Mesh(out.vert_properties[:, :3], out.tri_verts)


def _remesh(mesh: Mesh, edge_mm: float, *, feature_deg: float) -> Mesh:
    """Isotropic remeshing that keeps creases sharper than `feature_deg`."""
    held = pymeshlab.MeshSet()
    held.add_mesh(pymeshlab.Mesh(mesh.V, mesh.F.astype(np.int32)))
    held.meshing_isotropic_explicit_remeshing(
        iterations=12, targetlen=pymeshlab.PureValue(edge_mm), featuredeg=feature_deg, checksurfdist=False
    )
    done = held.current_mesh()
    return Mesh(done.vertex_matrix(), done.face_matrix(), mesh.name)


def _decimate(mesh: Mesh, faces: int) -> Mesh:
    held = pymeshlab.MeshSet()
    held.add_mesh(pymeshlab.Mesh(mesh.V, mesh.F.astype(np.int32)))
    # The planar term keeps the triangles of flat parts even; without it they collapse into needles.
    held.meshing_decimation_quadric_edge_collapse(
        targetfacenum=faces, preservetopology=True, preservenormal=True, qualitythr=0.6, planarquadric=True, planarweight=1.0
    )
    done = held.current_mesh()
    return Mesh(done.vertex_matrix(), done.face_matrix(), mesh.name)


def _project(V: Points, distance: Callable[[Points], Points], steps: int = 3, h: float = 1e-3) -> Points:
    """Newton steps onto the zero set of `distance`."""
    for _ in range(steps):
        slope = np.column_stack([(distance(V + d) - distance(V - d)) / (2 * h) for d in np.eye(3) * h])
        V = V - distance(V)[:, None] * slope / (slope**2).sum(axis=1, keepdims=True)
    return V


def _largest_outward(mesh: Mesh, name: str) -> Mesh:
    """The largest component, unreferenced vertices dropped, wound so that its volume is positive."""
    _, label = mesh.topology.face_components()
    F = mesh.F[label == np.bincount(label).argmax()]
    used, F = np.unique(F, return_inverse=True)
    V, F = mesh.V[used], F.reshape(-1, 3)
    centred = V - V.mean(axis=0)
    volume = np.einsum("ij,ij->", centred[F[:, 0]], np.cross(centred[F[:, 1]], centred[F[:, 2]])) / 6
    return Mesh(V, F if volume > 0 else F[:, ::-1], name)


OBJECTS: dict[str, Callable[[], Mesh]] = {
    maker.__name__: maker for maker in (cube, dodecahedron, cylinder, cup, grip, human_finger, robot_finger)
}


def to_obj(mesh: Mesh) -> str:
    """Wavefront text, mm, at most nine significant digits."""
    lines = [f"# {mesh.name}, mm, {len(mesh.V)} vertices, {len(mesh.F)} faces; made by make_meshes.py"]
    lines += ["v {:.9g} {:.9g} {:.9g}".format(*v) for v in (mesh.V.round(9) + 0.0).tolist()]
    lines += ["f {} {} {}".format(*f) for f in (mesh.F + 1).tolist()]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write every object beside this script and say what it is."""
    for name, make in OBJECTS.items():
        mesh = make()
        atomic_write(Path(__file__).with_name(f"{name}.obj"), to_obj(mesh))
        open_edges = int(mesh.topology.is_boundary.sum())
        loops = len(mesh.topology.boundary_loops)
        genus = (2 - loops - mesh.topology.euler) / 2
        size = " x ".join(f"{s:.1f}" for s in mesh.bbox[1] - mesh.bbox[0])
        sys.stdout.write(f"{name:13s} {len(mesh.F):6d} faces, {size} mm, genus {genus:g}, {open_edges} open edges, {mesh.area:.0f} mm2\n")


if __name__ == "__main__":
    main()
