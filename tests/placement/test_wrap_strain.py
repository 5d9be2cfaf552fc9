"""Wrap strain against closed forms."""

from collections.abc import Callable

import numpy as np
import pytest
import shapes

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.mesh.offset import offset_mesh
from skinfab.paths import Arc, Line, Path
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.pieces import Piece
from skinfab.placement.wrap_strain import WornSkin, running_mean, strain_along, summary, worn_skin, wrap_strain

SPIRAL = ContactSpiral(n=3, x=1.7, b=1.5, l=3, s=15).path().transformed(angle=0.3, shift=(12, 15))


@pytest.mark.parametrize(("scale", "strain"), [(1.0, 0.0), (1 / 1.1, 0.1), (1.25, -0.2)])
def test_a_uniform_scale(sheet: Callable, scale: float, strain: float) -> None:
    got = wrap_strain(*sheet(60, 60, scale=scale), SPIRAL)
    assert got.mean == pytest.approx(strain, abs=1e-12) and got.max == pytest.approx(strain, abs=1e-12)


def test_one_direction_only(sheet: Callable) -> None:
    mesh, piece = sheet(60, 60)
    wide = Mesh(mesh.V * [1.2, 1, 1], mesh.F)
    assert wrap_strain(wide, piece, Path((Line((5, 5), (50, 5)),))).mean == pytest.approx(0.2)
    assert wrap_strain(wide, piece, Path((Line((5, 5), (5, 50)),))).mean == pytest.approx(0, abs=1e-12)
    # A circle becomes an ellipse: its length in closed form.
    from scipy.special import ellipe

    ring = wrap_strain(wide, piece, Path((Arc((30, 30), 10.0, 0.0, 2 * np.pi),)), step=0.1)
    assert ring.mean == pytest.approx(4 * 12 * ellipe(1 - (10 / 12) ** 2) / (2 * np.pi * 10) - 1, abs=1e-6)
    assert ring.max == pytest.approx(0.2, abs=1e-4)


def test_the_mean_weighs_length_and_the_max_keeps_its_sign(sheet: Callable) -> None:
    mesh, piece = sheet(40, 20, step=5)
    V = mesh.V.copy()
    right = V[:, 0] > 20
    V[right, 0] = 20 + 0.7 * (V[right, 0] - 20)  # 30 % shorter on the right half only
    got = wrap_strain(Mesh(V, mesh.F), piece, Path((Line((10, 7), (25, 7)),)))
    assert got.mean == pytest.approx(-0.3 * 5 / 15) and got.max == pytest.approx(-0.3)


def test_bending_without_stretch_is_none(sheet: Callable) -> None:
    mesh, piece = sheet(60, 60, step=0.5)
    x, y, _ = mesh.V.T
    bent = Mesh(np.column_stack([10 * np.sin(x / 10), y, 10 * np.cos(x / 10)]), mesh.F)
    got = wrap_strain(bent, piece, SPIRAL)
    assert abs(got.mean) < 2e-4 and abs(got.max) < 2e-4  # chords of 0.5 mm on a radius of 10: 1e-4


def test_a_path_off_the_piece(sheet: Callable) -> None:
    mesh, piece = sheet(60, 60)
    with pytest.raises(InputError, match=r"leaves piece P1 near \(60\.\d, 5\.0\)"):
        wrap_strain(mesh, piece, Path((Line((50, 5), (70, 5)),)))
    assert isinstance(piece, Piece)


# A skin 2.5 mm thick: its neutral surface 1.25 mm outside the object, the conductors 1.6 mm, 0.35 mm farther out.
NEUTRAL, CONDUCTOR = 1.25, 1.6
BEYOND = CONDUCTOR - NEUTRAL


def skin_on(V: np.ndarray, F: np.ndarray, unroll: Callable[[np.ndarray], np.ndarray], *, thick: bool, inside: bool = False) -> tuple:
    """A worn skin and its piece: `unroll` takes the surface that is flattened to the plane."""
    body = Mesh(V, F[:, ::-1] if inside else F)
    flat = offset_mesh(body, NEUTRAL).mesh if thick else body
    piece = Piece("P1", np.arange(len(F)), np.arange(len(V)), body.F, unroll(flat.V))
    worn = worn_skin(body, flat, flattened_at=NEUTRAL if thick else 0.0, neutral_at=NEUTRAL, conductor_at=CONDUCTOR)
    return worn, piece


