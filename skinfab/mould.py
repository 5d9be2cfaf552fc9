"""Casting moulds: a flat piece becomes a printable tray that silicone is poured into."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.drawings.seam_sides import seam_sides
from skinfab.errors import InputError, RefusedError
from skinfab.files import atomic_write
from skinfab.material import Material
from skinfab.mesh.topology import Topology
from skinfab.mould_plan import MouldPlan, mould_plan
from skinfab.mould_taper import tapered
from skinfab.pieces import Piece
from skinfab.skin import Skin
from skinfab.tolerances import CAVITY_FRACTION, MOULD_GRID_MM, MOULD_SLIT_MM
from skinfab.wire_exits import WirePad, WireSlot, wire_pads

#: How far the wall stands above the silicone, mm: the pour does not run over before it levels, and
#: a 0.25 mm wire lies in a slot of this depth without the slot reaching the silicone.
FREEBOARD_MM = 0.5


@dataclass(frozen=True, eq=False)
class CastingMould:
    """A mould ready to be printed, in the piece frame; z = 0 is the underside.

    Parameters
    ----------
    piece : str
        Id of the piece.
    V : (n, 3) float32, mm
        As an STL holds it: checked after rounding to single precision.
    F : (m, 3) int64
    floor_z, fill_z, top_z : float, mm
        Heights of the cavity's floor, of the silicone's surface and of the wall's top.
    area_mm2, depth : float
        Of the piece, and of the silicone (mm).
    cavity_ml : float
        Volume up to `fill_z`, measured on `V` and `F`, without the lip.
    lip_ml : float
        Volume of the adhesive lips, measured in the same way; only the top layer flows into them.
    marks : (3, 2) float, mm
        The L marks' corner points: lower left, lower right, upper left. The lower left one is what
        the nozzle is jogged to.
    wire_slots : tuple of WireSlot
        Which pad's wire leaves where; a pad without a slot is named in `warnings`.
    warnings : tuple of str
    """

    piece: str
    V: NDArray[np.float32]
    F: NDArray[np.int64]
    floor_z: float
    fill_z: float
    top_z: float
    area_mm2: float
    depth: float
    cavity_ml: float
    lip_ml: float
    marks: NDArray[np.float64]
    wire_slots: tuple[WireSlot, ...]
    warnings: tuple[str, ...]

    def __repr__(self) -> str:
        return f"CastingMould({self.piece!r}, {len(self.F)} triangles, cavity {self.cavity_ml:.2f} ml)"

    @property
    def watertight(self) -> bool:
        """Every edge has one triangle on either side, wound alike."""
        return is_watertight(self.F)

    @property
    def size_mm(self) -> tuple[float, float, float]:
        """Outer width, depth and height (x, y, z)."""
        w, d, h = (round(float(extent), 3) for extent in np.ptp(self.V.astype(np.float64), axis=0))
        return w, d, h


def casting_mould(
    piece: Piece,
    *,
    material: Material,
    depth: float | None = None,
    pads: Sequence[WirePad] = (),
    lips: Sequence[NDArray[np.float64]] = (),
) -> CastingMould:
    """The mould of one flat piece: floor plate, wall, registration marks, wire slots, adhesive lips.

    The wall fills the darts, and leans outwards by the material's draft about the piece's outline at half the
    silicone's depth; where an outline is too fine for that it is upright, with a warning. Its top is `FREEBOARD_MM`
    above the silicone, and the slots for the wires end at the silicone's surface, so that nothing runs out. A lip is
    as thick as the top layer and as wide as the material says: it is glued over the other side of its seam.

    Parameters
    ----------
    piece : Piece
    material : Material
        Its `mould` table holds the dimensions.
    depth : float, mm, optional
        Of the silicone; the material's layers together by default.
    pads : sequence of WirePad
        The contact pads on this piece; each gets a slot for its wire where a straight wire reaches a wall.
    lips : sequence of (k, 2) float, mm
        Runs of the piece's outline, in its direction, that get a lip where there is room.

    Raises
    ------
    InputError
        A dimension that cannot be printed.
    RefusedError
        The finished mesh is not watertight, or its cavity is not the piece's area times `depth` within
        ``tolerances.CAVITY_FRACTION``.

    Examples
    --------
    >>> from skinfab.material import load_material
    >>> F, UV = np.array([[0, 1, 2], [0, 2, 3]]), np.array([[0.0, 0], [40, 0], [40, 20], [0, 20]])
    >>> casting_mould(Piece("P1", np.arange(2), np.arange(4), F, UV), material=load_material())
    CastingMould('P1', 116 triangles, cavity 2.00 ml)
    """
    depth = material.depth if depth is None else depth
    if not (np.isfinite(depth) and depth > 0):
        raise InputError(f"the silicone's depth is {depth:g} mm; it must be positive")
    try:
        return _cast(piece, material, depth, pads, lips)
    except RefusedError:
        if not material.mould.draft_deg:
            raise
    upright = _cast(piece, replace(material, mould=replace(material.mould, draft_deg=0.0)), depth, pads, lips)
    return replace(
        upright, warnings=(*upright.warnings, f"piece {piece.id}: its outline is too fine for leaning walls, so they are upright")
    )


def _cast(piece: Piece, material: Material, depth: float, pads: Sequence[WirePad], lips: Sequence[NDArray[np.float64]]) -> CastingMould:
    plan = mould_plan(piece, mould=material.mould, depth=depth, freeboard=FREEBOARD_MM, pads=pads, lips=lips)
    floor_z = material.mould.floor
    fill_z, top_z = floor_z + depth, floor_z + depth + FREEBOARD_MM
    lip_depth = min(material.layers[-1].depth, depth) if material.layers else depth
    V, F = _printable(_solid(plan, floor_z, fill_z, top_z, lip_depth))
    if not is_watertight(F):
        raise RefusedError(f"the mould of piece {piece.id} is not watertight; simplify the piece's outline and try again")
    cavity, lip = (_hollow(V, F, region, floor_z, fill_z) for region in (plan.block, plan.lip))
    _require(cavity, piece.area, depth, f"cavity of piece {piece.id}")
    _require(lip, plan.lip.area, lip_depth, f"lip of piece {piece.id}")
    return CastingMould(
        piece.id, V, F, floor_z, fill_z, top_z, piece.area, depth, cavity / 1000, lip / 1000, plan.marks, plan.wire_slots, plan.warnings
    )


def skin_moulds(skin: Skin, *, material: Material) -> list[CastingMould]:
    """One mould a piece that can be cast: a wire slot for either pad of each sensor, a lip on one side of each seam."""
    lips = seam_lips(skin, material=material)
    return [
        casting_mould(
            piece,
            material=material,
            pads=wire_pads(skin.sensors_on(piece.id)),
            lips=lips.get(k, []),
        )
        for k, piece in enumerate(skin.pieces)
        if can_be_cast(piece, material)
    ]


def seam_lips(skin: Skin, *, material: Material) -> dict[int, list[NDArray[np.float64]]]:
    """Runs of outline that get an adhesive lip, (k, 2) mm each, by the piece's place in ``skin.pieces``: one side of each seam."""
    sewn: set[str] = set()
    lips: dict[int, list[NDArray[np.float64]]] = {}
    for side in seam_sides(skin.pieces):
        if side.label and side.label not in sewn and material.mould.lip > 0:
            sewn.add(side.label)
            lips.setdefault(side.piece, []).append(side.points)
    return lips


