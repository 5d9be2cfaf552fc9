"""The skin document: save(load) is the identity, the bytes are the same every time, and bad files are refused in one line."""

import dataclasses
import io
import json
import math
import re
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.document import load_skin, save_skin
from skinfab.errors import InputError, RefusedError
from skinfab.mesh.model import Mesh
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import SeamMarks, Skin, Source

FINITE = st.floats(-1e6, 1e6, allow_nan=False)


def grid_skin(*, columns: int = 4, rows: int = 3, sensors: tuple[Sensor, ...] = (), **changes: object) -> Skin:
    """A sheet of squares, cut into its left and its right half, each already flat."""
    x, y = np.meshgrid(np.arange(columns + 1) * 0.1, np.arange(rows + 1) / 3)
    V = np.c_[x.ravel(), y.ravel(), np.sin(x.ravel())]
    corner = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    F = np.vstack([np.c_[corner, corner + 1, corner + columns + 2], np.c_[corner, corner + columns + 2, corner + columns + 1]])
    left = np.tile(np.arange(columns) < columns // 2, rows * 2)
    pieces = []
    for k, mine in enumerate((left, ~left)):
        faces = np.flatnonzero(mine)
        vertices, inverse = np.unique(F[faces], return_inverse=True)
        pieces.append(Piece(f"P{k + 1}", faces, vertices, inverse.reshape(-1, 3), V[vertices, :2] + 1 / 7))
    seam = np.arange(rows + 1) * (columns + 1) + columns // 2
    source = Source("grid.obj", "ab" * 32, "in", 25.4)
    values = {"sensors": sensors, "seed": 7, "max_distortion": 4.1, **changes}
    return Skin(mesh=Mesh(V, F, "grid"), source=source, seams=np.c_[seam[:-1], seam[1:]], pieces=tuple(pieces), **values)  # type: ignore[arg-type]


def assert_same(one: Skin, two: Skin) -> None:
    np.testing.assert_array_equal(one.mesh.V, two.mesh.V)
    np.testing.assert_array_equal(one.mesh.F, two.mesh.F)
    np.testing.assert_array_equal(one.seams, two.seams)
    assert one.mesh.V.dtype == two.mesh.V.dtype and one.seams.dtype == two.seams.dtype
    for p, q in zip(one.pieces, two.pieces, strict=True):
        assert p.id == q.id
        for field in ("faces", "vertices", "F", "UV"):
            np.testing.assert_array_equal(getattr(p, field), getattr(q, field))
            assert getattr(p, field).dtype == getattr(q, field).dtype
    for field in ("source", "sensors", "printer", "material", "max_distortion", "seed"):
        assert getattr(one, field) == getattr(two, field)
    assert one.mesh.name == two.mesh.name
    np.testing.assert_array_equal(one.object.V, two.object.V)
    assert (one.thickness, one.neutral, one.flattened_at) == (two.thickness, two.neutral, two.flattened_at)


patterns = st.one_of(
    st.builds(lambda l1, b: make_pattern("strain-lines", {"l1": l1, "l2": l1 - 7.1, "b": b}), st.floats(40, 90), st.floats(6, 9)),
    st.builds(lambda s: make_pattern("contact-spiral", {"n": 3, "x": 1.7, "b": 1.5, "l": 3, "s": s}), st.floats(15, 45)),
)


@st.composite
def sensor_tuples(draw: st.DrawFn) -> tuple[Sensor, ...]:
    count = draw(st.integers(0, 4))
    return tuple(
        Sensor(f"S{k}", draw(st.sampled_from(["P1", "P2"])), draw(patterns), draw(FINITE), draw(FINITE), draw(FINITE), k)
        for k in range(count)
    )


@given(sensor_tuples(), st.integers(2, 9), st.integers(1, 5), st.floats(4, 6), st.integers(-(2**40), 2**40))
@settings(max_examples=40, deadline=None)
def test_loading_what_was_saved_is_the_identity(sensors: tuple[Sensor, ...], columns: int, rows: int, bound: float, seed: int) -> None:
    skin = grid_skin(columns=columns, rows=rows, sensors=sensors, max_distortion=bound, seed=seed, printer="p/ö.toml")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.skin"
        save_skin(skin, path)
        back = load_skin(path)
        assert_same(skin, back)
        save_skin(back, Path(folder) / "b.skin")
        assert path.read_bytes() == (Path(folder) / "b.skin").read_bytes()


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    path = tmp_path / "a.skin"
    pattern = make_pattern("strain-lines", {"l1": 60, "l2": 54, "b": 6})
    save_skin(grid_skin(sensors=(Sensor("S1", "P2", pattern, 1 / 3, 0.1, math.pi / 7, 0),)), path)
    return path


def test_any_zip_tool_and_numpy_read_it(saved: Path) -> None:
    listed = subprocess.run([sys.executable, "-m", "zipfile", "-t", str(saved)], capture_output=True, text=True, check=True)
    assert "Done testing" in listed.stdout
    with zipfile.ZipFile(saved) as archive:
        assert archive.namelist()[:3] == ["skin.json", "mesh/V.npy", "mesh/F.npy"]
        assert {info.date_time for info in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        data = json.loads(archive.read("skin.json"))
        V = np.load(io.BytesIO(archive.read("mesh/V.npy")), allow_pickle=False)
    assert data["sensors"][0]["params"]["l1"] == 60 and data["sensors"][0]["angle_rad"] == math.pi / 7
    np.testing.assert_array_equal(V, grid_skin().mesh.V)


def rewrite(path: Path, change: Callable[[str, bytes], bytes | None], *, method: int = zipfile.ZIP_STORED) -> None:
    """The same zip with members changed (None: left out)."""
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w", method) as archive:
        for name, content in members.items():
            if (new := change(name, content)) is not None:
                archive.writestr(name, new)


def edit_json(path: Path, change: Callable[[dict], object]) -> None:  # type: ignore[type-arg]
    def edited(name: str, content: bytes) -> bytes:
        if name != "skin.json":
            return content
        data = json.loads(content)
        change(data)
        return json.dumps(data).encode()

    rewrite(path, edited)


def assert_refused(path: Path, says: str) -> None:
    with pytest.raises(InputError, match=says) as caught:
        load_skin(path)
    message = str(caught.value)
    assert message.startswith(str(path)) and "\n" not in message and len(message) < 400


def test_a_repacked_document_still_opens(saved: Path) -> None:
    before = load_skin(saved)
    rewrite(saved, lambda name, content: content, method=zipfile.ZIP_DEFLATED)
    assert_same(load_skin(saved), before)


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


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda d: d.update(schema=2), "schema 2, this skinfab reads up to 1; install a newer"),
        (lambda d: d.update(schema="1"), "schema is '1'; it must be a int"),
        (lambda d: d.update(schema=True), "schema is 'True'"),
        (lambda d: d.pop("seed"), "seed is missing"),
        (lambda d: d.update(units={"length": "in", "angle": "rad"}), "they must be mm and rad"),
        (lambda d: d.update(max_distortion=float("nan")), "NaN is not a number"),
        (lambda d: d["mesh"].update(n_faces=10**15), "shape"),
        (lambda d: d["mesh"].update(n_vertices=-5), "negative"),
        (lambda d: d["mesh"].update(name="../../evil"), "cannot be part of a file name"),
        (lambda d: d["pieces"][0].update(id="../P1"), "an id has 1 to 64 letters"),
        (lambda d: d["pieces"][1].update(id="p1"), "two pieces have the same id"),
        (lambda d: d["pieces"].append(dict(d["pieces"][0], id="P3")), "pieces/2/faces.npy is missing"),
        (lambda d: d["pieces"].__setitem__(0, 3), "must be an object"),
        (lambda d: d["sensors"][0].update(piece="P9"), "there is no such piece"),
        (lambda d: d["sensors"][0].update(kind="zigzag"), "no pattern of kind 'zigzag'"),
        (lambda d: d["sensors"][0]["params"].update(l9=1), "unknown parameter 'l9'"),
        (lambda d: d["sensors"][0]["params"].update(b=1.0), "b is 1"),
        (lambda d: d["sensors"][0].update(x_mm="0"), "x_mm is '0'; it must be a float"),
        (lambda d: d["sensors"][0].update(x_mm=1e999), "Infinity|finite"),
        (lambda d: d["sensors"][0].update(channel=-1), "channel is -1"),
        (lambda d: d["sensors"].append(d["sensors"][0]), "two sensors have the same id"),
    ],
)
def test_a_document_that_contradicts_itself(saved: Path, change: Callable[[dict], object], says: str) -> None:  # type: ignore[type-arg]
    edit_json(saved, change)
    assert_refused(saved, says)


