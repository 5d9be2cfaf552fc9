"""How many pieces to expect, before anything is cut: by the curvature that one flat piece can hold.

A compact piece without darts whose interior has the total Gauss curvature K (sr) comes out at a mean d of about 4 + c K^2, where
c was measured as 0.0021 to 0.0035; a long one holds more (0.0005: a ball in two strips, as a tennis ball's). So a bound on d is a
bound on K, and the object's curvature over that is a number of pieces. Creases and sharp corners cost nothing, as pieces can be
parted there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.laplacian import intrinsic
from skinfab.mesh.decimate import decimate
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.weights import dihedral_angles

FloatArray = NDArray[np.float64]

#: Mean d above 4 of a piece over the square of its curvature (1/sr^2): under the least that was measured, and of a compact one.
_LEAST, _COMPACT = 0.0004, 0.0028

#: A finer mesh is taken on about this many triangles: curvature is then that of the shape, not of its scanner's noise.
_FACES = 4000

#: Corners (rad of angle defect) and creases (rad of dihedral angle) as sharp as this are where pieces are parted.
_CORNER, _CREASE = 0.3, 0.6108652381980153  # 35 degrees


@dataclass(frozen=True)
class Expected:
    """What a surface will need.

    Parameters
    ----------
    curvature_sr : float
        Of its smooth parts, the components' magnitudes added.
    pieces : int
        Without darts, at least.
    compact : int
        About, where pieces without darts are to be compact as well.
    components : int
        With darts a piece for each of these may do.
    """

    curvature_sr: float
    pieces: int
    compact: int
    components: int


def expected_pieces(mesh: Mesh, mean: float = 4.05) -> Expected:
    """A lower estimate of the number of compact pieces without darts that keep to a mean d.

    A part that is no disk needs two in any case. Of 15 objects at the bounds 4.02, 4.05 and 4.1 (39 answers), and of a ball, a cap and
    a torus at five bounds, the estimate was never above what `simplest_seams` found, and 0 to 18 below: machined parts, of many faces
    and little curvature, are underestimated most. `compact` was within one of it on seven of nine rounded objects at 4.05.

    Parameters
    ----------
    mesh : Mesh
        Manifold.
    mean : float
        The bound, above 4.

    Examples
    --------
    >>> from skinfab.mesh.model import Mesh
    >>> corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> tetrahedron = Mesh(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    >>> expected_pieces(tetrahedron)  # all of it is in its corners
    Expected(curvature_sr=0.0, pieces=2, compact=2, components=1)
    """
    if len(mesh.F) > 1.5 * _FACES:
        few = decimate(mesh.V, mesh.F, faces=_FACES)
        mesh = Mesh(few.V, few.F, mesh.name)
    topology = mesh.topology
    bend = 2 * np.pi - intrinsic(mesh.V, mesh.F).angle_sum
    sharp = np.abs(bend) > _CORNER
    sharp[topology.E[topology.is_boundary | (dihedral_angles(mesh) > _CREASE)]] = True
    count, label = topology.face_components()
    of_vertex = np.zeros(len(mesh.V), dtype=np.int64)
    of_vertex[mesh.F] = label[:, None]
    smooth = np.zeros(len(mesh.V), dtype=bool)
    smooth[mesh.F] = True
    smooth &= ~sharp
    curvature = np.abs(np.bincount(of_vertex[smooth], bend[smooth], count))
    disks = np.zeros(count, dtype=bool)
    for part in open_pieces(mesh, np.zeros(len(topology.E), dtype=bool)):
        disks[label[part.faces[0]]] = part.is_disk

    def pieces(per_square: float) -> int:
        needed = np.ceil(curvature / np.sqrt((mean - 4) / per_square))
        return int(np.maximum(needed, np.where(disks, 1, 2)).sum())

    return Expected(float(curvature.sum()), pieces(_LEAST), pieces(_COMPACT), count)
