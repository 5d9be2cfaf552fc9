"""The page: whole by itself, well formed, and safe against any name."""

import dataclasses
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

import skinfab
from skinfab.errors import InputError
from skinfab.flatten.distortion import Distortion
from skinfab.material import load_material
from skinfab.progress import PHASES
from skinfab.recipe import recipe
from skinfab.report.build import build_report
from skinfab.report.html import write_html
from skinfab.skin import Skin, Source

EVIL = "<script>alert('x')</script>\"&.obj"
TIMING = {**dict.fromkeys(PHASES, 0.5), "total": 3.5}
PNG = bytes.fromhex("89504e470d0a1a0a")


class Page(HTMLParser):
    """Tags in order; fails on one that is closed out of turn."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in ("meta", "img"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def page_of(skin: Skin, distortions: list[Distortion], folder: Path, **changes: object) -> Page:
    report = build_report(
        skin,
        distortions,
        material=load_material(),
        gcode=[{"file": "gcode/P1.gcode", "lines": 1234, "time_s": 90.0, "ink_mm3": 160.0, "bbox_mm": [[0, 0], [99.5, 2]], "arcs": 9}],
        moulds=[{"file": "mould/P1.stl", "watertight": True, "cavity_ml": 30.0}],
        recipe=recipe({"P1": 30.0}, load_material()).as_dict() | {"steps": ["Home X & Y.", "Jog."]},
        timing_s=TIMING,
        peak_rss_mb=200.0,
        warnings=["<b>thin</b> & bent"],
    )
    (folder / "p.png").write_bytes(PNG)
    write_html(report | changes, folder / "report.html", pictures={"The <skin>": folder / "p.png"})
    return Page((folder / "report.html").read_text(encoding="utf-8"))


def test_well_formed_and_complete(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    page = page_of(skin, distortions, tmp_path)
    assert page.open == []
    for word in [
        "P1",
        "S1",
        "C1",
        "strain-lines",
        "l1 = 60",
        "gcode/P1.gcode",
        "1,234",
        "mould/P1.stl",
        "Slo-Jo",
        "Home X & Y.",
        "ab" * 32,
    ]:
        assert word in page.text
    titles = re.findall(r"<h2>([^<]+)</h2>", (tmp_path / "report.html").read_text())
    assert titles == [
        "Made for",
        "Pieces",
        "Sensors",
        "Worn",
        "Wires",
        "G-code",
        "Moulds",
        "Recipe: what to weigh",
        "Order of work",
    ]
    assert page.text.count("Home X & Y.") == 1


def test_amounts_per_piece_and_together(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    weighed = recipe({"P1": 10.0, "P2": 2.5}, load_material())
    page_of(skin, distortions, tmp_path, recipe=weighed.as_dict())
    first, second, whole = rows_of(tmp_path, "Recipe: what to weigh")[:3]
    # 8 and 2 ml of reservoir at 1.07 g/ml; 15 % more is mixed, of which A is 1/1.03/2.
    assert (first[0], first[1], first[-2:]) == ("P1", "4.78", ["9.84", "8.56"])
    assert (second[0], second[-2:]) == ("P2", ["2.46", "2.14"])
    assert (whole[0], whole[-2:]) == ("all together", ["12.30", "10.70"])


def test_every_row_is_as_wide_as_its_heading(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    page_of(skin, distortions, tmp_path)
    for table in re.findall(r"<table>.*?</table>", (tmp_path / "report.html").read_text(), re.S):
        assert {row.count("<td") for row in re.findall(r"<tr>.*?</tr>", table.partition("<tbody>")[2], re.S)} == {
            table.count("<th ") + table.count("<th>")
        }


def rows_of(folder: Path, title: str) -> list[list[str]]:
    """The cells of the table under a heading."""
    section = (folder / "report.html").read_text(encoding="utf-8").partition(f"<h2>{title}</h2>")[2].partition("<h2>")[0]
    body = section.partition("<tbody>")[2]
    return [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in re.findall(r"<tr>.*?</tr>", body, re.S)]


def test_it_says_what_it_was_made_for(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    page_of(dataclasses.replace(skin, seed=7, max_distortion=4.07), distortions, tmp_path)
    assert dict(rows_of(tmp_path, "Made for")) == {
        "printer profile": "ender5plus-vipro",
        "material profile": "carbon-grease-ecoflex (carbon grease 846-1P in Ecoflex 00-30)",
        "ink": "MG Chemicals 846-1P carbon grease",
        "bead": "0.785 mm wide, cross-section 0.484 mm²",
        "skin": "2.5 mm thick",
        "flattened": "the object&#x27;s own surface",
        "object": "wall.obj, read in mm",
        "SHA-256 of the object&#x27;s file": "ab" * 32,
        "bound on each piece&#x27;s mean d": "4.07",
        "seed": "7",
        "software": f"skinfab {skinfab.__version__}",
    }


def test_what_wearing_does(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    page_of(skin, distortions, tmp_path)
    strain, contact = rows_of(tmp_path, "Worn")
    # S1's four lines cross an edge of the box, where the neutral surface is 2 x 1.25 mm longer than the object's own.
    assert strain[:3] == ["S1", "231.4", "241.4"] and strain[3] == strain[5] == "4.32 / 16.67" and strain[4] == "0.00 / 0.00"
    assert contact[3:6] == ["0.00 / 0.00"] * 3 and contact[6] == contact[7] and contact[8] == "+0.0"
    # The line alone is stretched: its ends' contacts are not.
    flat, worn, shift = (float(cell) for cell in strain[6:])
    assert (worn - 10) / (flat - 10) == pytest.approx(1 + shift / 100, abs=0.005)


def test_two_wires_a_sensor(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    slots = [
        {"sensor": "S1", "terminal": 1, "at_mm": [88.04, 0], "shared": False},
        {"sensor": "S1", "terminal": 2, "at_mm": [91.0, 0], "shared": True},
    ]
    mould = {"file": "mould/P1.stl", "watertight": True, "cavity_ml": 30.0, "wire_slots": slots}
    page_of(skin, distortions, tmp_path, moulds=[mould])
    first, second, *rest = rows_of(tmp_path, "Wires")
    assert first == ["S1-1", "S1", "1", "P1", "90.0, 20.0", "88.0, 0.0", "0", "1, C0"]
    assert second == ["S1-2", "S1", "2", "P1", "90.0, 26.0", "91.0, 0.0 (shared)", "0", "1, C0"]
    assert [(row[0], *row[5:]) for row in rest] == [("C1-1", "not known", "1", "1, C1"), ("C1-2", "not known", "1", "1, C1")]


def test_sizes_and_ink_where_they_are_known(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    mould = {"file": "mould/P1.stl", "watertight": True, "cavity_ml": 30.0}
    gcode = {"file": "gcode/P1.gcode", "lines": 9, "time_s": 60.0, "ink_mm3": 100.0, "bbox_mm": [[0, 0], [9, 2]], "arcs": 0}
    page = page_of(
        skin,
        distortions,
        tmp_path,
        moulds=[mould, {**mould, "size_mm": [120.04, 60, 4.1]}],
        gcode=[{**gcode, "primed_mm3": 0.2}, {**gcode, "primed_mm3": 51.2}, gcode],
    )
    assert [row[1] for row in rows_of(tmp_path, "Moulds")] == ["not known", "120.0 x 60.0 x 4.1"]
    assert [row[5] for row in rows_of(tmp_path, "G-code")] == ["0.2", "51.2", "not known"]
    assert "Load 351 mm³" in page.text  # what a file draws back, the next one pushes again


def test_warnings_of_one_kind_share_a_box(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    same = ["piece P2: 2 darts over 5.5 mm", "piece P3: 4 darts over 11.5 mm", "pieces P4, P5 have none", "piece P6: 1 darts over 2.0 mm"]
    page = page_of(skin, distortions, tmp_path, warnings=same)
    boxes = re.findall(r'<div class="warning">(.*?)</div>', (tmp_path / "report.html").read_text())
    assert [box.count("<li>") for box in boxes] == [3, 0]
    assert all(warning in page.text for warning in same)


def test_two_runs_give_the_same_bytes_whatever_they_took(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    pages = []
    for seconds in (1.0, 2.0):
        page_of(skin, distortions, tmp_path, timing_s={"load": seconds, "total": seconds}, peak_rss_mb=100 * seconds)
        pages.append((tmp_path / "report.html").read_bytes())
    assert pages[0] == pages[1]


def test_it_needs_nothing_else(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    page = page_of(skin, distortions, tmp_path)
    assert [attributes["src"] for tag, attributes in page.tags if tag == "img"] == ["data:image/png;base64,iVBORw0KGgo="]
    assert not {"script", "link", "iframe", "object"} & {tag for tag, _ in page.tags}
    assert "http" not in (tmp_path / "report.html").read_text()


def test_names_are_text_never_markup(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    evil = dataclasses.replace(skin, source=Source(EVIL, "ab" * 32, "mm", 1.0))
    page = page_of(evil, distortions, tmp_path, recipe={"steps": [EVIL], EVIL: EVIL, "batches": []})
    assert page.open == [] and "script" not in {tag for tag, _ in page.tags} and "b" not in {tag for tag, _ in page.tags}
    assert page.text.count(EVIL) == 6 and "<b>thin</b> & bent" in page.text  # title, heading, made for, step, key and value
    assert [attributes["alt"] for tag, attributes in page.tags if tag == "img"] == ["The <skin>"]


def test_sections_with_nothing_in_them_are_left_out(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    page = page_of(skin, distortions, tmp_path, sensors=[], gcode=[], moulds=[], recipe={})
    assert "Sensors" not in page.text and "Moulds" not in page.text and "Pieces" in page.text


def test_only_pictures_are_pictures(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    page_of(skin, distortions, tmp_path)
    report = build_report(skin, distortions, material=load_material(), timing_s=TIMING, peak_rss_mb=1.0)
    with pytest.raises(InputError, match="shows PNG and SVG"):
        write_html(report, tmp_path / "a.html", pictures={"x": tmp_path / "x.pdf"})
    with pytest.raises(InputError, match="No such file"):
        write_html(report, tmp_path / "a.html", pictures={"x": tmp_path / "none.png"})
    assert not (tmp_path / "a.html").exists()
