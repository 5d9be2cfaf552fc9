"""Level of detail: a rough likeness of a big mesh, made beside the window, to turn it without waiting."""

from __future__ import annotations

import threading

from gui.view3d.solid import Solid
from skinfab.mesh.cluster import clustered
from skinfab.mesh.model import Mesh

#: Meshes with fewer triangles are quick enough as they are.
FEW_FACES = 160_000

#: Triangles of the likeness: fewer than pixels of the object on a large screen.
_FACES = 90_000


class Detail:
    """The rough likeness of one mesh, once it is there.

    Parameters
    ----------
    mesh : Mesh

    Examples
    --------
    >>> import numpy as np
    >>> detail = Detail(Mesh(np.eye(3), np.array([[0, 1, 2]])))
    >>> detail.wait(), detail.rough is None  # one triangle needs none
    (True, True)
    """

    def __init__(self, mesh: Mesh) -> None:
        self.rough: Solid | None = None
        self._thread: threading.Thread | None = None
        if len(mesh.F) >= FEW_FACES:
            # Nearly all of it is numpy at work on large arrays, which lets the window go on.
            self._thread = threading.Thread(target=self._make, args=(mesh,), daemon=True)
            self._thread.start()

    def wait(self, timeout: float | None = None) -> bool:
        """Until it is there; whether it is."""
        if self._thread is not None:
            self._thread.join(timeout)
            return not self._thread.is_alive()
        return True

    def _make(self, mesh: Mesh) -> None:
        few = clustered(mesh, faces=_FACES)
        self.rough = Solid.of(few.mesh, few.face, slack=few.cell)
