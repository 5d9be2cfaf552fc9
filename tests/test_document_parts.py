"""Thickness and marks in a skin document: kept byte for byte, left out by older ones, refused in one line where they contradict it."""

import dataclasses
import json
import re
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from documents import assert_refused, assert_same, edit_json, grid_skin, npy, rewrite

from skinfab.document import load_skin, save_skin
from skinfab.errors import InputError
from skinfab.skin import SeamMarks, Skin


def thick_skin(**changes: object) -> Skin:
    """The grid flattened for a skin of 2.5 mm: the object itself lies lower."""
    skin = grid_skin(thickness=2.5, **changes)
    return dataclasses.replace(skin, object_V=skin.mesh.V - [0, 0, 2.5 * skin.neutral])


def test_a_thickness_is_kept_byte_for_byte(tmp_path: Path) -> None:
    skin = thick_skin(neutral=1 / 3)
    save_skin(skin, tmp_path / "a.skin")
    again = load_skin(tmp_path / "a.skin")
    assert_same(skin, again)
    assert again.object.V[0, 2] < again.mesh.V[0, 2] and again.flattened_at == skin.flattened_at == pytest.approx(2.5 / 3)
    save_skin(again, tmp_path / "b.skin")
    assert (tmp_path / "a.skin").read_bytes() == (tmp_path / "b.skin").read_bytes()


def test_documents_that_know_no_thickness_open(tmp_path: Path) -> None:
    """What releases before thickness wrote is what is written without one."""
    save_skin(grid_skin(), tmp_path / "old.skin")
    with zipfile.ZipFile(tmp_path / "old.skin") as archive:
        assert "thickness" not in json.loads(archive.read("skin.json")) and "object/V.npy" not in archive.namelist()
    old = load_skin(tmp_path / "old.skin")
    assert (old.thickness, old.neutral, old.flattened_at) == (0, 0.5, 0) and old.object is old.mesh


@pytest.mark.parametrize(
    ("entry", "says"),
    [
        ({"thickness_mm": -1.0, "neutral": 0.5}, "-1 mm with neutral 0.5; they must be 0 or more, and from 0 to 1"),
        ({"thickness_mm": 2.5, "neutral": 1.5}, "neutral 1.5"),
        ({"thickness_mm": 2.5}, "neutral is missing"),
        ({"thickness_mm": "2.5", "neutral": 0.5}, "must be a float"),
        (2.5, "must be a dict"),
    ],
)
def test_a_thickness_that_makes_no_sense(entry: object, says: str, tmp_path: Path) -> None:
    save_skin(thick_skin(), tmp_path / "a.skin")

    def change(name: str, content: bytes) -> bytes:
        return json.dumps(json.loads(content) | {"thickness": entry}).encode() if name == "skin.json" else content

    rewrite(tmp_path / "a.skin", change)
    with pytest.raises(InputError, match=re.escape(says)):
        load_skin(tmp_path / "a.skin")


def test_a_thickness_without_the_object(tmp_path: Path) -> None:
    save_skin(thick_skin(), tmp_path / "a.skin")
    rewrite(tmp_path / "a.skin", lambda name, content: None if name == "object/V.npy" else content)
    with pytest.raises(InputError, match="object/V"):
        load_skin(tmp_path / "a.skin")


def marked_skin() -> Skin:
    skin = grid_skin()
    preference = np.zeros(len(skin.mesh.F), dtype=np.int8)
    preference[[0, 3]] = 1, -1
    return dataclasses.replace(skin, marks=SeamMarks(skin.seams[:2], np.array([[0, 1]]), preference))


def test_marks_are_kept_byte_for_byte(tmp_path: Path) -> None:
    skin = marked_skin()
    save_skin(skin, tmp_path / "a.skin")
    back = load_skin(tmp_path / "a.skin")
    assert skin.marks is not None and back.marks is not None
    for field in ("locked", "forbidden", "preference"):
        np.testing.assert_array_equal(getattr(skin.marks, field), getattr(back.marks, field))
        assert getattr(skin.marks, field).dtype == getattr(back.marks, field).dtype
    save_skin(back, tmp_path / "b.skin")
    assert (tmp_path / "a.skin").read_bytes() == (tmp_path / "b.skin").read_bytes()


def test_documents_that_know_no_marks_open(tmp_path: Path) -> None:
    """What releases before marks wrote is what is written without any, and marks that say nothing are none."""
    skin = grid_skin()
    save_skin(skin, tmp_path / "a.skin")
    save_skin(dataclasses.replace(skin, marks=SeamMarks.none(len(skin.mesh.F))), tmp_path / "b.skin")
    assert (tmp_path / "a.skin").read_bytes() == (tmp_path / "b.skin").read_bytes()
    with zipfile.ZipFile(tmp_path / "a.skin") as archive:
        assert "marks" not in json.loads(archive.read("skin.json"))
        assert not any(name.startswith("marks/") for name in archive.namelist())
    assert load_skin(tmp_path / "a.skin").marks is None


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda d: d.update(marks=[]), "marks is .*; it must be a dict"),
        (lambda d: d["marks"].pop("n_locked"), "n_locked is missing"),
        (lambda d: d["marks"].update(n_locked=3), r"shape \(2, 2\); skin.json says \(3, 2\)"),
        (lambda d: d["marks"].update(n_forbidden=-1), "negative"),
        (lambda d: d["marks"].update(n_forbidden=10**12), "skin.json says"),
    ],
)
def test_marks_that_contradict_the_document(change: Callable[[dict], object], says: str, tmp_path: Path) -> None:  # type: ignore[type-arg]
    save_skin(marked_skin(), tmp_path / "a.skin")
    edit_json(tmp_path / "a.skin", change)
    assert_refused(tmp_path / "a.skin", says)


@pytest.mark.parametrize(
    ("member", "array", "says"),
    [
        ("marks/locked.npy", np.array([[0, 1], [0, 19]]), "no edge of the mesh joins"),
        ("marks/locked.npy", np.array([[0, 1], [0, 99]]), "no edge of the mesh joins"),
        ("marks/forbidden.npy", np.array([[-1, 1]]), "no edge of the mesh joins"),
        ("marks/forbidden.npy", np.array([[0.0, 1.0]]), "dtype '<f8'"),
        ("marks/preference.npy", np.full(24, 2), "other than -1"),
        ("marks/preference.npy", np.full(24, np.iinfo(np.int64).min), "other than -1"),
        ("marks/preference.npy", np.zeros(23, dtype=np.int64), "shape"),
        ("marks/preference.npy", None, "is missing"),
    ],
)
def test_damaged_marks_are_refused(member: str, array: np.ndarray | None, says: str, tmp_path: Path) -> None:
    save_skin(marked_skin(), tmp_path / "a.skin")
    rewrite(tmp_path / "a.skin", lambda name, old: (None if array is None else npy(array)) if name == member else old)
    assert_refused(tmp_path / "a.skin", says)
