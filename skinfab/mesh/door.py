"""From a file to a mesh that the rest can rely on: read, clean, mend where asked, refuse what is left."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from skinfab.mesh.intact import is_intact
from skinfab.mesh.io import Loaded, load_mesh
from skinfab.mesh.model import Mesh
from skinfab.mesh.repair import clean, repair, require_usable
from skinfab.tolerances import REPAIR_HOLE_EDGES


def load_usable(path: str | Path, *, units: str | None = None, scale: float = 1.0, mend: bool = False) -> Loaded:
    """Read a mesh file and make it fit for use.

    Parameters
    ----------
    path, units, scale
        See `load_mesh`.
    mend : bool
        Mend what changes the surface, too (``--repair``).

    Returns
    -------
    Loaded
        A mesh as `require_usable` describes; what was done to it is among the notes.

    Raises
    ------
    InputError
        The file cannot be read, or the mesh not be used: names the first offending element.
    """
    loaded = load_mesh(path, units=units, scale=scale)
    mesh = loaded.mesh
    done: list[str] = []
    if mend or not is_intact(mesh):
        mesh, done = (repair if mend else clean)(mesh)
        require_usable(mesh)
    return replace(loaded, mesh=mesh, notes=(*loaded.notes, *done, *([] if mend else _small_holes(mesh))))


def _small_holes(mesh: Mesh) -> list[str]:
    """Says that a border may be damage: a seam will run along it, which one may not have wanted."""
    small = [len(loop) for loop in mesh.topology.boundary_loops if len(loop) <= REPAIR_HOLE_EDGES]
    if not small:
        return []
    holes = f"a hole of {small[0]} edges is" if len(small) == 1 else f"{len(small)} holes of {min(small)} to {max(small)} edges are"
    return [f"{holes} taken as the skin's edge; --repair closes holes of up to {REPAIR_HOLE_EDGES} edges"]
