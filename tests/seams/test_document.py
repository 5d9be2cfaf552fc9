"""From seams to a document."""

import numpy as np
from shapes import object_mesh

from skinfab.mesh.surface import surface
from skinfab.seams.auto import find_seams
from skinfab.seams.document import to_skin
from skinfab.seams.judge import Limits
from skinfab.skin import Source


def test_a_document_says_how_it_was_made() -> None:
    mesh, limits = object_mesh("cube"), Limits(mean=4.1)
    flattened = surface(mesh, thickness=2.0)
    source = Source("cube.obj", "0" * 64, "mm", 1.0)
    skin, distortions = to_skin(mesh, source, flattened, find_seams(flattened.mesh, limits), limits, printer="a", material="b", seed=5)
    assert (skin.source, skin.printer, skin.material, skin.seed, skin.max_distortion) == (source, "a", "b", 5, 4.1)
    assert (skin.thickness, skin.neutral, skin.flattened_at) == (2.0, 0.5, 1.0)
    np.testing.assert_array_equal(skin.object.V, mesh.V)
    assert skin.mesh is flattened.mesh and len(distortions) == len(skin.pieces) == 1
    assert len(distortions[0].d) == len(skin.pieces[0].F)
    assert set(map(tuple, skin.seams.tolist())) <= set(map(tuple, mesh.topology.E.tolist()))


def test_without_thickness_the_object_is_what_was_flattened() -> None:
    mesh, limits = object_mesh("cube"), Limits()
    skin, _ = to_skin(mesh, Source("c", "", "mm", 1.0), surface(mesh), find_seams(mesh, limits), limits, printer="a", material="b")
    assert skin.object is skin.mesh is mesh and skin.object_V is None
