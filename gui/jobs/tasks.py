"""What the worker process does: each function reads or computes with the library and gives back one value."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from gcode.check_wall import nozzle_margin
from gcode.printer import load_printer
from skinfab.cli import steps
from skinfab.document import load_skin
from skinfab.material import load_material
from skinfab.mesh.door import load_usable
from skinfab.mesh.inspect import inspect
from skinfab.mesh.io import load_mesh
from skinfab.mesh.repair import clean, repair
from skinfab.mesh.units import guess_units
from skinfab.placement.auto import place
from skinfab.placement.check import validate
from skinfab.progress import Progress
from skinfab.seams import partial
from skinfab.seams.judge import Limits
from skinfab.seams.partial import Reopened
from skinfab.skin import Skin, Source


@dataclass(frozen=True)
class MeshFacts:
    """What a mesh file holds.

    Parameters
    ----------
    file : str
        Its name.
    headline : str
        Triangles, size, closed or open.
    extent : float
        Largest extent, file units.
    units, unit_reason : str
        The unit it seems to be in, and why.
    unit_sure : bool
    found, cleaning_does, repair_does : tuple of str
        Faults; what reading mends in any case; what repair would change.
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
    would_do = repair(cleaned)[1] if after.open_edges or not after.usable else []
    extent = float(max(found.size_mm))
    guess = guess_units(extent)
    shape = "closed" if found.closed else f"with {found.boundary_loops} open border{'' if found.boundary_loops == 1 else 's'}"
    parts = "" if found.components == 1 else f" in {found.components} parts"
    return MeshFacts(
        file=path.name,
        headline=f"{path.name}: {found.faces} triangles{parts}, {shape}",
        extent=extent,
        units=guess.units,
        unit_reason=guess.reason.split("; set --units")[0],
        unit_sure=guess.sure,
        found=tuple(fault.sentence for fault in found.faults),
        cleaning_does=tuple(does),
        repair_does=tuple(would_do),
        usable=after.usable,
    )


def open_mesh(*, path: Path, units: str, mend: bool, printer: str, material: str, progress: Progress) -> Opened:
    """A document of a mesh that is not cut yet."""
    progress(0.1, f"reading {path.name}")
    loaded = load_usable(path, units=units, mend=mend)
    skin = Skin(
        mesh=loaded.mesh,
        source=Source(loaded.file, loaded.sha256, loaded.units, loaded.scale),
        seams=np.zeros((0, 2), dtype=np.int64),
        pieces=(),
        printer=printer,
        material=material,
    )
    return Opened(skin, loaded.notes)


def open_skin(*, path: Path, progress: Progress) -> Opened:
    """A document as it lies there."""
    progress(0.1, f"reading {path.name}")
    return Opened(load_skin(path), ())


def limits_of(skin: Skin) -> Limits:
    """What the document's pieces must keep to: its bound, and the bed of its printer."""
    return steps.limits(skin.max_distortion, steps.profiles(skin.printer, skin.material))


def auto_cut(*, skin: Skin, progress: Progress) -> Reopened:
    """Automatic seams; locked ones stay."""
    material = load_material(skin.material)
    return partial.auto_cut(skin, limits_of(skin), neck=material.neck, material=material, progress=progress)


def reopen(*, skin: Skin, method: str, anew: Collection[str], progress: Progress) -> Reopened:
    """The pieces that the seams give as they are."""
    return partial.reopen(skin, limits_of(skin), method=method, anew=anew, material=load_material(skin.material), progress=progress)


def place_automatically(*, skin: Skin, progress: Progress) -> tuple[Skin, tuple[str, ...]]:
    """Sensors in place of those there are, and what there is to say."""
    progress(0.1, "placing sensors")
    printer, material = load_printer(skin.printer), load_material(skin.material)
    roomy = replace(material, margin=max(material.margin, nozzle_margin(printer, material)))
    sensors, warnings = place(skin.object, skin.pieces, material=roomy, seed=skin.seed)
    validate(replace(skin, sensors=tuple(sensors)), roomy)
    return replace(skin, sensors=tuple(sensors)), tuple(warnings)