def rolled_out(columns: int, rows: int) -> Callable[[np.ndarray], np.ndarray]:
    """A tube of so many columns and rows, chord by chord; the columns at its open ends, which have one neighbour, are made alike."""

    def unroll(V: np.ndarray) -> np.ndarray:
        grid = V.reshape(rows + 1, columns + 1, 3)
        chord = np.linalg.norm(grid[0, 2] - grid[0, 1])
        i, j = np.meshgrid(np.arange(columns + 1), np.arange(rows + 1))
        return np.column_stack([chord * i.ravel(), grid[0, 1, 2] + (grid[-1, 1, 2] - grid[0, 1, 2]) * j.ravel() / rows])

    return unroll


@pytest.mark.parametrize(("thick", "flattened"), [(True, 8 + NEUTRAL), (False, 8.0)], ids=["thickness on", "thickness off"])
def test_a_skin_round_a_cylinder(thick: bool, flattened: float) -> None:
    """Radius 8 mm. On: no membrane strain at all. Off: what the skin lacks in girth, 1.25 / 8 = 15.6 %."""
    worn, piece = skin_on(*shapes.cylinder_sheet(240, 10, 8.0, 60.0), rolled_out(240, 10), thick=thick)
    membrane, bending = (8 + NEUTRAL) / flattened - 1, BEYOND / flattened
    around = wrap_strain(worn, piece, Path((Line((5, 20), (45, 20)),)))
    # A polygon of 240 sides, not a circle: 1e-4 of the radius.
    assert around.membrane.mean == pytest.approx(membrane, abs=1e-4) and around.membrane.max == pytest.approx(membrane, abs=1e-4)
    assert around.bending.mean == pytest.approx(bending, rel=1e-3) and around.bending.max == pytest.approx(bending, rel=1e-3)
    assert around.mean == pytest.approx(around.membrane.mean + around.bending.mean, abs=1e-12)
    assert around.worn_length == pytest.approx(40 * (8 + CONDUCTOR) / flattened, rel=1e-4)
    assert around.resistance_factor == pytest.approx(((8 + CONDUCTOR) / flattened) ** 2, rel=3e-4)
    along = wrap_strain(worn, piece, Path((Line((20, 5), (20, 55)),)))
    assert [along.mean, along.max, along.bending.max] == pytest.approx([0, 0, 0], abs=1e-9) and along.resistance_factor == pytest.approx(1)
    # Askew: the metric of the conductor's own cylinder.
    askew = wrap_strain(worn, piece, Path((Line((5, 10), (35, 50)),)))
    assert askew.mean == pytest.approx(np.hypot(0.6 * (8 + CONDUCTOR) / flattened, 0.8) - 1, abs=1e-4)
    # To first order in the distances, normal curvature sin^2 / r times the distance.
    if thick:
        assert askew.bending.mean == pytest.approx(0.36 * BEYOND / flattened, rel=0.02)


def test_inside_a_tube_bending_squeezes() -> None:
    worn, piece = skin_on(*shapes.cylinder_sheet(240, 10, 8.0, 60.0), rolled_out(240, 10), thick=True, inside=True)
    around = wrap_strain(worn, piece, Path((Line((5, 20), (35, 20)),)))
    assert around.membrane.mean == pytest.approx(0, abs=1e-4) and around.bending.mean == pytest.approx(-BEYOND / (8 - NEUTRAL), rel=1e-3)


@pytest.mark.parametrize("thick", [True, False], ids=["thickness on", "thickness off"])
def test_a_skin_round_a_cone(thick: bool) -> None:
    """A frustum from radius 20 to 10 over 30 mm: parallel surfaces are cones of the same opening."""
    columns, rows, half = 240, 20, np.arctan2(10, 30)

    def unroll(V: np.ndarray) -> np.ndarray:
        r = np.linalg.norm(V[:, :2], axis=1).reshape(rows + 1, columns + 1)[:, 1]
        from_tip, angle = r / np.sin(half), 2 * np.pi * np.arange(columns + 1) / columns * np.sin(half)
        return (from_tip[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)).reshape(-1, 2)

    worn, piece = skin_on(*shapes.cone_sheet(columns, rows, 20.0, 10.0, 30.0), unroll, thick=thick)
    for from_tip in (38.0, 55.0):
        out = np.cos(half)  # of a mm along the normal, so much is away from the axis
        radius = from_tip * np.sin(half)  # of the surface that was flattened
        lacks = 0.0 if thick else NEUTRAL * out
        around = wrap_strain(worn, piece, Path((Arc((0, 0), from_tip, 0.2, 1.4),)))
        assert around.membrane.mean == pytest.approx(lacks / radius, abs=3e-4)
        assert around.bending.mean == pytest.approx(BEYOND * out / radius, rel=0.01)
        assert around.worn_length == pytest.approx(1.4 * from_tip * (radius + lacks + BEYOND * out) / radius, rel=1e-3)
    direction = np.array([np.cos(0.9), np.sin(0.9)])
    along = wrap_strain(worn, piece, Path((Line(tuple(36 * direction), tuple(58 * direction)),)))
    assert [along.membrane.mean, along.bending.mean] == pytest.approx([0, 0], abs=1e-4)


