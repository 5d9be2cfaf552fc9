"""The DXF is read back by ezdxf: exact arcs, layers, units, and the same bytes every time."""

from __future__ import annotations

import os
import subprocess
import sys
from collections import Counter
from itertools import pairwise
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
from ezdxf import options
from ezdxf.math import bulge_to_arc

from skinfab.document import save_skin
from skinfab.drawings.dxf import write_dxf
from skinfab.drawings.sheet import sheet_offsets
from skinfab.drawings.strokes import short_arcs
from skinfab.drawings.svg import THIS_SIDE_OUT
from skinfab.paths import Arc
from skinfab.skin import Skin


def length_of(polyline: Any) -> float:
    """Sum over lines and bulges, each arc by the centre and radius that ezdxf finds."""
    rows = list(polyline.get_points("xyb"))
    total = 0.0
    for (x, y, bulge), (u, v, _) in pairwise(rows):
        if bulge:
            _, start, end, radius = bulge_to_arc((x, y), (u, v), bulge)
            total += radius * ((end - start) % (2 * np.pi))
        else:
            total += np.hypot(u - x, v - y)
    return total


@pytest.fixture
def drawing(skin: Skin, tmp_path: Path) -> Any:
    write_dxf(skin, tmp_path / "flat.dxf")
    return ezdxf.readfile(tmp_path / "flat.dxf")


def test_a_sensor_is_one_polyline_of_exact_length_and_place(skin: Skin, drawing: Any) -> None:
    conductors = list(drawing.modelspace().query('LWPOLYLINE[layer=="CONDUCTOR"]'))
    assert len(conductors) == len(skin.sensors)
    offsets = sheet_offsets(skin.pieces)
    for sensor, drawn in zip(skin.sensors, conductors, strict=True):
        assert length_of(drawn) == pytest.approx(sensor.path.length, rel=1e-12)
        assert length_of(drawn) == pytest.approx(sensor.pattern.length, rel=1e-12)  # type: ignore[attr-defined]
        assert drawn.dxf.const_width == sensor.pattern.bead
        # The very arcs: centre, radius and mid-point as ezdxf works them out from the bulges.
        offset = offsets[[p.id for p in skin.pieces].index(sensor.piece)]
        rows = list(drawn.get_points("xyb"))
        arcs = [bulge_to_arc(a[:2], b[:2], a[2]) for a, b in pairwise(rows) if a[2]]
        exact = [part for part in short_arcs(sensor.path, longest=np.pi) if isinstance(part, Arc)]
        assert len(arcs) == len(exact) > 0
        for (centre, start, end, radius), arc in zip(arcs, exact, strict=True):
            np.testing.assert_allclose([centre.x, centre.y], arc.centre + offset, atol=1e-9)
            assert radius == pytest.approx(arc.radius, abs=1e-9)
            middle = start + (end - start) % (2 * np.pi) / 2
            np.testing.assert_allclose(arc.centre + radius * np.array([np.cos(middle), np.sin(middle)]), arc.point_at(0.5), atol=1e-9)


def test_layers_units_and_audit(skin: Skin, drawing: Any) -> None:
    assert drawing.units == ezdxf.units.MM
    assert not drawing.audit().errors
    count = Counter(e.dxf.layer for e in drawing.modelspace())
    assert count == {"OUTLINE": 2, "SEAM": 8, "DART": 8, "NOTCH": 16, "CONDUCTOR": 2, "PAD": 4, "LABEL": 23, "ORIGIN": 4}
    labels = {e.dxf.text for e in drawing.modelspace().query("TEXT")}
    assert labels == {"P1", "P2", "135.0 x 135.0 mm", "45.0 x 45.0 mm", "C1", "S1", THIS_SIDE_OUT, *map(str, range(1, 9))}


def test_outlines_are_closed_and_keep_their_area(skin: Skin, drawing: Any) -> None:
    for piece, drawn in zip(skin.pieces, drawing.modelspace().query('LWPOLYLINE[layer=="OUTLINE"]'), strict=True):
        x, y = np.array(drawn.get_points("xy")).T
        assert drawn.closed
        assert (np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2 == pytest.approx(piece.area)


def test_same_skin_same_bytes_and_the_option_is_put_back(skin: Skin, tmp_path: Path) -> None:
    for name in ("a.dxf", "b.dxf"):
        write_dxf(skin, tmp_path / name)
    assert (tmp_path / "a.dxf").read_bytes() == (tmp_path / "b.dxf").read_bytes()
    assert options.write_fixed_meta_data_for_testing is False


def test_every_process_writes_the_same_bytes(skin: Skin, tmp_path: Path) -> None:
    """Sets of words are walked in another order in each: of eight, three wrote another file."""
    save_skin(skin, tmp_path / "a.skin")
    program = (
        "import sys; from skinfab.document import load_skin; from skinfab.drawings.dxf import write_dxf; "
        "write_dxf(load_skin(sys.argv[1]), sys.argv[2])"
    )
    written = set()
    for seed in "3456":
        target = tmp_path / f"{seed}.dxf"
        words = [sys.executable, "-c", program, str(tmp_path / "a.skin"), str(target)]
        subprocess.run(words, env={**os.environ, "PYTHONHASHSEED": seed}, check=True)
        written.add(target.read_bytes())
    assert len(written) == 1
