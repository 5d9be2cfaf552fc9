"""Cuts by hand: read with every fault named, honoured to the edge, checked like any others."""

import re

import numpy as np
import pytest
import shapes
from hypothesis import given, settings
from hypothesis import strategies as st

from skinfab.errors import InputError, RefusedError
from skinfab.mesh.model import Mesh
from skinfab.seams.cut import open_pieces
from skinfab.seams.judge import Limits
from skinfab.seams.manual import completed, cut_along, numbers_in, read_cuts, seams_by_hand
from skinfab.seams.weights import dihedral_angles


def test_reads_paths_comments_and_commas(tmp_path) -> None:
    file = tmp_path / "cuts.txt"
    file.write_text("# round the wrist\n12 87 140 12\n\n140,522, 3   # up the back\n")
    assert [p.tolist() for p in read_cuts(file, 523)] == [[12, 87, 140, 12], [140, 522, 3]]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("1 2\n3 x\n", r"line 2: '3 x' is not a list of vertex numbers"),
        ("1 2.5\n", r"line 1: '1 2\.5' is not a list"),
        ("# a\n1 10\n", r"line 2: vertex 10 does not exist; the mesh has vertices 0 to 9"),
        ("-1 2\n", r"line 1: vertex -1 does not exist"),
        ("99999999999999999999999 1\n", r"line 1: .* is not a list"),
        ("1 2\n5\n", r"line 2: a path needs at least two vertices"),
        ("# nothing\n\n", r"holds no vertex path"),
        ("", r"holds no vertex path"),
    ],
)
def test_faults_are_named_by_line(tmp_path, text: str, says: str) -> None:
    file = tmp_path / "cuts.txt"
    file.write_text(text)
    with pytest.raises(InputError, match=f"cuts.txt.*{says}"):
        read_cuts(file, 10)


def test_files_that_are_none(tmp_path) -> None:
    with pytest.raises(InputError, match=r"cannot read the cuts file .*nowhere"):
        read_cuts(tmp_path / "nowhere", 10)
    with pytest.raises(InputError, match="cannot read the cuts file"):
        read_cuts(tmp_path, 10)
    (tmp_path / "binary").write_bytes(b"\xff\xfe\x00\x81")
    with pytest.raises(InputError, match="not a text file"):
        read_cuts(tmp_path / "binary", 10)
    with (tmp_path / "huge").open("wb") as file:
        file.truncate(50_000_001)
    with pytest.raises(InputError, match="too large"):
        read_cuts(tmp_path / "huge", 10)


@settings(max_examples=60, deadline=None)
@given(st.binary(max_size=60))
def test_any_bytes_give_paths_or_one_line(tmp_path_factory, data: bytes) -> None:
    file = tmp_path_factory.getbasetemp() / "any"
    file.write_bytes(data)
    try:
        paths = read_cuts(file, 100)
    except InputError as error:
        paths = []
        says = str(error)
    else:
        says = "paths"
        assert paths
    assert len(says.splitlines()) == 1
    assert all(len(p) >= 2 and p.min() >= 0 and p.max() < 100 for p in paths)


def square() -> Mesh:
    return Mesh(*shapes.grid(8, 8))


def test_cuts_just_the_edges_of_the_path() -> None:
    mesh = square()
    path = [40, 41, 42, 51, 60]
    cut = cut_along(mesh, [mesh.V[path]])
    want = mesh.topology.edge_ids(np.stack([path[:-1], path[1:]], axis=1))
    assert np.flatnonzero(cut).tolist() == sorted(want.tolist())
    # Points a little off, as another export of the mesh has them, and the same vertex twice, change nothing.
    near = mesh.V[[40, 41, 41, 42, 51, 60]] + 0.01
    np.testing.assert_array_equal(cut_along(mesh, [near]), cut)


