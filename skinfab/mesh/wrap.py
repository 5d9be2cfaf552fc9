"""The outside of an object, as a ball can touch it: without inner walls, screw holes and gaps.

Robot parts are modelled with all that is inside them; a skin goes over what is outside. "Alpha Wrapping with an Offset"
(Portaneri, Alliez, Hemmer, Birklein, Pion, SIGGRAPH 2022; CGAL's, through pymeshlab) shrinks a surface onto the object that
bridges what a ball cannot enter.
"""

from __future__ import annotations

import numpy as np

from skinfab.errors import InputError
from skinfab.mesh.model import Mesh

#: The wrap is so far off the object, in diameters of the ball: nearer, its triangles get no better, and there are more of them.
WRAP_OFFSET = 1 / 40

#: Most squares of the ball's radius on the object: a wrap has about two triangles for each, and takes a minute at this.
_MOST_SQUARES = 150_000


def wrap(mesh: Mesh, diameter: float) -> Mesh:
    """A closed surface round the object that a ball of this diameter could roll on.

    Holes, gaps and grooves that the ball cannot enter are bridged; what lies behind them is not there. All of it is
    `WRAP_OFFSET` diameters off the object or more. The same mesh gives the same wrap.

    Parameters
    ----------
    mesh : Mesh
        Closed, mm. Parts may lie in one another or pass through each other.
    diameter : float, mm
        8 is a fingertip's; triangles have about half of that for a side.

    Returns
    -------
    Mesh
        Closed and manifold.

    Raises
    ------
    InputError
        The mesh is open, so that the ball would skin its inner side too; or the ball is larger than the object, or so
        small beside it that there would be too many triangles.

    Examples
    --------
    >>> V = np.array([[0.0, 0, 0], [40, 0, 0], [0, 40, 0], [0, 0, 40]])
    >>> corner = Mesh(V, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    >>> wrapped = wrap(corner, 8.0)
    >>> len(wrapped.topology.boundary_loops), bool(1 < wrapped.area / corner.area < 1.1)
    (0, True)
    """
    open_edges = int(mesh.topology.is_boundary.sum())
    if open_edges:
        openings = len(mesh.topology.boundary_loops)
        raise InputError(
            f"--wrap: {mesh.name} is open ({open_edges} open edges round {openings} opening{'s' * (openings > 1)}), and the wrap would "
            "go through to its inner side; close it first (--repair closes small holes), or leave --wrap out"
        )
    longest = float(np.ptp(mesh.bbox, axis=0).max())
    if diameter > longest:
        raise InputError(f"--wrap {diameter:g}: the ball is larger than the object, which is {longest:.3g} mm long; give less")
    least = 2 * (mesh.area / _MOST_SQUARES) ** 0.5
    if diameter < least:
        raise InputError(f"--wrap {diameter:g}: the ball is too small for an object {longest:.3g} mm long; give {_up(least):g} or more")
    import pymeshlab

    held = pymeshlab.MeshSet()
    held.add_mesh(pymeshlab.Mesh(mesh.V, mesh.F.astype(np.int32)))
    held.generate_alpha_wrap(alpha=pymeshlab.PureValue(diameter / 2), offset=pymeshlab.PureValue(diameter * WRAP_OFFSET))
    now = held.current_mesh()
    return Mesh(now.vertex_matrix(), now.face_matrix().astype(np.int64), mesh.name)


def _up(value: float) -> float:
    """To two digits, upward, for a message."""
    digit = 10.0 ** (np.floor(np.log10(value)) - 1)
    return float(np.ceil(value / digit) * digit)
