"""What the worker process does: each function reads or computes with the library and gives back one value."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from gcode.used import limits_of, used_by, with_room_for_nozzle
from gui.state.wording import in_window
from skinfab.document import load_skin
from skinfab.material import load_material
from skinfab.mesh.door import load_usable
from skinfab.mesh.inspect import inspect
from skinfab.mesh.io import load_mesh
from skinfab.mesh.model import Mesh
from skinfab.mesh.repair import clean, repair
from skinfab.mesh.surface import surface
from skinfab.mesh.units import guess_units
from skinfab.mesh.wrap import WRAP_OFFSET, wrap
from skinfab.placement import beside
from skinfab.placement.edit import Sensors
from skinfab.placement.place import place_sensors
from skinfab.progress import Progress, part_of
from skinfab.seams import partial
from skinfab.seams.auto import Aim
from skinfab.seams.partial import Fault, Reopened
from skinfab.skin import Skin, Source
from skinfab.tolerances import REPAIR_HOLE_EDGES


@dataclass(frozen=True)
class MeshFacts:
    """What a mesh file holds.

    Parameters
    ----------
    file : str
        Its name.
    headline : str
        Triangles, parts, closed or open, as it is opened without repair.
    extent : float
        Largest extent, file units.
    units, unit_reason : str
        The unit it seems to be in, and why.
    unit_sure : bool
    found, cleaning_does, repair_does : tuple of str
        Faults that are left by then; what reading mends in any case; what repair would change.
    usable : bool
        Without repair.
    """

    file: str
    headline: str
    extent: float
    units: str
    unit_reason: str
    unit_sure: bool
    found: tuple[str, ...]
    cleaning_does: tuple[str, ...]
    repair_does: tuple[str, ...]
    usable: bool


@dataclass(frozen=True, eq=False)
class Opened:
    """A document and what there is to say about reading it."""

    skin: Skin
    notes: tuple[str, ...]


def look_at_mesh(*, path: Path, progress: Progress) -> MeshFacts:
    """Read a mesh file and say what is in it."""
    progress(0.1, f"reading {path.name}")
    loaded = load_mesh(path, units="mm")
    progress(0.4, "inspecting")
    found = inspect(loaded.mesh.V, loaded.mesh.F)
    cleaned, does = clean(loaded.mesh)
    after = inspect(cleaned.V, cleaned.F) if does else found
    progress(0.8, "trying repair")
    mended, would_do = repair(cleaned) if after.open_edges or not after.usable else (cleaned, [])
    faults = after.faults
    if not would_do or mended.topology.is_boundary.sum() >= after.open_edges:
        faults = tuple(replace(fault, remedy=_kept_open(cleaned)) if fault.kind == "open edge" else fault for fault in faults)
    extent = float(max(found.size_mm))
    guess = guess_units(extent)
    shape = "closed" if after.closed else f"with {after.boundary_loops} open border{'' if after.boundary_loops == 1 else 's'}"
    parts = "" if after.components == 1 else f" in {after.components} parts"
    return MeshFacts(
        file=path.name,
        headline=f"{path.name}: {after.faces} triangles{parts}, {shape}",
        extent=extent,
        units=guess.units,
        unit_reason=guess.reason.split("; set --units")[0],
        unit_sure=guess.sure,
        found=tuple(in_window(fault.sentence) for fault in faults),
        cleaning_does=tuple(does),
        repair_does=tuple(would_do),
        usable=after.usable,
    )


def _kept_open(mesh: Mesh) -> str:
    """What becomes of holes that repair leaves."""
    large = all(len(loop) > REPAIR_HOLE_EDGES for loop in mesh.topology.boundary_loops)
    return "kept as a border" + f"; too large for Repair, which closes holes of up to {REPAIR_HOLE_EDGES} edges" * large


def open_mesh(*, path: Path, units: str, mend: bool, wrap_mm: float, printer: str, material: str, progress: Progress) -> Opened:
    """A document of a mesh that is not cut yet; of the outside alone where `wrap_mm` is above 0."""
    progress(0.1, f"reading {path.name}")
    loaded = load_usable(path, units=units, mend=mend)
    mesh, notes = loaded.mesh, loaded.notes
    if wrap_mm:
        progress(0.3, "wrapping")
        mesh = wrap(mesh, wrap_mm)
        notes = (*notes, f"only the outside is skinned; the skin lies {wrap_mm * WRAP_OFFSET:.2g} mm off the object")
    skin = Skin(
        mesh=mesh,
        source=Source(loaded.file, loaded.sha256, loaded.units, loaded.scale),
        seams=np.zeros((0, 2), dtype=np.int64),
        pieces=(),
        printer=printer,
        material=material,
    )
    return Opened(skin, notes)


def open_skin(*, path: Path, progress: Progress) -> Opened:
    """A document as it lies there."""
    progress(0.1, f"reading {path.name}")
    return Opened(load_skin(path), ())


def auto_cut(*, skin: Skin, aim: Aim = "usual", progress: Progress) -> Reopened:
    """Automatic seams for an aim of `find_seams`; locked ones stay."""
    material = load_material(skin.material)
    return partial.auto_cut(skin, limits_of(skin), neck=material.neck, material=material, aim=aim, progress=progress)


def reopen(*, skin: Skin, method: str, cones: int | None, anew: Collection[str], progress: Progress) -> Reopened:
    """The pieces that the seams give as they are."""
    return partial.reopen(
        skin,
        limits_of(skin),
        method=method,
        cones=cones,
        anew=anew,
        material=load_material(skin.material),
        progress=progress,
    )


def place_anew(*, skin: Skin, file: Path | None, progress: Progress) -> tuple[Skin, tuple[str, ...]]:
    """Sensors in place of those there are, automatic or as a file says, and what there is to say."""
    progress(0.1, "placing sensors")
    used = used_by(skin)
    roomy, wider = with_room_for_nozzle(used.material, used.printer)
    sensors, warnings = place_sensors(skin, roomy, file)
    return replace(skin, sensors=sensors), (*wider, *warnings)


def copy_beside(*, skin: Skin, ids: Sequence[str], progress: Progress) -> tuple[Sensors, tuple[str, ...]]:
    """Copies of sensors where there is room for them."""
    progress(0.1, "looking for room")
    used = used_by(skin)
    return beside.copy_beside(skin, ids, material=with_room_for_nozzle(used.material, used.printer)[0])


def make_thick(*, skin: Skin, thickness: float, method: str, progress: Progress) -> Reopened:
    """The same seams for a skin of another thickness: the surface on which it keeps its lengths lies elsewhere."""
    progress(0.1, "moving the surface")
    material = load_material(skin.material)
    usual = thickness == material.depth  # what nobody had to ask for is rounded off where it folds, as by skinfab make
    flattened = surface(skin.object, thickness=None if usual else thickness, neutral=skin.neutral, usual=material.depth)
    moved = replace(
        skin, mesh=flattened.mesh, thickness=flattened.thickness, object_V=None if flattened.mesh is skin.object else skin.object.V
    )
    ids = [piece.id for piece in skin.pieces]
    made = partial.reopen(moved, limits_of(skin), method=method, anew=ids, material=material, progress=part_of(progress, 0.3, 1.0))
    remarks = tuple(Fault(remark, np.arange(len(moved.mesh.F))) for remark in flattened.remarks)
    return replace(made, faults=remarks + made.faults)
