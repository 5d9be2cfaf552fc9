"""The surface that is flattened: the object's own, or the one on which a skin of some thickness keeps its lengths."""

from __future__ import annotations

import math
from dataclasses import dataclass

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.mesh.offset import OffsetError, offset_mesh


@dataclass(frozen=True)
class Surface:
    """What is flattened: the object's own surface, or the one that a skin of some thickness keeps its lengths on.

    Parameters
    ----------
    mesh : Mesh
    thickness : float, mm
        0 where the object's own surface is flattened.
    neutral : float
        How far through the skin, from 0 (inner side) to 1, bending stretches nothing.
    remarks : tuple of str
        What the user should be told.
    """

    mesh: Mesh
    thickness: float
    neutral: float
    remarks: tuple[str, ...] = ()


def surface(mesh: Mesh, *, thickness: float | None = None, neutral: float = 0.5, usual: float = 0.0) -> Surface:
    """The surface for a skin of that thickness.

    Parameters
    ----------
    mesh : Mesh
    thickness : float, mm, optional
        Without it the usual one is taken, and places where that folds are rounded off.
    neutral : float
    usual : float, mm
        What the material profile pours.

    Raises
    ------
    InputError
        Thicker than the object is long, or so thick that the surface folds.

    Examples
    --------
    >>> import numpy as np
    >>> mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    >>> surface(mesh).mesh is mesh
    True
    """
    chosen = usual if thickness is None else thickness
    size = float((mesh.bbox[1] - mesh.bbox[0]).max())
    if chosen > size:
        raise InputError(
            f"a skin {chosen:g} mm thick does not go on an object {size:.3g} mm long; check --units and --thickness, or scale the "
            "object up with --scale"
        )
    try:
        offset = offset_mesh(mesh, chosen * neutral, round_off=thickness is None)
    except OffsetError as fault:
        # Rounded down to whole hundredths: what is said will do.
        most = math.floor(100 * fault.largest / neutral) / 100
        less = f", give --thickness {most:g} or less" if most > 0 else ""
        raise InputError(f"--thickness {chosen:g}: {fault}{less}, or leave it to skinfab make, which rounds it off by itself") from fault
    remarks = offset.remarks
    if usual and chosen and chosen != usual:
        remarks += (f"flattened for a skin {chosen:g} mm thick, but the material profile pours {usual:g} mm; change one of them",)
    if offset.mesh is mesh and neutral:
        chosen = 0.0  # as far as the document is concerned, it was flattened without
    return Surface(offset.mesh, chosen, neutral, remarks)
