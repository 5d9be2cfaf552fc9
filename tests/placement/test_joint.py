"""Strain sensors across a joint that is named, and sensors on a side that is named."""

import re
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece
from skinfab.placement.check import check_sensor
from skinfab.placement.edit import middle_of
from skinfab.placement.requested import place_from_file
from skinfab.placement.sensor import Sensor

MATERIAL = load_material()
RADIUS = 11.0
STRAIN = 'kind = "strain-lines"\nparams = { l1 = 34, l2 = 24, b = 6 }\n'
NECK = 'kind = "strain-neck"\nparams = { l1 = 8, l2 = 24, l3 = 18, b1 = 2, b2 = 12 }\n'
SPIRAL = 'kind = "contact-spiral"\nparams = { n = 2, x = 1.7, b = 1.5, l = 3, s = 12 }\n'


def two_tubes() -> tuple[Mesh, list[Piece]]:
    """Two fingers along x, 90 mm long, the second 30 mm further in y; each opened at its bottom, the flat y along the finger."""
    around, along = 48, 30
    a, x = np.meshgrid(np.linspace(np.pi, -np.pi, around + 1), np.linspace(0, 90, along + 1))
    k = (np.arange(along)[:, None] * (around + 1) + np.arange(around)).ravel()
    F = np.concatenate([np.column_stack([k, k + 1, k + around + 2]), np.column_stack([k, k + around + 2, k + around + 1])])
    # Seen from outside with x up the flat page, +y lies left of +z, the top: angles fall from left to right.
    V = np.column_stack([x.ravel(), RADIUS * np.sin(a.ravel()), RADIUS * np.cos(a.ravel())])
    UV = np.column_stack([RADIUS * (np.pi - a.ravel()), x.ravel()])
    both = Mesh(np.vstack([V, np.add(V, (0, 30, 0))]), np.vstack([F, F + len(V)]), "fingers")
    pieces = [Piece(f"P{i + 1}", np.arange(len(F)) + i * len(F), np.arange(len(V)) + i * len(V), F, UV) for i in range(2)]
    return both, pieces


def placed(tmp_path: Path, text: str) -> Sensor:
    (tmp_path / "sensors.toml").write_text(f"[[sensor]]\n{text}\n")
    mesh, pieces = two_tubes()
    (sensor,), _ = place_from_file(tmp_path / "sensors.toml", mesh, pieces, material=MATERIAL)
    assert check_sensor(pieces[int(sensor.piece[1]) - 1], sensor, (), material=MATERIAL) == []
    return sensor


def on_object(sensor: Sensor) -> np.ndarray:
    """Where the sensor's middle lies, and the normal there."""
    across, x = middle_of(sensor)
    a = np.pi - across / RADIUS
    normal = np.array([0, np.sin(a), np.cos(a)])
    return np.array([[x, 30.0 * (sensor.piece == "P2"), 0] + RADIUS * normal, normal])


def test_the_tubes_face_outwards() -> None:
    mesh, _ = two_tubes()
    first = mesh.F[: len(mesh.F) // 2]
    centres = mesh.V[first].mean(axis=1) * [0, 1, 1]
    assert (np.einsum("ij,ij->i", mesh.face_normals[: len(first)], centres) > 0).all()


@pytest.mark.parametrize("pattern", [STRAIN, NECK], ids=["lines", "neck"])
@pytest.mark.parametrize(("joint", "piece"), [([30, 0, 0], "P1"), ([62, 30, 0], "P2")])
def test_it_crosses_the_joint_on_its_finger(tmp_path: Path, pattern: str, joint: list, piece: str) -> None:
    sensor = placed(tmp_path, f"{pattern}pose = {{ joint = {joint}, along = [2, 0, 0] }}")
    assert sensor.piece == piece and sensor.id == "S1"
    assert abs(on_object(sensor)[0, 0] - joint[0]) <= 0.25 * sensor.pattern.span
    # Its lines run up the finger, which is y on the flat piece.
    assert abs(np.sin(sensor.angle)) > np.cos(np.deg2rad(11))


def test_the_example_of_the_user_guide(tmp_path: Path) -> None:
    guide = (Path(__file__).parents[2] / "docs/sensors.md").read_text(encoding="utf-8")
    (text,) = (block for block in re.findall(r"```toml\n(.*?)```", guide, re.S) if "joint" in block)
    place, normal = on_object(placed(tmp_path, text.removeprefix("[[sensor]]\n")))
    assert abs(place[0] - 45) <= 6 and normal[2] >= np.cos(np.deg2rad(45 + 180 / 48))


@pytest.mark.parametrize("facing", [[0, 0, 1], [0, 1, 0], [0, -1, 1]])
def test_the_side_can_be_named(tmp_path: Path, facing: list) -> None:
    for pattern, joint in ((STRAIN, "joint = [45, 0, 0], along = [1, 0, 0], "), (SPIRAL, "")):
        normal = on_object(placed(tmp_path, f"{pattern}pose = {{ {joint}facing = {facing} }}"))[1]
        # To 45 degrees, and half a facet of the tube more.
        assert normal @ facing / np.linalg.norm(facing) >= np.cos(np.deg2rad(45 + 180 / 48))


def test_a_point_on_the_skin_is_a_side_too(tmp_path: Path) -> None:
    sensor = placed(tmp_path, f"{STRAIN}pose = {{ joint = [45, 30, {RADIUS}], along = [1, 0, 0] }}")
    place, normal = on_object(sensor)
    assert sensor.piece == "P2" and normal[2] > 0.9 and abs(place[0] - 45) <= 6


@pytest.mark.parametrize(
    ("text", "error", "says"),
    [
        (f"{SPIRAL}pose = {{ joint = [45, 0, 0] }}", InputError, r"sensor 1 \(C1\) .* a contact-spiral is not stretched by a joint"),
        (f"{STRAIN}pose = {{ along = [1, 0, 0] }}", InputError, "give the joint too"),
        (f"{STRAIN}pose = {{ joint = [45, 0, 0], along = [0, 0, 0] }}", InputError, r"along is \[0, 0, 0\], which is no direction"),
        (f"{STRAIN}pose = {{ joint = [45, 0] }}", InputError, r"joint is \[45, 0\]; it must be \[x, y, z\]"),
        (f'{SPIRAL}pose = {{ facing = "dorsal" }}', InputError, r"facing is 'dorsal'; it must be \[x, y, z\]"),
        (f"{SPIRAL}pose = {{ facing = [0, 0, 1], x = 3 }}", InputError, "unknown field 'x'"),
        (f"{STRAIN}pose = {{ joint = [4500, 0, 0] }}", InputError, r"the point is 4\.41e\+03 mm from the object"),
        (f"{STRAIN}pose = {{ joint = [2, 0, 0], along = [1, 0, 0] }}", RefusedError, "does not fit across the joint; make it smaller"),
        (f"{SPIRAL}pose = {{ facing = [1, 0, 0] }}", RefusedError, "it fits, but not where the surface faces"),
        (f"{SPIRAL.replace('s = 12', 's = 80')}pose = {{ facing = [0, 0, 1] }}", RefusedError, "it fits on no piece"),
    ],
)
def test_what_cannot_be_had_is_named(tmp_path: Path, text: str, error: type, says: str) -> None:
    with pytest.raises(error, match=says):
        placed(tmp_path, text)
