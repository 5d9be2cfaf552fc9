"""Bending on flat faces, round walls and across sharp edges: closed forms, each in two meshings of the same surface."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
import shapes

from skinfab.mesh.model import Mesh
from skinfab.mesh.offset import offset_mesh
from skinfab.mesh.topology import Topology
from skinfab.paths import Line, Path
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.pieces import Piece
from skinfab.placement.fold_strain import fold_lengthening
from skinfab.placement.wrap_strain import WornSkin, WrapStrain, worn_skin, wrap_strain

NEUTRAL, CONDUCTOR, THICK = 1.25, 1.6, 2.5
BEYOND = CONDUCTOR - NEUTRAL
QUARTER = np.pi / 2
LARGE = 50_000
Worn = tuple[Mesh, Mesh, Piece]


def finer(body: Mesh, flat: Mesh, piece: Piece, times: int) -> Worn:
    """The same surfaces of triangles a quarter as large."""
    for _ in range(times):
        E, F = _quarters(body.F)
        Ep, Fp = _quarters(piece.F)
        faces = (4 * piece.faces[:, None] + np.arange(4)).ravel()
        UV = np.vstack([piece.UV, piece.UV[Ep].mean(axis=1)])
        vertices = np.empty(len(UV), dtype=np.int64)
        vertices[Fp] = F[faces]
        body, flat = (Mesh(np.vstack([m.V, m.V[E].mean(axis=1)]), F, m.name) for m in (body, flat))
        piece = Piece(piece.id, faces, vertices, Fp, UV)
    return body, flat, piece


def _quarters(F: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    topology = Topology(F)
    ab, bc, ca = (int(F.max()) + 1 + topology.FE.T[k] for k in range(3))
    a, b, c = F.T
    parts = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
    return topology.E, np.stack([np.stack(part, axis=1) for part in parts], axis=1).reshape(-1, 3)


def worn(body: Mesh, flat: Mesh) -> WornSkin:
    return worn_skin(body, flat, flattened_at=NEUTRAL, neutral_at=NEUTRAL, conductor_at=CONDUCTOR, even=THICK)


def part(flat: Mesh, faces: np.ndarray, lay: Callable[[np.ndarray], np.ndarray]) -> Piece:
    """Some faces of a mesh, laid out by `lay`."""
    vertices, F = np.unique(flat.F[faces], return_inverse=True)
    return Piece("P1", np.asarray(faces), vertices, F.reshape(-1, 3), lay(flat.V[vertices]))


def line(*ends: tuple[float, float]) -> Path:
    return Path((Line(*ends),))


@pytest.fixture
def cube(cube_net: Callable) -> Worn:
    """A cube of 40 mm in its skin, flat as a cross of squares of 42.5 mm."""
    flat, piece = cube_net(40 + 2 * NEUTRAL)
    flat = Mesh(flat.V * [1, 1, -1], flat.F, "cube")  # seen from outside
    return Mesh(flat.V * 40 / 42.5, flat.F, "cube"), flat, piece


@pytest.mark.parametrize("times", [0, 1, 3], ids=["12", "48", "768"])
def test_flat_faces_of_a_cube_do_not_bend(cube: Worn, times: int) -> None:
    body, flat, piece = finer(*cube, times)
    spiral = ContactSpiral(n=3, x=1.7, b=1.5, l=3, s=15).path()
    for i, j in ((1, 0), (1, 1), (0, 1), (2, 1), (1, 2), (1, 3)):
        got = wrap_strain(worn(body, flat), piece, spiral.transformed(angle=0.3, shift=(42.5 * i + 14, 42.5 * j + 14)))
        assert [got.bending.mean, got.bending.max, got.membrane.max] == pytest.approx([0, 0, 0], abs=1e-12)
        assert got.resistance_factor == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("times", [0, 1, 3], ids=["12", "48", "768"])
def test_a_path_over_a_cubes_edge_gains_the_angle_times_the_distance(cube: Worn, times: int) -> None:
    """Outside by 0.35 mm a quarter circle is longer by 0.35 pi / 2 mm, whatever its radius."""
    body, flat, piece = finer(*cube, times)
    surfaces = worn(body, flat)

    def gained(path: Path) -> float:
        return wrap_strain(surfaces, piece, path).bending.mean * path.length

    over = line((60.0, 60.1), (60.0, 130.0))  # from the front over the edge at 85 to the top; 127.5 is the next one
    assert gained(over) == pytest.approx(2 * BEYOND * QUARTER, rel=1e-9)
    straight = line((60.0, 70.0), (60.0, 100.0))
    assert gained(straight) == pytest.approx(BEYOND * QUARTER, rel=1e-9) == gained(line((60.0, 100.0), (60.0, 70.0)))
    assert gained(line((60.0, 80.0), (70.0, 90.0))) == pytest.approx(BEYOND * QUARTER * np.sqrt(0.5), rel=1e-9)
    assert gained(line((50.0, 80.0), (80.0, 80.0))) == pytest.approx(0, abs=1e-9)
    # In one place: as much over a skin's thickness of path, and nothing farther off.
    got = wrap_strain(surfaces, piece, straight, step=0.01)
    assert got.bending.max == pytest.approx(BEYOND * QUARTER / THICK, rel=0.005) and got.max == got.bending.max
    assert got.worn_length == pytest.approx(30 + BEYOND * QUARTER, rel=1e-9)


def test_in_a_groove_it_is_squeezed(cube: Worn) -> None:
    _, flat, piece = cube
    inside_out = Mesh(flat.V * [1, 1, -1], flat.F)  # the same triangles, seen from within
    ends = np.array([[[60.0, 84.0], [60.0, 86.0]], [[60.0, 86.0], [60.0, 88.0]]])
    assert fold_lengthening(inside_out, piece, ends, BEYOND).tolist() == pytest.approx([-BEYOND * QUARTER, 0.0])
    assert fold_lengthening(flat, piece, ends, -BEYOND).tolist() == pytest.approx([-BEYOND * QUARTER, 0.0])
    assert not fold_lengthening(flat, piece, ends, 0.0).any()


@pytest.mark.parametrize("y", [84.9, 85.0, 85.1])
def test_a_path_through_the_end_of_a_sample_on_the_edge_crosses_once(cube: Worn, y: float) -> None:
    _, flat, piece = cube
    steps = np.array([82.0, 83.0, 84.0, y, 86.0, 87.0])
    points = np.column_stack([np.full(6, 63.75), steps])  # 63.75 is the middle of the edge: the end of two in a finer mesh
    ends = np.stack([points[:-1], points[1:]], axis=1)
    for _, finer_flat, finer_piece in (cube, finer(flat, flat, piece, 1)):
        assert fold_lengthening(finer_flat, finer_piece, ends, 1.0).sum() == pytest.approx(QUARTER)


@pytest.fixture(scope="module")
def cylinder() -> tuple[Mesh, Mesh]:
    """Radius 25 mm, 96 columns, with its caps; its skin's neutral surface."""
    body = shapes.object_mesh("cylinder")
    return body, offset_mesh(body, NEUTRAL).mesh


