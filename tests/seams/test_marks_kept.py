"""What a person marked holds whatever the automatic seams are for: locked stays, forbidden is never cut, preferences draw and repel."""

import re
from dataclasses import replace

import numpy as np
import pytest
import shapes

from skinfab.errors import RefusedError
from skinfab.mesh.model import Mesh
from skinfab.seams.auto import Aim, find_seams
from skinfab.seams.judge import Limits
from skinfab.seams.manual import cut_along
from skinfab.seams.rules import EdgeRules

LIMITS = Limits(mean=4.08)

all_aims = pytest.mark.parametrize("aim", ["fewest", "usual", "simplest"])


def bumpy(subdivisions: int = 2) -> Mesh:
    V, F = shapes.sphere(subdivisions)
    return Mesh(V * (10 + np.sin(3 * V[:, :1]) + V[:, 1:2] ** 2), F)


def marks(mesh: Mesh, seed: int) -> EdgeRules:
    """Two locked paths that may cross, end inside or close, and forbidden edges in two round patches and along a line."""
    rng = np.random.default_rng(seed)
    points = rng.choice(len(mesh.V), 8, replace=False)
    locked = cut_along(mesh, [mesh.V[points[:3]], mesh.V[points[[3, 4]]]])
    middle = mesh.V[mesh.topology.E].mean(axis=1)
    near = np.linalg.norm(middle[:, None] - mesh.V[points[5:7]], axis=2).min(axis=1) < 4
    forbidden = (near | cut_along(mesh, [mesh.V[points[[6, 7]]]])) & ~locked
    return EdgeRules(np.ones(len(locked)), locked, forbidden)


@all_aims
@pytest.mark.parametrize(("seed", "subdivisions"), [(0, 2), (1, 2), (2, 2), (0, 4)])
def test_locked_and_forbidden(aim: Aim, seed: int, subdivisions: int) -> None:
    """The finest by way of a coarse mesh, on which the marks have no exact likeness."""
    mesh = bumpy(subdivisions)
    rules = marks(mesh, seed)
    assert rules.locked.any() and rules.forbidden.any()
    seams = find_seams(mesh, LIMITS, rules=rules, aim=aim, neck=1.0)
    assert seams.cut[rules.locked].all() and not seams.cut[rules.forbidden].any()
    assert all(verdict.accepted for _, verdict in seams.pieces)
    assert sum(len(piece.faces) for piece, _ in seams.pieces) == len(mesh.F)


@all_aims
def test_what_cannot_be_is_refused_and_its_edges_named(aim: Aim) -> None:
    """Around a locked ring all is forbidden: the polar caps may not be cut any further, though they are far over the bound."""
    mesh = bumpy()
    EF = mesh.topology.EF
    above = mesh.V[mesh.F].mean(axis=1)[:, 2] > 0
    locked = above[EF[:, 0]] != above[EF[:, 1]]
    rules = EdgeRules(np.ones(len(locked)), locked, ~locked)
    with pytest.raises(RefusedError, match="allow some of them, such as") as fault:
        find_seams(mesh, Limits(mean=4.01), rules=rules, aim=aim)
    pairs = np.array(re.findall(r"(\d+)-(\d+)", str(fault.value)), dtype=int)
    edges = mesh.topology.edge_ids(pairs)
    assert 1 <= len(pairs) <= 3 and rules.forbidden[edges].all()
    assert re.search(r"\(they have mean d 4\.\d+, over the bound 4\.01\)|\(they are not open to a disk\)", str(fault.value))


@pytest.mark.parametrize("aim", ["fewest", "simplest"])
def test_preferences(aim: Aim) -> None:
    mesh = bumpy()
    left = mesh.V[mesh.topology.E].mean(axis=1)[:, 0] < 0
    rules = EdgeRules(np.where(left, 0.25, 4.0), np.zeros(len(left), dtype=bool), np.zeros(len(left), dtype=bool))
    shares = []
    for each in (rules, replace(rules, factor=1 / rules.factor)):
        seams = find_seams(mesh, LIMITS, rules=each, aim=aim, neck=1.0)
        shares.append(mesh.edge_lengths[seams.cut & left].sum() / mesh.edge_lengths[seams.cut].sum())
    assert shares[0] > shares[1]