def test_joins_far_vertices_by_the_shortest_way() -> None:
    mesh = square()
    cut = cut_along(mesh, [mesh.V[[36, 44]], mesh.V[[4, 76]]])  # across and up the middle
    x, y = mesh.V[mesh.topology.E[cut]].transpose(2, 0, 1)[:2]
    assert cut.sum() == 16 and (np.isclose(y, 0.5).all(axis=1) | np.isclose(x, 0.5).all(axis=1)).all()
    assert len(open_pieces(mesh, cut)) == 4


def test_far_vertices_are_joined_along_creases() -> None:
    """From corner to corner of a cube's side: along two edges, though the way across is shorter."""
    mesh = Mesh(*shapes.cube(4))
    corners = np.array([[0.0, 0, 0], [1, 1, 0]])
    cut = cut_along(mesh, [corners])
    assert mesh.edge_lengths[cut].sum() == pytest.approx(2)
    np.testing.assert_allclose(dihedral_angles(mesh)[cut], np.pi / 2)


def test_other_components_are_out_of_reach() -> None:
    V, F = shapes.grid(2, 2)
    mesh = Mesh(np.vstack([V, V + 9]), np.vstack([F, F + len(V)]))
    with pytest.raises(InputError, match="cut 2: vertices 0 and 17 lie on different components"):
        cut_along(mesh, [V[:2], mesh.V[[0, 17]]])


def test_seams_are_honoured_to_the_edge() -> None:
    mesh = Mesh(*shapes.cylinder_sheet(24, 10))
    middle = np.arange(5 * 25, 6 * 25)
    cut = cut_along(mesh, [mesh.V[middle[[0, 12, 24]]]])
    seams = seams_by_hand(mesh, cut, Limits(mean=4.0001))
    np.testing.assert_array_equal(seams.cut, cut)
    assert [len(p.faces) for p, _ in seams.pieces] == [240, 240] and all(v.accepted for _, v in seams.pieces)


@pytest.mark.parametrize(
    ("surface", "says"),
    [
        (shapes.sphere(), r"leave piece 1 \(320 faces\) closed; cut it open, such as along \d+ .*\d+, or add --complete"),
        (shapes.holed(), r"leave piece 1 \(284 faces\) with 3 boundary loops; cut from one loop to the other"),
        ((shapes.torus()[0], np.delete(shapes.torus()[1], 7, axis=0)), r"with a handle \(Euler number -1\); cut through the handle"),
    ],
    ids=["closed", "holes", "handle"],
)
def test_pieces_that_are_no_disks_are_named(surface, says: str) -> None:
    mesh = Mesh(*surface)
    with pytest.raises(InputError, match=says):
        seams_by_hand(mesh, np.zeros(len(mesh.topology.E), dtype=bool), Limits())


@pytest.mark.parametrize(
    ("surface", "limits", "says"),
    [
        (shapes.cap(), Limits(), r"piece 1 \(600 faces\) has mean d 4\.\d+, over the bound 4.05"),
        (shapes.cap(), Limits(mean=9, p99=4.1), r"has a p99 of d of 4\.\d+, over the bound 4.1 \(raise --max-p99 to allow it\)"),
        (shapes.helicoid(), Limits(mean=4.001), r"overlaps itself by 4\.52 mm\^2"),
        (
            shapes.grid(9, 1, lambda s, t: np.stack([90 * s, 5 * t, 0 * s], axis=1)),
            Limits(size=(50, 40)),
            r"is 90 x 5 mm flat .* bed \(50 x 40 mm\)",
        ),
    ],
    ids=["distorted", "hot spots", "overlapping", "large"],
)
def test_pieces_that_break_a_limit_are_refused(surface, limits: Limits, says: str) -> None:
    mesh = Mesh(*surface)
    with pytest.raises(RefusedError, match=says):
        seams_by_hand(mesh, np.zeros(len(mesh.topology.E), dtype=bool), limits)


def bumpy() -> Mesh:
    V, F = shapes.sphere(2)
    return Mesh(V * (10 + np.sin(3 * V[:, :1]) + V[:, 1:2] ** 2), F)