def npy(array: np.ndarray, **options: object) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array, **options)  # type: ignore[arg-type]
    return stream.getvalue()


def with_header(header: str, data: bytes = b"") -> bytes:
    text = header.encode() + b"\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text + data


GOOD = grid_skin()
BAD_V = GOOD.mesh.V.copy()
BAD_V[3, 1] = np.nan


@pytest.mark.parametrize(
    ("member", "content", "says"),
    [
        ("mesh/V.npy", npy(GOOD.mesh.V.astype(np.float32)), "dtype '<f4'"),
        ("mesh/V.npy", npy(GOOD.mesh.V.astype(">f8")), "dtype '>f8'"),
        ("mesh/V.npy", npy(np.asfortranarray(GOOD.mesh.V)), "Fortran order"),
        ("mesh/V.npy", npy(GOOD.mesh.V[:-1]), r"shape \(19, 3\); skin.json says \(20, 3\)"),
        ("mesh/V.npy", npy(GOOD.mesh.V.ravel()), "shape"),
        ("mesh/V.npy", npy(BAD_V), "not finite"),
        ("mesh/V.npy", npy(GOOD.mesh.V)[:-8], "bytes of data"),
        ("mesh/V.npy", npy(GOOD.mesh.V) + b"more", "bytes of data"),
        ("mesh/V.npy", b"", "not a .npy array"),
        ("mesh/V.npy", b"\x93NUMPY\x01\x00\xff\xff{   ", "header that is not of a plain array"),
        ("mesh/V.npy", b"\x93NUMPY\x09\x00\x10\x00" + b" " * 20, "npy version 9"),
        ("mesh/V.npy", b"\x93NUMPY\x02\x00\xff\xff\xff\xff" + b"(" * 500, "header that is not of a plain array"),
        ("mesh/V.npy", npy(np.array([{}] * 4, dtype=object), allow_pickle=True), "dtype '.O'"),
        ("mesh/V.npy", npy(np.zeros(4, dtype=[("x", "f8")])), "header that is not of a plain array"),
        ("mesh/V.npy", with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (9999999999999, 3), }"), "skin.json says"),
        ("mesh/V.npy", with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (" + "(" * 400 + "), }"), "not of a plain array"),
        ("mesh/V.npy", with_header("{'descr': '<f8', 'fortran_order': False, 'shape': (-20, -3), }"), "not of a plain array"),
        ("mesh/V.npy", with_header("__import__('os').system('true')"), "not of a plain array"),
        ("mesh/F.npy", npy(np.where(GOOD.mesh.F == 5, 20, GOOD.mesh.F)), "points at number 20; there are 20"),
        ("mesh/F.npy", npy(np.where(GOOD.mesh.F == 5, -1, GOOD.mesh.F)), "points at number -1"),
        ("seams.npy", npy(GOOD.seams + 17), "points at number"),
        ("pieces/0/faces.npy", npy(GOOD.pieces[1].faces), "does not match the mesh"),
        ("pieces/0/F.npy", npy(np.ascontiguousarray(GOOD.pieces[0].F[:, [1, 0, 2]])), "does not match the mesh"),
        ("pieces/0/F.npy", npy(GOOD.pieces[0].F + 1), "points at number"),
        ("pieces/1/UV.npy", npy(GOOD.pieces[1].UV * np.inf), "not finite"),
        ("pieces/1/UV.npy", None, "pieces/1/UV.npy is missing"),
        ("skin.json", None, "skin.json is missing; not a skin document"),
        ("skin.json", b"[" * 200_000, "not JSON"),
        ("skin.json", b"[]", "not a JSON object"),
        ("skin.json", b'{"schema": ' + b"9" * 10_000 + b"}", "not JSON"),
        ("skin.json", b"\xff\xfe\xfd", "not JSON"),
    ],
)
def test_a_damaged_member_is_refused(saved: Path, member: str, content: bytes | None, says: str) -> None:
    rewrite(saved, lambda name, old: content if name == member else old)
    assert_refused(saved, says)


@pytest.mark.parametrize("name", ["../outside", "/etc/passwd", "a/../../b", "..\\outside", "C:/x"])
def test_a_path_outside_is_refused(saved: Path, name: str) -> None:
    with zipfile.ZipFile(saved, "a") as archive:
        archive.writestr(name, b"x")
    assert_refused(saved, "a path outside the document")


def test_a_name_that_comes_twice_is_refused(saved: Path) -> None:
    with zipfile.ZipFile(saved, "a") as archive, pytest.warns(UserWarning, match="Duplicate name"):
        archive.writestr("skin.json", b"{}")
    assert_refused(saved, "'skin.json' twice")


@pytest.mark.parametrize("member", ["skin.json", "mesh/V.npy", "more.bin"])
def test_a_zip_bomb_is_refused_before_it_is_unpacked(saved: Path, member: str) -> None:
    rewrite(saved, lambda name, old: old if name != member else None)
    with zipfile.ZipFile(saved, "a", zipfile.ZIP_DEFLATED) as archive, archive.open(member, "w") as stream:
        for _ in range(200):
            stream.write(bytes(1_000_000))
    program = f"""
import resource
from skinfab.document import load_skin
import numpy.random
resource.setrlimit(resource.RLIMIT_DATA, (100_000_000, 100_000_000))  # unpacking it would end in MemoryError
try:
    load_skin({str(saved)!r})
except ValueError as fault:
    print(fault)
"""
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert "refused as a zip bomb" in said.stdout, said.stderr


def test_a_directory_that_lies_about_sizes_is_refused(saved: Path) -> None:
    rewrite(saved, lambda name, old: old, method=zipfile.ZIP_DEFLATED)
    data = bytearray(saved.read_bytes())
    entry = data.rindex(b"mesh/V.npy") - 46
    assert data[entry : entry + 4] == b"PK\x01\x02"
    data[entry + 24 : entry + 28] = (300).to_bytes(4, "little")  # uncompressed size: less than it unpacks to
    saved.write_bytes(data)
    assert_refused(saved, "mesh/V.npy")


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_methods_with_memory_of_their_own_are_refused(saved: Path, method: int) -> None:
    rewrite(saved, lambda name, old: old, method=method)
    assert_refused(saved, "only stored and deflated")


def test_every_truncation_is_refused(saved: Path) -> None:
    whole = saved.read_bytes()
    for size in [0, 1, 4, 30, *range(100, len(whole), 211), len(whole) - 1]:
        saved.write_bytes(whole[:size])
        assert_refused(saved, "not a whole skin document")


@given(st.data())
@settings(max_examples=150, deadline=None)
def test_fuzzed_bytes_load_or_are_refused(data: st.DataObject) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.skin"
        save_skin(grid_skin(columns=2, rows=1), path)
        content = bytearray(path.read_bytes())
        for _ in range(data.draw(st.integers(1, 4))):
            content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
        path.write_bytes(content)
        with suppress(InputError):  # any other exception fails the test
            load_skin(path)


@pytest.mark.parametrize("content", [b"", b"v 0 0 0\nf 1 1 1\n", b"PK\x03\x04" + bytes(100), bytes(1000)])
def test_not_a_zip(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "a.skin").write_bytes(content)
    assert_refused(tmp_path / "a.skin", "not a whole skin document")


def test_no_file_and_a_folder(tmp_path: Path) -> None:
    assert_refused(tmp_path / "none.skin", "no such file")
    assert_refused(tmp_path, "is a folder")


def test_a_skin_with_nan_is_not_saved_over_a_good_one(saved: Path) -> None:
    before = saved.read_bytes()
    piece = GOOD.pieces[0]
    bad = grid_skin()
    object.__setattr__(bad, "pieces", (Piece("P1", piece.faces, piece.vertices, piece.F, piece.UV * np.nan),))
    with pytest.raises(RefusedError, match="not finite"):
        save_skin(bad, saved)
    assert saved.read_bytes() == before and len(list(saved.parent.iterdir())) == 1
