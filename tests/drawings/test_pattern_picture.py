"""The picture of a pattern: everything inside it, arcs as arcs, each dimension named and as long as its parameter."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest

from skinfab.drawings.catalogue import catalogue, common
from skinfab.drawings.pattern_picture import pattern_svg
from skinfab.patterns.registry import PATTERNS, make_pattern

NS = {"s": "http://www.w3.org/2000/svg"}


@pytest.mark.parametrize("kind", PATTERNS)
def test_all_of_it_is_in_the_picture(kind: str) -> None:
    pattern = make_pattern(kind, PATTERNS[kind].example)
    root = ElementTree.fromstring(pattern_svg(pattern))
    width, height = map(float, root.attrib["viewBox"].split()[2:])
    assert [t.text for t in root.findall("s:text", NS)] == [name for name, _, _ in pattern.dimensions()]
    for path in root.findall("s:path", NS):
        ends = np.array([[float(v) for v in e.split()[-2:]] for e in re.findall(r"[MLA]([^MLA]*)", path.attrib["d"])])
        assert (ends >= 0).all() and (ends <= [width, height]).all()
    conductor = root.find("s:path[@class='conductor']", NS)
    assert conductor is not None and "A" in conductor.attrib["d"] and float(conductor.attrib["stroke-width"]) == pattern.bead
    assert len(root.findall("s:path[@class='pad']", NS)) == 2


@pytest.mark.parametrize("kind", PATTERNS)
def test_a_dimension_line_is_as_long_as_its_parameter(kind: str) -> None:
    pattern = make_pattern(kind, PATTERNS[kind].example)
    root = ElementTree.fromstring(pattern_svg(pattern))
    lines = [path.attrib["d"] for path in root.findall("s:path[@class='dimension']", NS)]
    for (name, _, _), line in zip(pattern.dimensions(), lines, strict=True):
        first, second = (np.array(p.split(), dtype=float) for p in re.match(r"M([^L]*)L([^M]*)", line).groups())
        assert np.hypot(*(second - first)) == pytest.approx(getattr(pattern, name), abs=1e-5)


def test_the_catalogue_describes_every_parameter() -> None:
    for entry in catalogue():
        assert entry.summary.endswith(".") and {p.name for p in entry.parameters} >= set(PATTERNS[entry.kind].example)
        assert {p.name for p in entry.parameters if p.required} == set(entry.least)
    for parameter in (*common(), *(p for entry in catalogue() for p in entry.parameters)):
        # A name without a description stands for itself: each must have more.
        assert len(parameter.meaning) > len(parameter.name) + 10 and len(parameter.bounds) > 5, parameter
        assert parameter.unit in ("mm", "count", "switch") and parameter.required == (parameter.default is None)
        assert parameter.required or parameter.default != ""