@pytest.mark.parametrize("times", [0, 2], ids=["as it is", "finer"])
def test_wall_and_caps_of_a_cylinder(cylinder: tuple[Mesh, Mesh], times: int) -> None:
    body, flat = cylinder
    radius = np.hypot(*flat.V[:, :2].T).max()
    centre, normal = flat.V[flat.F].mean(axis=1), flat.face_normals
    in_front = np.abs(np.arctan2(centre[:, 1], centre[:, 0])) < 2
    # A prism of 96 sides: what is flat is its chords.
    column = 2 * radius * np.sin(np.pi / 96)
    chord = column / (2 * np.pi / 96)
    wall = part(
        flat,
        np.flatnonzero((np.abs(normal[:, 2]) < 0.1) & in_front),
        lambda V: np.column_stack([chord * np.arctan2(V[:, 1], V[:, 0]), V[:, 2]]),
    )
    bent = finer(body, flat, wall, times)
    surfaces = worn(bent[0], bent[1])
    low, high = flat.V[:, 2].min(), flat.V[:, 2].max()
    middle = (low + high) / 2
    for z in (low + 0.3, middle, high - 0.3):  # at the rims as far from them
        around = wrap_strain(surfaces, bent[2], line((-16.5 * column, z), (16.5 * column, z)), step=0.02)
        assert around.bending.mean == pytest.approx(BEYOND / radius, rel=0.01)
        # The finer the mesh, the more of a prism it is, whose columns are not much narrower than the skin is thick.
        assert around.bending.max == pytest.approx(BEYOND / radius, rel=0.1 if times else 0.01)
    along = wrap_strain(surfaces, bent[2], line((3.0, low + 0.3), (3.0, high - 0.3)))
    assert [along.bending.mean, along.bending.max] == pytest.approx([0, 0], abs=1e-9)
    end = 16.5 * column
    askew = wrap_strain(surfaces, bent[2], line((-end, middle - end), (end, middle + end)), step=0.02)
    assert askew.bending.mean == pytest.approx(0.5 * BEYOND / radius, rel=0.01)
    cap = finer(body, flat, part(flat, np.flatnonzero(normal[:, 2] > 0.9), lambda V: V[:, :2]), times)
    across = wrap_strain(worn(cap[0], cap[1]), cap[2], line((-25.9, 1.0), (25.9, 2.0)))
    assert [across.bending.mean, across.bending.max] == pytest.approx([0, 0], abs=1e-9)


