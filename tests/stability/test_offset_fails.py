"""Where an offset surface fails: each test first shows the plain one fold, then what is done instead."""

import re
from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest
import shapes

from skinfab.cli.main import main
from skinfab.cli.steps import surface
from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.mesh.offset import OffsetError, folds, offset_mesh, outward_steps
from skinfab.tolerances import OFFSET_MITRE

MESHES = Path(__file__).parents[2] / "meshes"
H = 1.25


def groove(width: float, depth: float = 5.0) -> Mesh:
    """A plate with a groove across it: its walls face each other."""
    left = [[-20, 0], [-12, 0], [-6, 0], [-width / 2, 0], [-width / 2, -depth]]
    profile = np.array([*left, *([-x, z] for x, z in reversed(left))], float)

    def place(s, t):
        k = np.rint(s * 9).astype(int)
        return np.column_stack([profile[k, 0], 30 * t, profile[k, 1]])

    return Mesh(*shapes.grid(9, 12, place))


def dimple(radius: float) -> Mesh:
    """The inside of a half sphere."""
    V, F = shapes.cap(12, np.pi / 2, radius)
    return Mesh(V, F[:, ::-1].copy())


def slit(gap: float) -> Mesh:
    """Two plates that face each other."""
    V, F = shapes.grid(8, 8)
    return Mesh(np.vstack([V * 20, V * 20 + [0, 0, gap]]), np.vstack([F, F[:, ::-1] + len(V)]))


@pytest.mark.parametrize("mesh", [groove(2.0), groove(0.5, depth=1.0)], ids=["groove", "scratch"])
def test_a_place_tighter_than_the_offset(mesh: Mesh) -> None:
    plain = mesh.V + H * outward_steps(mesh)
    assert folds(mesh, plain).any()
    with pytest.raises(OffsetError, match=r"1.25 mm outside the object folds over at \d+ triangles?, near \(.*\) mm: ") as refusal:
        offset_mesh(mesh, H)
    # What it says would do, does; a little more does not.
    most = refusal.value.largest
    assert offset_mesh(mesh, most).remarks == ()
    assert folds(mesh, mesh.V + 1.01 * most * outward_steps(mesh)).any()
    offset = offset_mesh(mesh, H, round_off=True)
    assert not folds(mesh, offset.mesh.V).any()
    (remark,) = offset.remarks
    assert "would fold over" in remark and "rounded off" in remark


def test_nothing_but_a_tight_place() -> None:
    """Inside a ball smaller than the offset every triangle is turned over: there is no such surface, and none is made up."""
    mesh = dimple(1.0)
    assert folds(mesh, mesh.V + H * outward_steps(mesh)).all()
    offset = offset_mesh(mesh, H, round_off=True)
    assert offset.mesh is mesh
    (remark,) = offset.remarks
    assert "so the object's own surface was flattened" in remark


def test_only_the_tight_place_is_rounded_off() -> None:
    """A fine plate with one dent: a few millimetres from it, the surface lies where it should."""

    def place(s, t):
        x, y = 60 * s - 30, 60 * t - 30
        return np.column_stack([x, y, -1.5 * np.exp(-(x**2 + y**2) / 1.2)])

    mesh = Mesh(*shapes.grid(120, 120, place))
    assert folds(mesh, mesh.V + H * outward_steps(mesh)).any()
    V = offset_mesh(mesh, H, round_off=True).mesh.V
    far = np.hypot(*mesh.V[:, :2].T) > 6
    assert V[far] == pytest.approx(mesh.V[far] + [0, 0, H], abs=1e-9)
    assert not folds(mesh, V).any()


def test_two_sides_that_face_each_other() -> None:
    """No triangle folds, but each plate's skin lies where the other's is."""
    mesh = slit(1.5)
    V = mesh.V + H * outward_steps(mesh)
    assert not folds(mesh, V).any()
    assert V[:81, 2].max() > V[81:, 2].min()  # they have passed through each other
    with pytest.raises(OffsetError, match=r"passes through itself near \(.*\) mm, where two sides face each other"):
        offset_mesh(mesh, H)
    (remark,) = offset_mesh(mesh, H, round_off=True).remarks
    assert "press on each other (100 % of the surface)" in remark
    assert offset_mesh(slit(2.6), H).remarks == ()


