"""The skin document: save(load) is the identity, the bytes are the same every time, and bad files are refused in one line."""

import io
import json
import math
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from documents import assert_refused, assert_same, edit_json, grid_skin, npy, rewrite
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.document import load_skin, save_skin
from skinfab.errors import InputError, RefusedError
from skinfab.patterns.registry import make_pattern
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor

FINITE = st.floats(-1e6, 1e6, allow_nan=False)


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


def test_a_repacked_document_still_opens(saved: Path) -> None:
    before = load_skin(saved)
    rewrite(saved, lambda name, content: content, method=zipfile.ZIP_DEFLATED)
    assert_same(load_skin(saved), before)


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