@pytest.mark.parametrize("thick", [True, False], ids=["thickness on", "thickness off"])
def test_a_skin_on_a_sphere_cap(thick: bool) -> None:
    """Radius 20 mm, laid out true to distance from the pole: circles about it are too long by theta / sin theta."""
    radius, opening = 20.0, 1.0

    def unroll(V: np.ndarray) -> np.ndarray:
        r = np.linalg.norm(V, axis=1).mean()
        theta = np.arctan2(np.linalg.norm(V[:, :2], axis=1), V[:, 2])
        angle = np.arctan2(V[:, 1], V[:, 0])
        return (r * theta)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])

    worn, piece = skin_on(*shapes.cap(60, opening, radius), unroll, thick=thick)
    flattened = radius + NEUTRAL if thick else radius
    grown, grown_more = (radius + NEUTRAL) / flattened, (radius + CONDUCTOR) / flattened
    for theta in (0.3, 0.8):
        around = wrap_strain(worn, piece, Path((Arc((0, 0), flattened * theta, 0.0, 2 * np.pi),)))
        assert around.membrane.mean == pytest.approx(grown * np.sin(theta) / theta - 1, abs=1e-3)
        assert around.bending.mean == pytest.approx((grown_more - grown) * np.sin(theta) / theta, rel=0.01)
    along = wrap_strain(worn, piece, Path((Line((1.0, 0.5), (18.0, 3.0)),)))
    assert along.bending.mean == pytest.approx(BEYOND / flattened, rel=0.01)  # the same in every direction along a meridian
    assert along.membrane.mean == pytest.approx(grown - 1, abs=3e-3)


def test_surfaces_of_a_worn_skin_are_those_that_were_flattened() -> None:
    V, F = shapes.sphere(2)
    body = Mesh(8 * V, F)
    flat = offset_mesh(body, 1.25).mesh
    worn = worn_skin(body, flat, flattened_at=1.25, neutral_at=1.25, conductor_at=1.25)
    assert worn.neutral is flat and worn.conductor is flat
    bare = worn_skin(body, body, flattened_at=0.0, neutral_at=0.0, conductor_at=0.0)
    assert bare.neutral is body and bare.conductor is body
    # Flattened for another thickness: the neutral surface lies where the skin has it, on the same lines outward.
    worn = worn_skin(body, flat, flattened_at=1.25, neutral_at=2.5, conductor_at=0.0)
    assert worn.neutral.V == pytest.approx(body.V + 2 * (flat.V - body.V))
    assert worn.beyond == -2.5
    assert np.linalg.norm(worn.conductor.V, axis=1) == pytest.approx(8.0, rel=2e-3)  # a sphere of 320 triangles


def test_a_bump_shorter_than_the_skin_is_thick_is_bridged(sheet: Callable) -> None:
    mesh, piece = sheet(40, 20, step=1)
    V = mesh.V.copy()
    V[(V[:, 0] > 19) & (V[:, 0] < 21), 2] = 1.0  # a ridge: two cells of 1 mm are the root of 2 long
    line = Path((Line((5, 7.3), (35, 7.3)),))
    sharp = wrap_strain(Mesh(V, mesh.F), piece, line, step=0.1)
    even = wrap_strain(WornSkin(Mesh(V, mesh.F), Mesh(V, mesh.F), even=2.5), piece, line, step=0.1)
    assert sharp.max == pytest.approx(np.sqrt(2) - 1) and even.max == pytest.approx(2 * (np.sqrt(2) - 1) / 2.5, rel=1e-6)
    assert even.mean == sharp.mean and even.worn_length == sharp.worn_length
    assert 1 < even.resistance_factor < sharp.resistance_factor


def test_a_running_mean_keeps_what_is_constant() -> None:
    rng = np.random.default_rng(0)
    lengths = rng.random(50) + 0.1
    assert running_mean(np.full(50, 0.3), lengths, 2.5) == pytest.approx(0.3)
    values = rng.standard_normal(50)
    assert running_mean(values, lengths, 0.0) is values
    assert running_mean(values, np.full(50, 0.25), 3.0).mean() == pytest.approx(values.mean())
    assert running_mean(values, lengths, 1e6) == pytest.approx(values @ lengths / lengths.sum())


def test_parts_point_by_point_make_the_summary(sheet: Callable) -> None:
    mesh, piece = sheet(60, 60)
    along = strain_along(mesh, piece, SPIRAL)
    assert along.lengths.sum() == pytest.approx(SPIRAL.length) and not along.bending.any()
    assert summary(along) == wrap_strain(mesh, piece, SPIRAL)
