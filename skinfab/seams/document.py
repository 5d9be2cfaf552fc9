"""From seams that were found to a skin document."""

from __future__ import annotations

from skinfab.flatten.distortion import Distortion
from skinfab.mesh.model import Mesh
from skinfab.mesh.surface import Surface
from skinfab.seams.auto import Seams
from skinfab.seams.finish import finish
from skinfab.seams.judge import Limits
from skinfab.seams.pieces import to_pieces
from skinfab.skin import Skin, Source


def to_skin(
    mesh: Mesh, source: Source, flattened: Surface, found: Seams, limits: Limits, *, printer: str, material: str, seed: int = 0
) -> tuple[Skin, list[Distortion]]:
    """The document of a cut mesh without sensors, its pieces flattened to the end, and each piece's distortion in its order.

    Parameters
    ----------
    mesh : Mesh
        The object itself.
    source : Source
        Where it came from.
    flattened : Surface
        Of `mesh`: what was cut.
    found : Seams
        Of ``flattened.mesh``.
    limits : Limits
        What the pieces were accepted under.
    printer, material : str
        Names of profiles, or paths of one's own.
    seed : int
    """
    surface, topology = flattened.mesh, flattened.mesh.topology
    seams = finish(surface, found, limits)
    pieces = to_pieces(surface, seams.pieces)
    skin = Skin(
        mesh=surface,
        source=source,
        seams=topology.E[seams.cut & ~topology.is_boundary],
        pieces=pieces,
        printer=printer,
        material=material,
        max_distortion=limits.mean,
        seed=seed,
        thickness=flattened.thickness,
        neutral=flattened.neutral,
        object_V=None if surface is mesh else mesh.V,
    )
    by_first_face = {int(piece.faces[0]): verdict.distortion for piece, verdict in seams.pieces}
    return skin, [by_first_face[int(piece.faces[0])] for piece in pieces]
