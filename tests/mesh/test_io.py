"""Files of every format give the same mesh, in mm; real ones are what their list says."""

import hashlib
import os
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError
from skinfab.mesh.io import load_mesh

ROOT = Path(__file__).parents[2]
REAL = ROOT.parent / "shared" / "meshes"
CUBE = ROOT / "meshes" / "cube.obj"


@pytest.mark.parametrize("suffix", ["stl", "ply", "off", "glb"])
def test_formats_agree(suffix: str, tmp_path: Path) -> None:
    import trimesh

    cube = load_mesh(CUBE).mesh
    path = tmp_path / f"cube.{suffix}"
    trimesh.Trimesh(cube.V, cube.F, process=False).export(path)
    loaded = load_mesh(path)
    np.testing.assert_array_equal(loaded.mesh.V[loaded.mesh.F], cube.V[cube.F])
    assert loaded.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    assert (loaded.file, loaded.units, loaded.scale, loaded.notes) == (path.name, "mm", 1.0, ())


def test_a_glb_scene_is_placed_and_kept_whole(tmp_path: Path) -> None:
    import trimesh

    box = trimesh.creation.box((20, 20, 20))
    scene = trimesh.Scene()
    for x in (0, 50):
        scene.add_geometry(box, transform=trimesh.transformations.translation_matrix((x, 0, 0)))
    scene.export(tmp_path / "two.glb")
    mesh = load_mesh(tmp_path / "two.glb").mesh
    assert len(mesh.F) == 24
    np.testing.assert_allclose(mesh.bbox, [[-10, -10, -10], [60, 10, 10]])


def test_units_and_scale() -> None:
    assert load_mesh(CUBE, units="cm", scale=0.5).mesh.bbox[1].tolist() == [200, 200, 200]
    assert load_mesh(CUBE, units="cm", scale=0.5).scale == 5.0
    shrunk = load_mesh(CUBE, scale=0.001)  # the unit is the file's, whatever is made of it
    assert (shrunk.units, shrunk.scale) == ("mm", 0.001) and "0.04 mm long" in shrunk.notes[0]


@pytest.mark.parametrize("scale", [0, -1, float("nan"), float("inf")])
def test_scale_must_be_positive(scale: float) -> None:
    with pytest.raises(InputError, match="scale"):
        load_mesh(CUBE, scale=scale)


@pytest.mark.skipif(not REAL.exists(), reason="the real meshes (../shared/meshes) are not here")
def test_real_obj_files_are_read_as_libigl_reads_them() -> None:
    import igl

    for path in sorted(REAL.glob("*.obj")):
        loaded = load_mesh(path)
        V, F = igl.read_triangle_mesh(str(path))
        np.testing.assert_array_equal(loaded.mesh.F, F, err_msg=path.name)
        np.testing.assert_allclose(loaded.mesh.V, V * loaded.scale, rtol=1e-14, atol=1e-12, err_msg=path.name)


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("\u00fc v2.obj", "\u00fc v2"),
        ("grip\u3000v2.obj", "grip_v2"),  # a space that is not shown as one made a document that could not be opened again
        ("a\x01\\b.obj", "a__b"),
        (os.fsdecode(b"\xe9.obj"), "_"),  # no UTF-8: the first drawing ended in a traceback
        ("...obj", "_"),
    ],
)
def test_whatever_a_file_is_called_its_mesh_has_a_name_that_documents_take(tmp_path: Path, file: str, name: str) -> None:
    (tmp_path / file).write_text("v 0 0 0\nv 20 0 0\nv 0 20 0\nf 1 2 3\n")
    loaded = load_mesh(tmp_path / file)
    assert loaded.mesh.name == name and loaded.file.encode()