@pytest.mark.parametrize("times", [0, 1], ids=["as it is", "finer"])
def test_a_sphere_bends_alike_everywhere(times: int) -> None:
    V, F = shapes.sphere(4)
    body = Mesh(20 * V, F, "sphere")
    flat = offset_mesh(body, NEUTRAL).mesh

    def lay(V: np.ndarray) -> np.ndarray:
        from_pole = np.arctan2(np.linalg.norm(V[:, :2], axis=1), V[:, 2])
        angle = np.arctan2(V[:, 1], V[:, 0])
        return (20 + NEUTRAL) * from_pole[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])

    body, flat, piece = finer(body, flat, part(flat, np.flatnonzero(flat.V[flat.F].mean(axis=1)[:, 2] > 8), lay), times)
    for angle in (0.1, 0.9, 2.0):  # meridians, which are laid out in their true length
        end = 20 * np.cos(angle), 20 * np.sin(angle)
        got = wrap_strain(worn(body, flat), piece, line((-end[0], -end[1]), end))
        assert got.bending.mean == pytest.approx(BEYOND / (20 + NEUTRAL), rel=0.01)
        assert got.bending.max == pytest.approx(BEYOND / (20 + NEUTRAL), rel=0.2)  # evened over 2.5 mm of triangles of 1.4 mm


@pytest.mark.parametrize("name", ["cube", "dodecahedron", "cylinder", "cup", "grip", "human_finger", "robot_finger"])
def test_two_meshings_of_an_object_bend_alike(name: str) -> None:
    """Patches seen from above, with a path over each: the mean is that of the surface, whatever its triangles."""
    body = shapes.object_mesh(name)
    flat = offset_mesh(body, NEUTRAL, round_off=True).mesh
    rng = np.random.default_rng(1)
    topology, measured = flat.topology, 0
    edges = 6 if len(body.F) < LARGE else 2  # of its 85 thousand triangles each is as flat as the next
    for edge in rng.permutation(np.flatnonzero(topology.edge_count == 2))[:edges]:
        a, b = flat.V[topology.E[edge]]
        up = flat.face_normals[topology.EF[edge]].sum(axis=0)
        up /= np.linalg.norm(up)
        right = np.cross(up, [0.48, 0.6, 0.64])
        frame = np.stack([right / np.linalg.norm(right), np.cross(up, right / np.linalg.norm(right))])
        near = np.linalg.norm(flat.V[flat.F].mean(axis=1) - (a + b) / 2, axis=1) < max(12.0, np.linalg.norm(b - a))
        _, label = topology.face_components(~(near & (flat.face_normals @ up > 0.4))[topology.EF].all(axis=1))
        faces = np.flatnonzero(label == label[topology.EF[edge, 0]])
        piece = part(flat, faces, lambda V, frame=frame: V @ frame.T)
        here = (a + b) / 2 @ frame.T
        aside = np.array([4.0, 1.6])
        path = line(tuple(here - aside), tuple(here + aside))
        got: list[WrapStrain] = []
        for times in (0, 1):
            body_too, flat_too, piece_too = finer(body, flat, piece, times)
            got.append(wrap_strain(worn(body_too, flat_too), piece_too, path))
        assert got[1].membrane.mean == pytest.approx(got[0].membrane.mean, abs=1e-9)
        # The path ends amid triangles: which part of an edge's turn it has by then is the meshing's, 10 degrees at most.
        assert got[1].bending.mean * path.length == pytest.approx(got[0].bending.mean * path.length, abs=BEYOND * np.radians(10))
        assert got[1].bending.max == pytest.approx(got[0].bending.max, abs=0.01)
        measured += 1
    assert measured == edges
