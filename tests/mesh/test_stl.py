"""STL: text and binary say the same; equal corners are one vertex."""

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from skinfab.errors import InputError
from skinfab.mesh.stl import parse_stl, weld

TETRAHEDRON = np.array([[0, 0, 0], [20, 0, 0], [0, 20, 0], [0, 0, 20.5]])[[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]]


def binary(triangles: np.ndarray, header: bytes = b"") -> bytes:
    records = b"".join(struct.pack("<12fH", 0, 0, 0, *t.ravel(), 0) for t in triangles)
    return header.ljust(80, b"\0") + struct.pack("<I", len(triangles)) + records


def text(triangles: np.ndarray) -> bytes:
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join("vertex {} {} {}\n".format(*p) for p in t) + "endloop\nendfacet\n" for t in triangles
    )
    return f"solid t\n{facets}endsolid t\n".encode()


@pytest.mark.parametrize(
    "data", [binary(TETRAHEDRON), binary(TETRAHEDRON, b"solid but binary"), text(TETRAHEDRON), binary(TETRAHEDRON) + b"more"]
)
def test_both_forms(data: bytes) -> None:
    V, F = parse_stl(data, "t.stl")
    assert V.shape == (4, 3)
    np.testing.assert_array_equal(V[F], TETRAHEDRON)


@given(arrays(np.float64, st.tuples(st.integers(1, 30), st.just(3)), elements=st.sampled_from([0.0, -0.0, 1.0, 2.0])))
def test_weld_is_exact(points: np.ndarray) -> None:
    V, index = weld(points)
    np.testing.assert_array_equal(V[index], points)
    assert len({tuple(v) for v in V.tolist()}) == len(V)
    seen = list(dict.fromkeys(index.tolist()))
    assert seen == list(range(len(V)))  # numbered by first appearance


@given(st.binary(max_size=400) | st.binary(max_size=200).map(lambda b: b"solid vertex " + b))
def test_any_bytes_give_a_mesh_or_one_line(data: bytes) -> None:
    said, faces = "", 1
    try:
        faces = len(parse_stl(data, "x.stl")[1])
    except InputError as fault:
        said = str(fault)
    assert "\n" not in said and faces
