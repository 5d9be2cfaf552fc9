"""Who is measured: the project's methods and its peers, one entry each.

An entry is told what to flatten and gives back the work itself, to be timed: imports, and what a peer needs to
take the mesh in, are done before.
"""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.methods import METHODS, method

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: The method `skinfab flatten` uses when none is asked for, and the peer that aims at the same d.
DEFAULT, RIVAL = "isometric", "slim"

#: Iterations of SLIM that are points of the chart.
SLIM_ITERATIONS = (1, 5, 20)


@dataclass(frozen=True, eq=False)
class Flat:
    """What a contestant made: `origin` (k,) is the vertex of the disk that each flat vertex comes from (cuts double vertices)."""

    F: IntArray
    UV: FloatArray
    origin: IntArray


Work = Callable[[], Flat]


@dataclass(frozen=True)
class Contestant:
    """One row of the table: `prepare` takes V and F in and gives the work; `needs` is the module it cannot do without."""

    name: str
    kind: str
    prepare: Callable[[FloatArray, IntArray], Work]
    needs: str = "numpy"

    @property
    def present(self) -> bool:
        return importlib.util.find_spec(self.needs) is not None


def contestants() -> list[Contestant]:
    """All of them, ours first.

    Examples
    --------
    >>> sorted({c.kind for c in contestants()})
    ['ours', 'peer']
    """
    ours = [Contestant(name, "ours", _ours(method(name))) for name in METHODS]
    return [
        *ours,
        Contestant("igl.lscm", "peer", _igl_lscm, "igl"),
        *(Contestant(f"igl.slim {n}", "peer", _igl_slim(n), "igl") for n in SLIM_ITERATIONS),
        Contestant("pymeshlab harmonic", "peer", _pymeshlab("compute_texcoord_parametrization_harmonic"), "pymeshlab"),
        Contestant("pymeshlab lscm", "peer", _pymeshlab("compute_texcoord_parametrization_least_squares_conformal_maps"), "pymeshlab"),
        Contestant("xatlas", "peer", _xatlas, "xatlas"),
    ]


def _ours(flatten: Callable[[FloatArray, IntArray], FloatArray]) -> Callable[[FloatArray, IntArray], Work]:
    return lambda V, F: lambda: Flat(F, flatten(V, F), np.arange(len(V)))


def _igl_lscm(V: FloatArray, F: IntArray) -> Work:
    import igl

    def work() -> Flat:
        loop = igl.boundary_loop(F)
        held = np.array([loop[0], loop[len(loop) // 2]], dtype=np.int64)
        return Flat(F, igl.lscm(V, F, held, np.array([[0.0, 0.0], [1.0, 0.0]]))[0], np.arange(len(V)))

    return work


def _igl_slim(iterations: int) -> Callable[[FloatArray, IntArray], Work]:
    def prepare(V: FloatArray, F: IntArray) -> Work:
        from skinfab.flatten.bff import flatten_scaled

        def work() -> Flat:
            # SLIM needs a start without flips: ours, and it is inside the time, as anybody would have to make one.
            slim = Slim(V, F, flatten_scaled(V, F))
            for _ in range(iterations):
                UV = slim.step()
            return Flat(F, UV, np.arange(len(V)))

        return work

    return prepare


class Slim:
    """libigl's SLIM on the symmetric Dirichlet energy, one iteration at a time, nothing held."""

    def __init__(self, V: FloatArray, F: IntArray, start: FloatArray) -> None:
        import igl

        self._solve = igl.slim_solve
        self._data = igl.slim_precompute(
            np.asfortranarray(V),
            np.asfortranarray(F.astype(np.int32)),
            np.asfortranarray(start),
            igl.MappingEnergyType.SYMMETRIC_DIRICHLET,
            np.zeros(0, dtype=np.int32),
            np.zeros((0, 2), order="F"),
            0.0,
        )

    def step(self) -> FloatArray:
        """One more iteration; the flat coordinates after it, (n, 2) mm."""
        return np.array(self._solve(self._data, 1))[:, :2]


def _pymeshlab(name: str) -> Callable[[FloatArray, IntArray], Work]:
    def prepare(V: FloatArray, F: IntArray) -> Work:
        import pymeshlab

        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(V, F))

        def work() -> Flat:
            meshes.apply_filter(name)
            return Flat(F, meshes.current_mesh().vertex_tex_coord_matrix(), np.arange(len(V)))

        return work

    return prepare


def _xatlas(V: FloatArray, F: IntArray) -> Work:
    xatlas: Any = importlib.import_module("xatlas")  # a dependency of developers only

    def work() -> Flat:
        atlas = xatlas.Atlas()
        atlas.add_mesh(V.astype(np.float32), F.astype(np.uint32))
        options = xatlas.ChartOptions()
        options.fix_winding = True
        atlas.generate(options)
        origin, faces, uv = atlas[0]
        # Its coordinates are shares of a sheet that need not be square.
        return Flat(faces.astype(np.int64), uv.astype(np.float64) * [atlas.width, atlas.height], origin.astype(np.int64))

    return work
