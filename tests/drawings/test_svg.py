"""The SVG is parsed again and its arcs are worked out as the SVG specification says (F.6.5)."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from skinfab.drawings.sheet import sheet_offsets
from skinfab.drawings.svg import MARGIN_MM, write_svg
from skinfab.skin import Skin

NS = {"s": "http://www.w3.org/2000/svg"}


def parse(path: Path) -> tuple[ET.Element, float]:
    root = ET.parse(path).getroot()
    return root, float(root.attrib["viewBox"].split()[3])


def points_of(d: str, height: float) -> tuple[NDArray[np.float64], float]:
    """Points along the drawn path with y up, and its exact length."""
    here, out, length = np.zeros(2), [], 0.0
    for command, values in re.findall(r"([MLAZ])([^MLAZ]*)", d):
        numbers = [float(v) for v in values.split()]
        if command == "Z":
            continue
        end = np.array(numbers[-2:])
        if command == "A":
            r, rx, turn, large, flag = numbers[:5]
            assert r == rx and turn == 0 and large == 0
            half = (end - here) / 2
            lift = np.sqrt(max(r**2 - half @ half, 0))
            # Seen with y down, flag 1 has the centre to the right of the chord's direction (x, y) -> (-y, x).
            normal = np.array([-half[1], half[0]]) / np.hypot(*half)
            centre = here + half + (lift if flag == 1 else -lift) * normal
            a0, a1 = (np.arctan2(*(p - centre)[::-1]) for p in (here, end))
            sweep = (a1 - a0) % (2 * np.pi) if flag == 1 else -((a0 - a1) % (2 * np.pi))
            angle = a0 + sweep * np.linspace(0, 1, 40)[1:]
            out += list(centre + r * np.c_[np.cos(angle), np.sin(angle)])
            length += r * abs(sweep)
        else:
            length += float(np.hypot(*(end - here))) if command == "L" else 0.0
            out.append(end)
        here = end
    flipped = np.array(out)
    flipped[:, 1] = height - flipped[:, 1]
    return flipped, length


def test_arcs_are_true_and_in_place(skin: Skin, tmp_path: Path) -> None:
    write_svg(skin, tmp_path / "flat.svg")
    root, height = parse(tmp_path / "flat.svg")
    offsets = sheet_offsets(skin.pieces)
    for sensor in skin.sensors:
        drawn = root.find(f".//s:g[@id='{sensor.id}']/s:path[@class='conductor']", NS)
        assert drawn is not None
        points, length = points_of(drawn.attrib["d"], height)
        assert length == pytest.approx(sensor.path.length, abs=1e-4)
        k = [p.id for p in skin.pieces].index(sensor.piece)
        exact = shapely.LineString(sensor.path.to_polyline(tolerance=1e-6) + offsets[k] + MARGIN_MM)
        assert shapely.distance(exact, shapely.points(points)).max() < 1e-4
        assert np.allclose(points[0], exact.coords[0], atol=1e-5) and np.allclose(points[-1], exact.coords[-1], atol=1e-5)
        assert "A" in drawn.attrib["d"]


def test_outline_is_not_mirrored_and_to_scale(skin: Skin, tmp_path: Path) -> None:
    write_svg(skin, tmp_path / "flat.svg")
    root, height = parse(tmp_path / "flat.svg")
    _, _, w, h = root.attrib["viewBox"].split()
    assert root.attrib["width"] == f"{w}mm" and root.attrib["height"] == f"{h}mm"
    for piece, offset in zip(skin.pieces, sheet_offsets(skin.pieces), strict=True):
        drawn = root.find(f"s:g[@id='{piece.id}']/s:path[@class='outline']", NS)
        assert drawn is not None
        points, _ = points_of(drawn.attrib["d"], height)
        np.testing.assert_allclose(points, piece.outline + offset + MARGIN_MM, atol=1e-6)
        assert shapely.LinearRing(points).is_ccw
        assert (points.min(axis=0) >= MARGIN_MM - 1e-6).all() and (points.max(axis=0) <= [float(w) - MARGIN_MM + 1e-6, height]).all()


def test_names_roles_and_no_mirrored_text(skin: Skin, tmp_path: Path) -> None:
    write_svg(skin, tmp_path / "flat.svg")
    text = (tmp_path / "flat.svg").read_text()
    root, _ = parse(tmp_path / "flat.svg")
    words = [t.text for t in root.iter(f"{{{NS['s']}}}text")]
    assert {"P1", "P2", "C1", "S1"} <= set(words) and all(words.count(str(k)) == 2 for k in range(1, 9))
    classes = [p.attrib["class"] for p in root.findall("s:g[@class='piece']//s:path", NS)]
    assert classes.count("dart") == 8 and classes.count("seam") == 8 and classes.count("pad") == 4
    assert "scale(" not in text and "cube &amp; co" in text
    assert root.find(".//s:g[@id='C1']", NS).attrib["stroke-width"] == "0.785"  # type: ignore[union-attr]


def test_legend_is_above_the_pieces_and_shows_what_is_drawn(skin: Skin, tmp_path: Path) -> None:
    write_svg(skin, tmp_path / "flat.svg")
    root, height = parse(tmp_path / "flat.svg")
    legend = root.find("s:g[@class='legend']", NS)
    assert legend is not None
    words = [text.text for text in legend.findall("s:text", NS)]
    assert words[0] == "This side out: the pieces are seen from outside the object"
    # The cube is closed: it has no edge of its own.
    assert [str(word).split(":")[0] for word in words[1:]] == ["seam", "dart", "conductor", "contact pad", "origin (0, 0) of a piece"]
    lowest = max(float(text.attrib["y"]) for text in legend.findall("s:text", NS))
    far = max(float((p.UV + o)[:, 1].max()) for p, o in zip(skin.pieces, sheet_offsets(skin.pieces), strict=True))
    assert lowest < height - (far + MARGIN_MM)
    plain = replace(skin, sensors=())
    write_svg(plain, tmp_path / "plain.svg")
    assert "contact pad" not in (tmp_path / "plain.svg").read_text()


def test_cross_at_the_origin_of_each_piece(skin: Skin, tmp_path: Path) -> None:
    write_svg(skin, tmp_path / "flat.svg")
    root, height = parse(tmp_path / "flat.svg")
    for piece, offset in zip(skin.pieces, sheet_offsets(skin.pieces), strict=True):
        drawn = root.find(f"s:g[@id='{piece.id}']/s:path[@class='origin']", NS)
        assert drawn is not None
        points, length = points_of(drawn.attrib["d"], height)
        np.testing.assert_allclose(points.mean(axis=0), offset + MARGIN_MM, atol=1e-6)
        assert length == pytest.approx(6.0) and np.ptp(points, axis=0) == pytest.approx([3, 3])


def test_words_have_a_halo(skin: Skin, tmp_path: Path) -> None:
    write_svg(skin, tmp_path / "flat.svg")
    assert "stroke:#fff" in (tmp_path / "flat.svg").read_text() and "paint-order:stroke" in (tmp_path / "flat.svg").read_text()


def test_same_skin_same_bytes(skin: Skin, tmp_path: Path) -> None:
    for name in ("a.svg", "b.svg"):
        write_svg(skin, tmp_path / name)
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
