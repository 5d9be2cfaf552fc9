"""Seams in their colours, whole seams that light up, conductors, and numbers at the notches."""

from dataclasses import replace

import numpy as np
import pytest

from gui.state.derived import Derived
from gui.theme import LIGHT, rgb
from gui.view3d.marks import SeamLabels, SeamLines, outline, sensor_strokes


def test_seams_locked_seams_and_forbidden_edges_differ(skin):
    lines = SeamLines.of(skin)
    assert lines.kind.tolist().count(0) == 11 and lines.kind.tolist().count(1) == 1 and lines.kind.tolist().count(2) == 1
    strokes = lines.strokes(LIGHT)
    colours = {tuple(c) for c in strokes.colour.tolist()}
    assert colours == {rgb(LIGHT.seam), rgb(LIGHT.locked), rgb(LIGHT.forbidden)}
    top = skin.mesh.topology
    for target, a, b in zip(strokes.targets, strokes.a, strokes.b, strict=True):
        np.testing.assert_allclose(skin.mesh.V[top.E[target.seam]], [a, b])


def test_a_document_without_marks_has_plain_seams(skin):
    lines = SeamLines.of(replace(skin, marks=None))
    assert (lines.kind == 0).all() and len(lines.edges) == 12


def test_a_whole_seam_lights_up_and_a_forbidden_edge_alone(skin):
    lines = SeamLines.of(skin)
    assert len(lines.lit(skin, int(lines.edges[3]), LIGHT.hover).targets) == 12
    assert len(lines.lit(skin, int(lines.edges[-1]), LIGHT.hover).targets) == 1
    assert len(lines.lit(skin, 0, LIGHT.hover).targets) == 0  # no seam there


def test_a_conductor_is_as_wide_as_its_bead_and_stands_for_its_sensor(skin):
    bead = skin.sensors[0].pattern.bead
    near, far = (sensor_strokes(skin, Derived(), LIGHT, {}, scale=scale) for scale in (10.0, 0.1))
    assert near.width[0] == pytest.approx(10 * bead) and far.width[0] > 1
    assert near.targets[0].sensor == "C1" and near.targets[0].piece == "P2"
    assert tuple(sensor_strokes(skin, Derived(), LIGHT, {"C1": LIGHT.select}, scale=1).colour[0].tolist()) == rgb(LIGHT.select)


def test_numbers_stand_at_the_notches(skin):
    labels = SeamLabels.of(skin)
    assert labels.text == ("1",)
    x, y, z = labels.points[0]
    assert (x, y) == (60, 0) and 0 < z < 60
    np.testing.assert_allclose(np.abs(labels.normals), [[0, 1, 0]])


def test_without_pieces_there_are_no_numbers(skin):
    assert SeamLabels.of(replace(skin, pieces=(), sensors=())).text == ()


def test_a_piece_has_its_border(skin):
    strokes = outline(skin, "P1", LIGHT.select, width=3)
    assert np.linalg.norm(strokes.a - strokes.b, axis=1).sum() == pytest.approx(4 * 60)
    assert strokes.a[:, 0].max() == 60 and not any(strokes.targets)  # the pointer goes through it to the seam
    assert len(outline(skin, "P9", LIGHT.select).a) == 0
