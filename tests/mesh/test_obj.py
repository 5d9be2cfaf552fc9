"""The bulk reader against the careful one, the forms OBJ allows, and errors that name their line."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinfab.errors import InputError
from skinfab.mesh import obj
from skinfab.mesh.obj import parse_obj

CORNER = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"

numbers = st.floats(-1e6, 1e6).map(repr) | st.integers(-999, 999).map(str) | st.sampled_from(["1.", ".5", "-.5e-3", "+2E+2"])
vertices = st.builds(lambda xyz, extra: "v " + " ".join(xyz) + extra, st.tuples(numbers, numbers, numbers), st.just(""))
indices = st.integers(1, 4).map(str) | st.integers(-4, -1).map(str)
corners = st.builds(lambda i, tail: i + tail, indices, st.sampled_from(["", "/1", "/1/2", "//3"]))
faces = st.lists(corners, min_size=3, max_size=4).map(lambda words: "f " + " ".join(words))
others = st.sampled_from(["", "# v 1 2", "vn 0 0 1", "vt 0.5 0.5", "g body", "usemtl x", "s off", "vp 1", "l 1 2"])
texts = st.tuples(st.lists(vertices, min_size=4), st.lists(faces | others | vertices), st.sampled_from(["\n", "\r\n", " \n"])).map(
    lambda parts: (parts[2].join([*parts[0], *parts[1]]) + parts[2]).encode()
)


@given(texts)
def test_bulk_and_careful_readers_agree(text: bytes) -> None:
    bulk, careful = obj._read_bulk(text), obj._read_lines(text, "t.obj")
    assert bulk is not None
    for name in ("V", "vertex_line", "corners", "sizes", "face_line", "vertices_before"):
        np.testing.assert_array_equal(getattr(bulk, name), getattr(careful, name), err_msg=name)


@given(
    st.binary(max_size=300)
    | st.lists(st.sampled_from([b"v", b"f", b" ", b"\n", b"1", b"/", b"-", b".", b"e", b"nan", b"\\"])).map(b"".join)
)
def test_any_bytes_give_a_mesh_or_one_line(data: bytes) -> None:
    said, V, F = "", np.zeros((1, 3)), np.zeros((1, 3), int)
    try:
        V, F = parse_obj(data, "x.obj")
    except InputError as fault:
        said = str(fault)
    assert "\n" not in said and (not said or "x.obj" in said)
    assert np.isfinite(V).all() and F.min() >= 0 and F.max() < len(V)


@pytest.mark.parametrize(
    "text",
    [
        CORNER + b"f 1 2 3\n",
        CORNER + b"f 1/1 2/2 3/3\n",
        CORNER + b"f 1//9 2//9 3//9\n",
        CORNER + b"f 1/7/9 2//9 3/7\n",
        CORNER + b"f -4 -3 -2",
        CORNER + b"f 1 2 3 # a comment\n",
        CORNER.replace(b"\n", b"\r\n") + b"f 1 2 3\r\n",
        CORNER.replace(b"\n", b"\r") + b"f 1 2 3\r",
        CORNER.replace(b"v ", b"  v\t") + b"\tf 1\t2   3\n",
        CORNER.replace(b"\n", b" .5 .5 .5\n") + b"f 1 2 3\n",
        CORNER.replace(b"\n", b" 1\n") + b"f 1 2 3\n",
        CORNER + b"f 1 \\\n2 3\n",
        b"\xef\xbb\xbf# byte order mark\n" + CORNER + b"f 1 2 3\n",
        b"f 1 2 3\n" + CORNER,
    ],
)
def test_forms_of_the_same_triangle(text: bytes) -> None:
    V, F = parse_obj(text, "t.obj")
    assert V.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    assert F.tolist() == [[0, 1, 2]]


def test_negative_indices_count_from_where_the_face_stands() -> None:
    text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nf -1 -2 -3\n"
    assert parse_obj(text, "t.obj")[1].tolist() == [[0, 1, 2], [3, 2, 1]]


def test_errors_name_the_line_after_other_lines() -> None:
    text = b"# one\nvn 0 0 1\n" + CORNER + b"\nf 1 2 3\nf 1 2 five\n"
    with pytest.raises(InputError, match=r"t\.obj line 9: 'five' is no vertex number"):
        parse_obj(text, "t.obj")
