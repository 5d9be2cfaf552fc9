"""The program that does the jobs of a batch: all that `skinfab make` needs is loaded once, then each job is a fork.

``python -P -m skinfab.cli.batch_job``, started by a worker and spoken to on standard input (`skinfab.batch.runner`).
"""

from __future__ import annotations

import importlib
import os

#: What a job would spend seconds on importing.
_NEEDED = (
    *("skinfab.cli.make", "skinfab.mesh.door", "skinfab.mesh.surface", "skinfab.seams.auto", "skinfab.seams.document"),
    *("skinfab.placement.place", "skinfab.placement.bare", "gcode.outputs", "skinfab.report.preview", "skinfab.report.strain_picture"),
    *("skinfab.drawings.dxf", "skinfab.drawings.pdf", "ezdxf", "shapely", "manifold3d", "scipy.sparse.linalg", "scipy.spatial", "igl"),
    *(f"matplotlib.{name}" for name in ("figure", "backends.backend_agg", "backends.backend_pdf", "backends.backend_svg")),
)


def main() -> None:
    """Load, then serve."""
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    for module in _NEEDED:
        importlib.import_module(module)
    _warm_up()
    from skinfab.batch.runner import serve
    from skinfab.cli.main import main as command

    serve(command)


def _warm_up() -> None:
    """Cut a tetrahedron, which loads the compiled code. No mould of it: that starts a thread, which would not come along into a fork."""
    import numpy as np

    from skinfab.cli import steps
    from skinfab.mesh.model import Mesh
    from skinfab.seams.auto import find_seams

    corners = np.array([[0, 0, 0], [20, 0, 0], [0, 20, 0], [0, 0, 20]], dtype=float)
    find_seams(Mesh(corners, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])), steps.limits(4.05, steps.profiles()))


if __name__ == "__main__":
    main()
