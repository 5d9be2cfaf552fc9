"""The program that does the jobs of a batch: all that `skinfab make` needs is imported once, then each job is a fork.

``python -P -m skinfab.cli.batch_job``, started by a worker and spoken to on standard input (`skinfab.batch.runner`).
"""

from __future__ import annotations

import importlib
import os

#: What a job spends two seconds on importing.
_NEEDED = (
    *("skinfab.cli.make", "skinfab.mesh.door", "skinfab.mesh.surface", "skinfab.seams.auto", "skinfab.seams.document"),
    *("skinfab.placement.place", "skinfab.placement.bare", "gcode.outputs", "skinfab.report.preview", "skinfab.report.strain_picture"),
    *("skinfab.drawings.dxf", "skinfab.drawings.pdf", "matplotlib.backends.backend_agg", "matplotlib.backends.backend_svg", "ezdxf"),
    *("shapely", "manifold3d", "scipy.sparse.linalg", "scipy.spatial", "igl", "numba"),
)


def main() -> None:
    """Import, then serve."""
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    for module in _NEEDED:
        importlib.import_module(module)
    from skinfab.batch.runner import serve
    from skinfab.cli.main import main as command

    serve(command)


if __name__ == "__main__":
    main()