@pytest.mark.parametrize(
    ("mesh", "limits", "pieces"),
    [
        (bumpy(), Limits(), 1),
        (Mesh(*shapes.torus(3, 1, 24, 10)), Limits(), 1),
        (Mesh(*shapes.holed()), Limits(), 1),
        (Mesh(*shapes.grid(9, 1, lambda s, t: np.stack([90 * s, 5 * t, 0 * s], axis=1))), Limits(size=(50, 40)), 3),
        (
            Mesh(
                *shapes.grid(
                    60, 8, lambda s, t: np.stack([60 * s, (2 * t - 1) * (6 - 5 * np.exp(-(((s - 0.4) / 0.08) ** 2))), 0 * s], axis=1)
                )
            ),
            Limits(neck=4),
            2,
        ),
    ],
    ids=["closed", "handle", "holes", "large", "neck"],
)
def test_who_does_what_the_errors_say_gets_there(mesh: Mesh, limits: Limits, pieces: int) -> None:
    """Each error names a path, in a user's own numbers; with those paths in the file the cuts are taken at last, and nothing else."""
    numbers = np.random.default_rng(0).permutation(len(mesh.V))
    vertex = np.argsort(numbers)
    lines: list[str] = []
    for _ in range(20):
        paths = [mesh.V[vertex[list(map(int, line.split()))]] for line in lines]
        cut = cut_along(mesh, paths, numbers=numbers)
        try:
            seams = seams_by_hand(mesh, cut, limits, numbers=numbers)
            break
        except (InputError, RefusedError) as fault:
            said = str(fault)
        lines += re.findall(r"such as along ([\d and]+), or add --complete", said)[0].split(" and ")
    np.testing.assert_array_equal(seams.cut, cut)
    assert lines and len(seams.pieces) == pieces


def test_errors_name_the_cuts_about_the_piece() -> None:
    mesh = bumpy()
    half = mesh.V[mesh.F].mean(axis=1)[:, 2] > 0
    EF = mesh.topology.EF
    with pytest.raises(RefusedError) as fault:
        seams_by_hand(mesh, half[EF[:, 0]] != half[EF[:, 1]], Limits(mean=4.01))
    named = re.search(
        r"piece 1 \(\d+ faces within the cuts (\d+)-(\d+), (\d+)-(\d+), (\d+)-(\d+) and \d+ more\) has mean d", str(fault.value)
    )
    assert named
    pairs = np.array(named.groups(), dtype=int).reshape(-1, 2)
    edges = mesh.topology.edge_ids(pairs)
    assert (edges >= 0).all() and (half[EF[edges, 0]] != half[EF[edges, 1]]).all()
    assert (pairs[:-1, 1] == pairs[1:, 0]).all()  # in a row


def test_one_edge_alone_opens_nothing_and_is_named() -> None:
    mesh = Mesh(*shapes.sphere(1))
    with pytest.raises(InputError, match=r"closed \(a cut of one edge alone, 0-12, opens nothing\)"):
        seams_by_hand(mesh, cut_along(mesh, [mesh.V[[0, 12]]]), Limits())


def test_a_path_without_length_is_told() -> None:
    mesh = square()
    with pytest.raises(InputError, match="cut 1: all its points are vertex 40, so it has no length; give a path of two vertices or more"):
        cut_along(mesh, [mesh.V[[40, 40, 40]]])


def test_vertices_have_the_numbers_of_the_file() -> None:
    mesh = square()
    shuffled = np.random.default_rng(1).permutation(len(mesh.V))
    file = Mesh(np.vstack([mesh.V[shuffled], [9, 9, 9]]), np.argsort(shuffled)[mesh.F])
    np.testing.assert_array_equal(file.V[numbers_in(file, mesh)], mesh.V)


@pytest.mark.parametrize("aim", ["usual", "fewest"])
def test_completed_keeps_all_that_was_cut(aim) -> None:
    mesh = bumpy()
    mine = cut_along(mesh, [mesh.V[[0, 12, 42, 1]]])
    seams = completed(mesh, mine, Limits(), aim=aim)
    assert mine.any() and seams.cut[mine].all() and (seams.cut & ~mine).any()
    assert all(verdict.accepted for _, verdict in seams.pieces)
