"""The picture of wrap strain: every conductor, coloured by the strain that was reckoned."""

import dataclasses
import itertools
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from skinfab.material import load_material
from skinfab.report.strain_picture import colour, write_strain_picture
from skinfab.report.strains import sensor_strains, strain_facts
from skinfab.skin import Skin

SVG = "{http://www.w3.org/2000/svg}"


def drawn(path: Path) -> dict[str, list[tuple[str, np.ndarray]]]:
    """Colour and points of each stroke, by sensor; y counts down."""
    found = {}
    for group in ElementTree.parse(path).getroot().iter(f"{SVG}g"):
        name = group.find(f"{SVG}title").text.partition(":")[0]
        strokes = [
            (s.get("stroke"), np.array(re.findall(r"(\S+) (\S+)", s.get("d")[1:].replace("L", " ")), float))
            for s in group.iter(f"{SVG}path")
        ]
        found[name] = strokes
    return found


def test_colours_say_the_strain(skin: Skin, tmp_path: Path) -> None:
    strains = sensor_strains(skin, load_material())
    write_strain_picture(skin, strains, tmp_path / "w.svg")
    picture = drawn(tmp_path / "w.svg")
    assert set(picture) == {"S1", "C1"}
    assert {shade for shade, _ in picture["C1"]} == {colour(0.0)}  # in the middle of a flat side
    # S1 crosses the box's edge at x = 120, 8 mm of margin further right: the cells of 7.5 mm beside it are 16.7 % too short.
    for shade, points in picture["S1"]:
        x = points[:, 0] - 8
        if shade == colour(1.0):
            assert ((x > 111) & (x < 129)).all()
        elif shade == colour(0.0):
            assert ((x < 112.6) | (x > 127.4)).all()
    assert {colour(0.0), colour(1.0)} <= {shade for shade, _ in picture["S1"]}


def test_the_whole_path_is_drawn_without_gaps(skin: Skin, tmp_path: Path) -> None:
    write_strain_picture(skin, sensor_strains(skin, load_material()), tmp_path / "w.svg")
    for sensor in skin.sensors:
        strokes = drawn(tmp_path / "w.svg")[sensor.id]
        for (_, one), (_, two) in itertools.pairwise(strokes):
            assert one[-1] == pytest.approx(two[0])
        length = sum(np.linalg.norm(np.diff(points, axis=0), axis=1).sum() for _, points in strokes)
        assert length == pytest.approx(sensor.path.length, rel=0.02)  # chords, and half a sample less at each end


def test_squeezed_is_blue(skin: Skin, tmp_path: Path) -> None:
    large = dataclasses.replace(skin.pieces[0], UV=skin.pieces[0].UV * 1.25)
    skin = dataclasses.replace(skin, pieces=(large,), neutral=0.0, sensors=skin.sensors[1:])
    strains = sensor_strains(skin, load_material())
    assert strain_facts(skin.sensors[0], strains.along[0], load_material(), even=0)["mean"] == pytest.approx(-0.2)
    write_strain_picture(skin, strains, tmp_path / "w.svg")
    assert {shade for shade, _ in drawn(tmp_path / "w.svg")["C1"]} == {colour(-1.0)}


def test_conductors_lie_at_the_print_height(skin: Skin) -> None:
    """Beyond the neutral surface by 0.35 mm, the sharp edge of the box lengthens a line across it by another 0.35 pi / 2."""
    material = load_material()
    facts = [
        strain_facts(skin.sensors[0], sensor_strains(skin, material, conductor_mm=z).along[0], material, even=material.depth)
        for z in (None, 1.6, 0.9)
    ]
    flat = skin.sensors[0].path.length
    assert [f["bending"]["mean"] * flat for f in facts] == pytest.approx([0, 4 * 0.35 * np.pi / 2, -4 * 0.35 * np.pi / 2], abs=1e-9)
    assert [f["membrane"] for f in facts] == [facts[0]["membrane"]] * 3
    for f in facts:
        assert f["mean"] == pytest.approx(f["membrane"]["mean"] + f["bending"]["mean"], abs=1e-12)
        assert f["worn_length_mm"] == pytest.approx(flat * (1 + f["mean"]))
        assert f["resistance_factor"] >= (1 + f["mean"]) ** 2  # the mean of squares
