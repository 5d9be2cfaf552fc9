"""A cube in two exact flat pieces, a lid and a cross of five, with one sensor of either kind."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from skinfab.mesh.model import Mesh
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.seams.cut import OpenPiece, open_pieces
from skinfab.skin import Skin, Source

SIDE = 45.0


def cube() -> Mesh:
    V = SIDE * np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    F = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return Mesh(V, F, "cube & co")


def unfold(mesh: Mesh, piece: OpenPiece) -> NDArray[np.float64]:
    """Lay the faces down one by one, each rigidly on the edge it shares with one already there."""
    V, F = mesh.V[piece.vertices], piece.F
    UV = np.full((len(V), 2), np.nan)
    a, b, c = F[0]
    UV[a], UV[b] = 0, (np.linalg.norm(V[b] - V[a]), 0)
    waiting = list(range(len(F)))
    while waiting:
        for f in waiting:
            for k in range(3):
                a, b, c = np.roll(F[f], -k)
                if not np.isnan(UV[[a, b]]).any():
                    along, side = V[b] - V[a], V[c] - V[a]
                    x = side @ along / (along @ along)
                    y = np.linalg.norm(np.cross(along, side)) / (along @ along)
                    flat = UV[b] - UV[a]
                    UV[c] = UV[a] + x * flat + y * np.array([-flat[1], flat[0]])
                    waiting.remove(f)
                    break
            else:
                continue
            break
    return UV - UV.min(axis=0)


@pytest.fixture(scope="session")
def skin() -> Skin:
    mesh = cube()
    edges = mesh.topology.E
    on_lid = (mesh.V[edges][:, :, 2] == SIDE).all(axis=1)
    upright = np.ptp(mesh.V[edges][:, :, 2], axis=1) > 0
    straight = np.isclose(mesh.edge_lengths, SIDE)
    cut = straight & (on_lid | upright)
    opened = open_pieces(mesh, cut)
    assert sorted(len(p.F) for p in opened) == [2, 10]
    opened.sort(key=lambda p: -len(p.F))
    pieces = tuple(Piece(f"P{k + 1}", p.faces, p.vertices, p.F, unfold(mesh, p)) for k, p in enumerate(opened))
    sensors = (
        Sensor("C1", "P1", ContactSpiral(n=3, x=2.0, b=3.0, l=6.0, s=24.0), x=48.0, y=70.0, angle=0.3, channel=0),
        Sensor("S1", "P2", StrainLines(l1=30, l2=24, b=6), x=8.0, y=10.0, angle=0.5, channel=1),
    )
    return Skin(mesh, Source("cube.obj", "0" * 64, "mm", 1.0), edges[cut], pieces, sensors)
