"""Mend a mesh: the harmless part always, the rest on demand, and a clear refusal for what is left."""

from __future__ import annotations

import numpy as np

from skinfab.errors import InputError
from skinfab.mesh import cleaning
from skinfab.mesh.fans import winding
from skinfab.mesh.inspect import inspect
from skinfab.mesh.model import Mesh
from skinfab.tolerances import REPAIR_HOLE_EDGES, REPAIR_SPECK

#: In this order: each pass relies on those before it.
_PASSES = (
    cleaning.drop_repeated_corners,
    cleaning.drop_duplicates,
    cleaning.weld_cracks,
    cleaning.merge_flat,
    cleaning.wind_consistently,
    cleaning.part_sheets,
    cleaning.split_touching,
    cleaning.drop_unreferenced,
)


def clean(mesh: Mesh) -> tuple[Mesh, list[str]]:
    """Do what is harmless: no point of the surface moves, no hole is closed, no part is lost.

    Degenerate and duplicate faces and unreferenced vertices are dropped, cracks between coincident
    vertices closed, faces without area merged into their neighbours, winding made consistent
    and outward, and vertices doubled, or edges split, where sheets only touch. An intact mesh comes back as it is.

    Parameters
    ----------
    mesh : Mesh
        Finite, every index in range (`load_mesh` sees to it).

    Returns
    -------
    mesh : Mesh
    done : list of str
        What was done, one sentence each.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [20, 0, 0], [0, 20, 0], [9, 9, 9]])
    >>> clean(Mesh(V, np.array([[0, 1, 2], [0, 1, 2], [1, 1, 2]])))[1]  # doctest: +NORMALIZE_WHITESPACE
    ['dropped 1 degenerate face (first: face 2)', 'dropped 1 duplicate face (first: face 1)',
     'dropped 1 unreferenced vertex (first: vertex 3)']
    """
    V, F = mesh.V, mesh.F
    done = []
    for mend in _PASSES:
        if not len(F):
            break
        V, F, said = mend(V, F)
        if said:
            done.append(said)
    return (Mesh(V, F, mesh.name), done) if done else (mesh, done)


def repair(mesh: Mesh) -> tuple[Mesh, list[str]]:
    """Mend what changes the surface: specks, non-manifold edges, self-intersections, small holes; then `clean`.

    Parameters
    ----------
    mesh : Mesh

    Returns
    -------
    mesh : Mesh
    done : list of str
        What was done, one sentence each; empty for an intact mesh.
    """
    import pymeshlab

    mesh, done = clean(mesh)
    if not len(mesh.F):
        return mesh, done
    held = pymeshlab.MeshSet()
    held.add_mesh(pymeshlab.Mesh(mesh.V, mesh.F.astype(np.int32)))

    def step(what: str, name: str, **options: object) -> None:
        before = held.current_mesh().face_number()
        held.apply_filter(name, **options)
        change = held.current_mesh().face_number() - before
        if change:
            done.append(f"{what}: {abs(change)} face{'s' if abs(change) > 1 else ''} {'added' if change > 0 else 'removed'}")

    specks = pymeshlab.PercentageValue(100 * REPAIR_SPECK)
    step("removed specks", "meshing_remove_connected_component_by_diameter", mincomponentdiag=specks)
    step("cut back to two faces at each non-manifold edge", "meshing_repair_non_manifold_edges", method="Remove Faces")
    held.compute_selection_by_self_intersections_per_face()
    if held.current_mesh().selected_face_number():
        step("removed faces that pass through each other", "meshing_remove_selected_faces")
        step("cut back to two faces at each non-manifold edge", "meshing_repair_non_manifold_edges", method="Remove Faces")
    held.meshing_repair_non_manifold_vertices()
    step(f"closed holes of up to {REPAIR_HOLE_EDGES} edges", "meshing_close_holes", maxholesize=REPAIR_HOLE_EDGES, newfaceselected=False)
    now = held.current_mesh()
    mended, more = clean(Mesh(now.vertex_matrix(), now.face_matrix(), mesh.name))
    return (mended, done + more) if done or more else (mesh, done)


def require_usable(mesh: Mesh) -> None:
    """Refuse a mesh that the methods after this cannot stand.

    Afterwards: finite, some area, two faces at most at each edge, one fan at each vertex, wound
    consistently. Borders, several parts and any genus are fine.

    Raises
    ------
    InputError
        Names the first offending element and what would mend it.
    """
    for fault in inspect(mesh.V, mesh.F).faults:
        if fault.mended_by == "repair":
            raise InputError(
                f"{mesh.name} has {_counted(fault.count, fault.kind)} (first: {fault.first}); run again with --repair: {fault.remedy}"
            )
        if fault.mended_by == "no":
            raise InputError(f"{mesh.name}: {_counted(fault.count, fault.kind)} (first: {fault.first}); {fault.remedy}")
    top = mesh.topology
    if (crowded := np.flatnonzero(top.is_nonmanifold)).size:
        first = "-".join(map(str, top.E[crowded[0]].tolist()))
        raise InputError(f"{mesh.name} has {len(crowded)} edges of more than two faces (first: edge {first}); run again with --repair")
    if winding(top).turn.any():
        raise InputError(f"{mesh.name} is not wound consistently; clean it first")


def _counted(count: int, kind: str) -> str:
    return kind if count == 1 else f"{count} x {kind}"