def test_a_blade_does_not_fly_off() -> None:
    """Two sides that meet at 4 degrees: their planes, moved out, meet 36 mm away."""
    a = np.tan(np.radians(2)) * 10
    V = np.array([[0.0, 0, 0], [0, 20, 0], [10, 0, a], [10, 20, a], [10, 0, -a], [10, 20, -a]])
    mesh = Mesh(V, np.array([[0, 2, 3], [0, 3, 1], [0, 1, 5], [0, 5, 4]]))
    edge = offset_mesh(mesh, H).mesh.V[:2]
    assert H / np.sin(np.radians(2)) > 35
    assert np.linalg.norm(edge - V[:2], axis=1) == pytest.approx(OFFSET_MITRE * H) and (edge[:, 0] < 0).all()


def test_needles_and_flat_triangles() -> None:
    """A triangle without area has no direction; its neighbours carry it along."""
    V = np.array([[0.0, 0, 0], [10, 0, 0], [5, 1e-9, 0], [5, 10, 0], [5, 0, 0]])
    mesh = Mesh(V, np.array([[0, 2, 3], [2, 1, 3], [0, 4, 2], [4, 1, 2]]))
    assert offset_mesh(mesh, H, round_off=True).mesh.V[:4, 2] == pytest.approx(H)


def test_a_skin_that_folds_over_is_refused_where_its_thickness_is_asked_for(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """The cup's handle meets its wall in corners tighter than half a skin. What `make` does by itself is in tests/cli/test_make.py."""
    cup = str(MESHES / "cup.obj")
    for command, output in (("segment", "a.skin"), ("flatten", "a.obj")):
        assert main([command, cup, "-o", str(tmp_path / output), "--thickness", "2.5"]) == 1
        (line,) = capfd.readouterr().err.splitlines()[-1:]
        assert "--thickness 2.5: " in line and "folds over" in line and "leave it to skinfab make" in line
        assert not (tmp_path / output).exists()
        less = re.search(r"give --thickness (\S+) or less", line)[1]
        mesh = shapes.object_mesh("cup")
        assert surface(asked(float(less)), mesh).mesh is not mesh, "what is said will do"
    assert main(["make", cup, "-o", str(tmp_path / "out"), "--thickness", "2.5"]) == 1


def asked(thickness: float | None) -> Namespace:
    return Namespace(thickness=thickness, neutral=0.5)


def test_a_given_up_offset_is_a_skin_without_thickness() -> None:
    mesh = dimple(2.0)
    found = surface(asked(None), mesh, usual=3.9)
    assert found.mesh is mesh and found.thickness == 0 and "stretched on" in found.remarks[0]
    with pytest.raises(InputError, match=r"--thickness 3\.9: .*, give --thickness [23]\.\d+ or less, or leave it to skinfab make"):
        surface(asked(3.9), mesh, usual=3.9)


def test_a_skin_thicker_than_its_object() -> None:
    V, F = shapes.cube()
    with pytest.raises(InputError, match=r"2\.5 mm thick does not go on an object 0\.04 mm long; check --units"):
        surface(asked(None), Mesh(0.04 * V, F), usual=2.5)
    with pytest.raises(InputError, match=r"1e\+06 mm thick does not go on an object 40 mm long"):
        surface(asked(1e6), Mesh(40 * V, F))
    assert surface(asked(0.0), Mesh(0.04 * V, F)).thickness == 0


def test_a_thickness_that_is_not_poured_is_said() -> None:
    mesh = shapes.object_mesh("cube")
    assert surface(asked(2.5), mesh, usual=2.5).remarks == () == surface(asked(0.0), mesh, usual=2.5).remarks
    (remark,) = surface(asked(3.0), mesh, usual=2.5).remarks
    assert "3 mm thick" in remark and "pours 2.5 mm" in remark
    assert surface(asked(3.0), mesh).remarks == ()  # segment knows of no profile's layers
