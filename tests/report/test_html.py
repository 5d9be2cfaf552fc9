"""The page: whole by itself, well formed, and safe against any name."""

import dataclasses
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

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
        recipe=recipe({"P1": 30.0}, load_material()).as_dict(),
        timing_s=TIMING,
        peak_rss_mb=200.0,
        warnings=["<b>thin</b> & bent"],
    )
    (folder / "p.png").write_bytes(PNG)
    write_html(report | changes, folder / "report.html", pictures={"The <skin>": folder / "p.png"}, registration=["Home X & Y.", "Jog."])
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
    assert titles == ["Pieces", "Sensors", "G-code", "Moulds", "Recipe", "Registration: where the G-code&#x27;s origin lies", "Provenance"]


def test_every_row_is_as_wide_as_its_heading(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    page_of(skin, distortions, tmp_path)
    for table in re.findall(r"<table>.*?</table>", (tmp_path / "report.html").read_text(), re.S):
        assert {row.count("<td") for row in re.findall(r"<tr>.*?</tr>", table.partition("<tbody>")[2], re.S)} == {
            table.count("<th ") + table.count("<th>")
        }


def test_it_needs_nothing_else(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    page = page_of(skin, distortions, tmp_path)
    assert [attributes["src"] for tag, attributes in page.tags if tag == "img"] == ["data:image/png;base64,iVBORw0KGgo="]
    assert not {"script", "link", "iframe", "object"} & {tag for tag, _ in page.tags}
    assert "http" not in (tmp_path / "report.html").read_text()


def test_names_are_text_never_markup(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    evil = dataclasses.replace(skin, source=Source(EVIL, "ab" * 32, "mm", 1.0))
    page = page_of(evil, distortions, tmp_path, recipe={"steps": [EVIL], EVIL: EVIL, "batches": []})
    assert page.open == [] and "script" not in {tag for tag, _ in page.tags} and "b" not in {tag for tag, _ in page.tags}
    assert page.text.count(EVIL) == 6 and "<b>thin</b> & bent" in page.text  # title, heading, provenance, step, key and value
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