def can_be_cast(piece: Piece, material: Material) -> bool:
    """Whether a piece is large enough to be handled: a square of half the least neck, at least."""
    return piece.area >= (material.neck / 2) ** 2


def write_mould(mould: CastingMould, path: str | Path) -> None:
    """Write the mould as binary STL, whole or not at all; the same mould gives the same bytes."""
    facets = np.zeros(len(mould.F), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    facets["corners"] = mould.V[mould.F]
    # Normals are left zero: every reader takes them from the corners' order.
    header = f"skinfab mould of piece {mould.piece}, mm".encode("ascii", "replace")[:80].ljust(80)
    atomic_write(path, header + np.uint32(len(facets)).astype("<u4").tobytes() + facets.tobytes())


def is_watertight(F: NDArray[np.int64]) -> bool:
    """Whether each edge is used once in either direction, and there is at least one triangle."""
    if not len(F):
        return False
    start, end = F.ravel(), np.roll(F, -1, axis=1).ravel()
    sign = np.where(start < end, 1, -1)
    topology = Topology(F)
    turn = np.zeros(len(topology.E), dtype=np.int64)
    np.add.at(turn, topology.FE.ravel(), sign)
    return bool((topology.edge_count == 2).all() and not turn.any())


def _solid(plan: MouldPlan, floor_z: float, fill_z: float, top_z: float, lip_depth: float) -> Any:
    """The mould as a manifold3d solid."""
    above = top_z - fill_z  # cuts reach this far past the top, so that no two faces coincide
    plate = _prism(plan.plate, 0.0, floor_z) - _prism(plan.grooves, floor_z / 2, floor_z + above)
    wall = _wall(plan, floor_z, top_z, above)
    if not plan.slots.is_empty:
        wall -= _prism(plan.slots, fill_z, top_z + above)
    if not plan.lip.is_empty:
        wall -= _prism(plan.lip_cut, fill_z - lip_depth, top_z + above)
    return plate + wall


def _wall(plan: MouldPlan, floor_z: float, top_z: float, above: float) -> Any:
    """The wall, rooted in the plate; with a draft, the cavity is cut from it as a body that widens upwards."""
    if plan.top is plan.bottom:
        return _prism(plan.wall, floor_z / 2, top_z)
    cavity = tapered(plan.bottom, plan.top, z=(floor_z / 4, floor_z, top_z, top_z + above))
    return _prism(plan.wall | plan.cavity, floor_z / 2, top_z) - cavity


def _prism(region: Any, low: float, high: float) -> Any:
    from manifold3d import CrossSection, FillRule

    polygons = getattr(region, "geoms", [region])
    rings = [np.asarray(ring.coords)[:-1] for part in polygons for ring in (part.exterior, *part.interiors)]
    return CrossSection(rings, FillRule.EvenOdd).extrude(high - low).translate((0.0, 0.0, low))


def _printable(solid: Any) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Vertices and triangles in single precision, in an order that depends on the shape alone."""
    # Points nearer to each other than the grid could become one in single precision, and two edges with them.
    V, F = _rounded(solid.simplify(MOULD_GRID_MM))
    if not is_watertight(F):
        # Where two walls touch in a line, that line has four faces: details below the width of a slit are let go.
        V, F = _rounded(solid.simplify(MOULD_SLIT_MM))
    return V, F


def _rounded(solid: Any) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    mesh = solid.to_mesh64()
    V, back = np.unique(mesh.vert_properties[:, :3].astype(np.float32), axis=0, return_inverse=True)
    F = back.reshape(-1)[mesh.tri_verts.astype(np.int64)]
    F = F[(F[:, 0] != F[:, 1]) & (F[:, 1] != F[:, 2]) & (F[:, 2] != F[:, 0])]
    first = F.argmin(axis=1)
    F = np.take_along_axis(F, (first[:, None] + np.arange(3)) % 3, axis=1)
    return V, np.ascontiguousarray(F[np.lexsort(F.T[::-1])])


def _hollow(V: NDArray[np.float32], F: NDArray[np.int64], region: Any, floor_z: float, fill_z: float) -> float:
    """What fits in: a block over the region, less the mould's own mesh (mm^3)."""
    from manifold3d import Manifold, Mesh64

    if region.is_empty:
        return 0.0
    mesh = Manifold(Mesh64(V.astype(np.float64), F.astype(np.uint64)))
    return float((_prism(region, floor_z, fill_z) - mesh).volume())


def _require(volume: float, area: float, depth: float, what: str) -> None:
    expected = area * depth
    if not abs(volume - expected) <= CAVITY_FRACTION * expected:
        raise RefusedError(
            f"the {what} holds {volume / 1000:.3f} ml in its mould but needs {expected / 1000:.3f} ml "
            f"(area {area:.1f} mm^2 x {depth:g} mm); check the flat piece for overlaps"
        )
