"""The PDF is read back by another library and measured, in points, against the pieces."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pypdf
import pytest
from numpy.typing import NDArray
from pypdf.generic import ContentStream

from skinfab.drawings.pdf import write_pdf
from skinfab.drawings.tiles import OVERLAP_MM
from skinfab.errors import InputError
from skinfab.material import load_material
from skinfab.mesh.model import Mesh
from skinfab.mould import skin_moulds
from skinfab.patterns.contact_spiral import ContactSpiral
from skinfab.patterns.strain_lines import StrainLines
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.skin import Skin, Source

MM = 25.4 / 72
Stroke = tuple[str, float, str, NDArray[np.float64]]  # operator, line width mm, colour, points mm


def plate(width: float, height: float, sensors: tuple[Sensor, ...] = ()) -> Skin:
    V = np.array([[0.0, 0, 0], [width, 0, 0], [width + 7, height, 0], [3, height - 4, 0]])
    F = np.array([[0, 1, 2], [0, 2, 3]])
    piece = Piece("P1", np.arange(2), np.arange(4), F, V[:, :2])
    return Skin(Mesh(V, F, "plate"), Source("plate.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), np.int64), (piece,), sensors)


def strokes(page: pypdf.PageObject, reader: pypdf.PdfReader) -> list[Stroke]:
    """All painted paths of a page, curves by a quarter, a half, three quarters and all of each."""
    out: list[Stroke] = []
    points: list[list[float]] = []
    state, stack = ("", 0.0), []
    for operands, operator in ContentStream(page.get_contents(), reader).operations:
        numbers = [float(x) for x in operands] if operator in (b"m", b"l", b"c", b"w") else []
        if operator == b"q":
            stack.append(state)
        elif operator == b"Q":
            state = stack.pop()
        elif operator == b"w":
            state = (state[0], numbers[0] * MM)
        elif operator in (b"rg", b"RG"):
            state = ("#" + "".join(f"{round(255 * float(x)):02x}" for x in operands), state[1])
        elif operator in (b"m", b"l"):
            points.append(numbers)
        elif operator == b"c":
            controls = np.array([*points[-1], *numbers]).reshape(4, 2)
            t = np.array([0.25, 0.5, 0.75, 1.0])[:, None]
            bernstein = np.hstack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
            points += (bernstein @ controls).tolist()
        elif operator in (b"S", b"s", b"f", b"f*", b"B", b"n"):
            out.append((operator.decode(), state[1], state[0], np.array(points).reshape(-1, 2) * MM))
            points = []
    return out


def outline_of(page: pypdf.PageObject, reader: pypdf.PdfReader) -> NDArray[np.float64]:
    (found,) = [points for operator, _, colour, points in strokes(page, reader) if operator.startswith("f") and colour == "#f4efe6"]
    return found


@pytest.fixture
def skin() -> Skin:
    spiral = Sensor("C1", "P1", ContactSpiral(n=2, x=1.7, b=1.5, l=3, s=15), 30.0, 20.0, 0.7, 0)
    return plate(100, 80, (spiral, Sensor("S1", "P1", StrainLines(l1=60, l2=50, b=6), 12.0, 60.0, 0.1, 1)))


def test_a_piece_is_as_large_as_it_is(skin: Skin, tmp_path: Path) -> None:
    moulds = skin_moulds(skin, material=load_material())
    write_pdf(skin, tmp_path / "flat.pdf", moulds=moulds)
    reader = pypdf.PdfReader(tmp_path / "flat.pdf")
    (page,) = reader.pages
    np.testing.assert_allclose([float(x) * MM for x in page.mediabox], [0, 0, 210, 297], atol=1e-3)
    outline = outline_of(page, reader)
    shift = outline[0] - skin.pieces[0].outline[0]
    np.testing.assert_allclose(outline[:4] - shift, skin.pieces[0].outline, atol=1e-4)
    assert (outline > 10).all() and (outline < [200, 287]).all()  # where any printer prints
    # The conductors begin and end where they should, as wide as the bead; the pads and the marks lie round them.
    drawn = [(points - shift, width) for operator, width, _, points in strokes(page, reader) if operator == "S"]
    for sensor in skin.sensors:
        (width,) = [
            w
            for p, w in drawn
            if np.allclose(p[0], sensor.path.start, atol=1e-4) and np.allclose(p[-1], sensor.path.end, atol=1e-4) and len(p) > 9
        ]
        assert width == pytest.approx(sensor.pattern.bead, abs=1e-4)
    corners = np.array([p[1] for p, w in drawn if len(p) == 3 and w == pytest.approx(0.3, abs=1e-3)])
    np.testing.assert_allclose(corners, moulds[0].marks, atol=1e-4)
    ways = [p for p, w in drawn if w == pytest.approx(0.15, abs=1e-3)]
    np.testing.assert_allclose(ways, [[s.pad, s.at, s.out] for s in moulds[0].wire_slots], atol=1e-4)


def test_curves_stay_on_their_arcs(skin: Skin, tmp_path: Path) -> None:
    write_pdf(skin, tmp_path / "flat.pdf")
    reader = pypdf.PdfReader(tmp_path / "flat.pdf")
    shift = outline_of(reader.pages[0], reader)[0] - skin.pieces[0].outline[0]
    sensor = skin.sensors[0]
    (curve,) = [
        p - shift for _, _, _, p in strokes(reader.pages[0], reader) if len(p) > 60 and np.allclose(p[0] - shift, sensor.path.start)
    ]
    on_path = sensor.path.to_polyline(tolerance=1e-6)
    a, b = on_path[:-1, None], on_path[1:, None]
    t = np.clip(((curve - a) * (b - a)).sum(-1) / ((b - a) ** 2).sum(-1), 0, 1)[..., None]
    assert np.linalg.norm(curve - a - t * (b - a), axis=-1).min(axis=0).max() < 1e-5
    drawn = np.hypot(*np.diff(curve, axis=0).T).sum()
    assert sensor.path.length * 0.995 < drawn < sensor.path.length


def test_the_bar_and_the_words(skin: Skin, tmp_path: Path) -> None:
    write_pdf(skin, tmp_path / "flat.pdf")
    reader = pypdf.PdfReader(tmp_path / "flat.pdf")
    bars = [np.ptp(points, axis=0) for _, _, _, points in strokes(reader.pages[0], reader) if len(points) == 2]
    assert sum(np.allclose(bar, [100, 0], atol=1e-4) for bar in bars) == 1
    words = reader.pages[0].extract_text()
    for word in ("100 mm", "plate, piece P1", "C1", "S1", "Print at 100 %"):
        assert word in words
    assert words.split().count("1") >= 2 and words.split().count("2") >= 2  # the pads
    assert reader.metadata.title == "plate: flat pieces, 1:1"


def test_a_large_piece_is_tiled_and_the_sheets_agree(tmp_path: Path) -> None:
    big = plate(340, 300)
    write_pdf(big, tmp_path / "flat.pdf")
    reader = pypdf.PdfReader(tmp_path / "flat.pdf")
    assert len(reader.pages) == 4
    shifts = np.array([outline_of(page, reader)[0] - big.pieces[0].outline[0] for page in reader.pages])
    w, h = (float(x) * MM for x in reader.pages[0].mediabox[2:])
    step = np.array([w - 20 - OVERLAP_MM, h - 20 - 16 - OVERLAP_MM])
    np.testing.assert_allclose(shifts[0] - shifts[1], [step[0], 0], atol=1e-3)
    np.testing.assert_allclose(shifts[0] - shifts[2], [0, step[1]], atol=1e-3)
    np.testing.assert_allclose(shifts[0] - shifts[3], step, atol=1e-3)
    # Crosses are at the same places of the piece on all sheets.
    crosses = []
    for page, shift in zip(reader.pages, shifts, strict=True):
        found = [p.mean(axis=0) - shift for _, _, _, p in strokes(page, reader) if len(p) == 2 and np.allclose(np.ptp(p, axis=0), [6, 0])]
        crosses.append({tuple(np.round(c, 2)) for c in found})
        assert "of 4" in page.extract_text()
    middle = crosses[0] & crosses[1] & crosses[2] & crosses[3]
    assert len(middle) >= 1


def test_same_skin_same_bytes(skin: Skin, tmp_path: Path) -> None:
    for name in ("a.pdf", "b.pdf"):
        write_pdf(skin, tmp_path / name)
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()


@pytest.mark.parametrize("name", ["becher_größe", "価格", "a$b$c", "x" * 300, "(\\)"])
def test_any_name_can_be_written(name: str, skin: Skin, tmp_path: Path) -> None:
    named = replace(skin, mesh=Mesh(skin.mesh.V, skin.mesh.F, name))
    write_pdf(named, tmp_path / "flat.pdf")
    reader = pypdf.PdfReader(tmp_path / "flat.pdf")
    assert "piece P1" in reader.pages[0].extract_text() or len(name) > 100
    assert reader.metadata.title.startswith(name)


def test_a_missing_folder_is_said(skin: Skin, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="folder does not exist"):
        write_pdf(skin, tmp_path / "none" / "flat.pdf")
