"""Big meshes have a rough likeness, with the faces' own numbers."""

import numpy as np

from gui.view3d.detail import FEW_FACES, Detail
from skinfab.bench.disks import bumpy_cap
from skinfab.mesh.model import Mesh


def test_small_meshes_need_none():
    detail = Detail(Mesh(*bumpy_cap(5_000)))
    assert detail.wait() and detail.rough is None


def test_a_big_mesh_has_fewer_triangles_in_the_same_places():
    mesh = Mesh(*bumpy_cap(FEW_FACES + 10_000))
    detail = Detail(mesh)
    assert detail.wait(60)
    rough = detail.rough
    assert len(rough.F) < 0.8 * len(mesh.F) and len(rough.name) == len(rough.F)
    apart = np.linalg.norm(rough.V[rough.F].mean(axis=1) - mesh.V[mesh.F[rough.name]].mean(axis=1), axis=1)
    assert apart.max() < rough.slack
