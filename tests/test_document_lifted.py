"""Sensors that a cut took off are in the document, and what is wrong with them there is one line."""

import io
import json
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skinfab.document import load_skin, save_skin
from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.lifted import Lifted, in_line, off_words
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source

V = np.array([[0.0, 0, 0], [60, 0, 0], [60, 60, 0], [0, 60, 0], [60, 60, 60], [0, 60, 60]])
F = np.array([[0, 1, 2], [0, 2, 3], [3, 2, 4], [3, 4, 5]])


def piece(id: str, faces: list[int]) -> Piece:
    vertices, inverse = np.unique(F[faces], return_inverse=True)
    return Piece(id, np.array(faces), vertices, inverse.reshape(-1, 3), V[vertices, :2] + V[vertices, 2:])


def sensor(id: str, on: str, channel: int) -> Sensor:
    return Sensor(id, on, make_pattern("contact-spiral", {"s": 20}), 10.0 / 3, 7.0, 0.5, channel)


@pytest.fixture
def skin() -> Skin:
    """One piece with a sensor; two sensors are off that lay on another one together, and one that lay on a third."""
    low, all_of_it, high = piece("P1", [0, 1]), piece("P1", [0, 1, 2, 3]), piece("P7", [2, 3])
    off = (Lifted(sensor("C1", "P1", 0), all_of_it), Lifted(sensor("C2", "P1", 1), all_of_it, place=1))
    return Skin(
        Mesh(V, F, "lid"),
        Source("lid.obj", "ab" * 32, "mm", 1.0),
        np.array([[2, 3]]),
        (low,),
        (sensor("C3", "P1", 2),),
        lifted=(*off, Lifted(sensor("c3", "P7", 2), high, place=3)),
    )


def test_they_are_kept_byte_for_byte(skin: Skin, tmp_path: Path) -> None:
    save_skin(skin, tmp_path / "a.skin")
    back = load_skin(tmp_path / "a.skin")
    for one, two in zip(skin.lifted, back.lifted, strict=True):
        assert (one.sensor, one.place) == (two.sensor, two.place)
        for field in ("id", "faces", "vertices", "F", "UV"):
            np.testing.assert_array_equal(getattr(one.piece, field), getattr(two.piece, field))
    assert back.lifted[0].piece is back.lifted[1].piece is not back.lifted[2].piece
    assert back.sensors == skin.sensors and [p.id for p in back.pieces] == ["P1"] and len(back.pieces[0].faces) == 2
    save_skin(back, tmp_path / "b.skin")
    assert (tmp_path / "a.skin").read_bytes() == (tmp_path / "b.skin").read_bytes()


def test_documents_that_know_none_open(skin: Skin, tmp_path: Path) -> None:
    """What earlier releases wrote is what is written where no sensor is off."""
    save_skin(replace(skin, lifted=()), tmp_path / "old.skin")
    with zipfile.ZipFile(tmp_path / "old.skin") as archive:
        assert "lifted" not in json.loads(archive.read("skin.json")) and not any("lifted" in name for name in archive.namelist())
    assert load_skin(tmp_path / "old.skin").lifted == ()


def changed(path: Path, change: Callable[[dict[str, Any]], object], member: str = "", array: np.ndarray | None = None) -> None:
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    data = json.loads(members["skin.json"])
    change(data)
    members["skin.json"] = json.dumps(data).encode()
    if array is not None:
        stream = io.BytesIO()
        np.save(stream, array)
        members[member] = stream.getvalue()
    elif member:
        del members[member]
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda d: d.update(lifted=[]), r"lifted is '\[\]'; it must be a dict"),
        (lambda d: d["lifted"].pop("pieces"), "skin.json, lifted: pieces is missing"),
        (lambda d: d["lifted"].update(sensors=[3]), r"skin.json, lifted: sensors\[0\] is '3'; it must be an object"),
        (lambda d: d["lifted"]["sensors"][0].pop("lay_on"), "lay_on is missing"),
        (lambda d: d["lifted"]["sensors"][0].update(lay_on=2), "lay_on is 2; there are 2 pieces, counted from 0"),
        (lambda d: d["lifted"]["sensors"][0].update(lay_on=-1), "lay_on is -1"),
        (lambda d: d["lifted"]["sensors"][0].update(lay_on=1), "lies on piece 'P1'; there is no such piece"),
        (lambda d: d["lifted"]["sensors"][2].update(place=-1), "place is -1; it must be zero or more"),
        (lambda d: d["lifted"]["sensors"][2].update(place=10**30), "place is 1000"),
        (lambda d: d["lifted"]["sensors"][2].update(place=1.5), "place is '1.5'; it must be a int"),
        (lambda d: d["lifted"]["sensors"][2].update(kind="zigzag"), "no pattern of kind 'zigzag'"),
        (lambda d: d["lifted"]["sensors"][2].update(x_mm=float("inf")), "Infinity|finite"),
        (lambda d: d["lifted"]["pieces"][0].update(id="../P1"), "an id has 1 to 64 letters"),
        (lambda d: d["lifted"]["pieces"][0].update(n_faces=10**12), "skin.json says"),
    ],
)
def test_what_contradicts_itself_is_refused(skin: Skin, change: Callable[[dict[str, Any]], object], says: str, tmp_path: Path) -> None:
    save_skin(skin, tmp_path / "a.skin")
    changed(tmp_path / "a.skin", change)
    with pytest.raises(InputError, match=says) as caught:
        load_skin(tmp_path / "a.skin")
    assert str(caught.value).startswith(str(tmp_path)) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("member", "array", "says"),
    [
        ("lifted/0/faces.npy", np.array([0, 1, 2, 4]), "lifted/0/faces.npy points at number 4; there are 4"),
        ("lifted/0/faces.npy", np.array([1, 0, 2, 3]), "piece P1 does not match the mesh"),
        ("lifted/1/UV.npy", np.full((4, 2), np.nan), "not finite"),
        ("lifted/1/UV.npy", None, "lifted/1/UV.npy is missing"),
    ],
)
def test_damaged_pieces_are_refused(skin: Skin, member: str, array: np.ndarray | None, says: str, tmp_path: Path) -> None:
    save_skin(skin, tmp_path / "a.skin")
    changed(tmp_path / "a.skin", lambda d: None, member, array)
    with pytest.raises(InputError, match=says):
        load_skin(tmp_path / "a.skin")


def test_a_piece_with_a_face_twice_is_refused(skin: Skin, tmp_path: Path) -> None:
    low = skin.pieces[0]
    twice = Piece("P1", low.faces[[0, 0]], low.vertices, low.F[[0, 0]], low.UV)
    save_skin(replace(skin, lifted=(replace(skin.lifted[0], piece=twice),)), tmp_path / "a.skin")
    with pytest.raises(InputError, match="a piece has a face of the mesh twice"):
        load_skin(tmp_path / "a.skin")


def test_the_list_has_them_where_they_were(skin: Skin) -> None:
    (there,), (first, second, fourth) = skin.sensors, skin.lifted
    assert in_line(skin.sensors, (fourth, second, first)) == [first, second, there, fourth]
    assert in_line([], [replace(fourth, place=99)]) != []


def test_one_sentence_says_how_many_are_off(skin: Skin) -> None:
    (text,) = off_words(skin.lifted)
    assert text.startswith(
        "3 sensors are off (C1, C2, c3) and are not printed: a cut took their spots; in the window, cut so that they lie"
    )
    assert off_words(skin.lifted[:1])[0].startswith("1 sensor is off (C1) and is not printed: a cut took its spot;")
