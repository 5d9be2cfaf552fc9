"""The report: figures against closed forms, its shape against its schema, and nothing that is not a number."""

import copy
import dataclasses
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

import skinfab
from skinfab.errors import RefusedError
from skinfab.flatten.distortion import Distortion
from skinfab.material import load_material
from skinfab.progress import PHASES
from skinfab.recipe import recipe
from skinfab.report.build import build_report, report_schema, write_report
from skinfab.skin import Skin

TIMING = {**dict.fromkeys(PHASES, 0.5), "total": 3.5}
GCODE = {
    "file": Path("gcode/P1.gcode"),
    "lines": np.int64(200),
    "time_s": np.float64(61.5),
    "ink_mm3": 160.0,
    "bbox_mm": np.eye(2),
    "arcs": 9,
}
MOULD = {"file": "mould/P1.stl", "watertight": True, "cavity_ml": 30.0}


def report_of(skin: Skin, distortions: list[Distortion], **changes: Any) -> dict[str, Any]:
    facts: dict[str, Any] = {"gcode": [GCODE], "moulds": [MOULD], "timing_s": TIMING, "peak_rss_mb": 200.0, "warnings": ["mind the gap"]}
    cast = recipe({"P1": 30.0}, load_material()).as_dict()
    return build_report(skin, distortions, material=load_material(), **{"recipe": cast, **facts, **changes})


def validate(report: dict[str, Any]) -> None:
    jsonschema.Draft202012Validator(report_schema()).validate(report)


def test_schema_is_itself_valid() -> None:
    jsonschema.Draft202012Validator.check_schema(report_schema())


def test_figures_in_closed_form(skin: Skin, distortions: list[Distortion]) -> None:
    report = report_of(skin, distortions)
    validate(report)
    (piece,) = report["pieces"]
    assert piece["area_mm2"] == pytest.approx(4 * 60 * 50, rel=1e-12)
    assert piece["boundary_mm"] == pytest.approx(2 * (4 * 60 + 50), rel=1e-12)
    assert report["seam_mm"] == pytest.approx(50, rel=1e-12)
    assert report["distortion"]["mean"] == pytest.approx(4.0, abs=1e-9)
    assert report["mesh"]["bbox_mm"] == [[0, 0, 0], [60, 60, 50]]
    strain, contact = report["sensors"]
    assert strain["length_mm"] == pytest.approx(2 * 59 + 2 * 52 + 3 * np.pi, abs=1e-9)  # 231.42 mm in the paper
    assert strain["ink_mm3"] > 0.484 * strain["length_mm"]  # the pads are ink too
    # Flattened without thickness: 1.25 mm outside, the cells of 7.5 mm beside the edge that S1 crosses are so much longer.
    assert strain["wrap_strain"]["max"] == pytest.approx(1.25 / 7.5) == strain["wrap_strain"]["membrane"]["max"]
    assert contact["wrap_strain"]["max"] == pytest.approx(0, abs=1e-9)  # it lies in the middle of a side
    r = strain["resistance_kohm"]
    assert r["low"] < r["median"] < r["high"] and r["median"] / r["low"] == pytest.approx(r["high"] / r["median"])
    assert strain["params"]["l1"] == 60 and (strain["channel"], contact["channel"]) == (0, 1)


def test_it_says_what_it_was_made_for(skin: Skin, distortions: list[Distortion]) -> None:
    skin = dataclasses.replace(skin, printer="/home/me/labs/our-printer.toml", max_distortion=4.07, seed=3)
    report = report_of(skin, distortions, gcode=[{**GCODE, "primed_mm3": 0.2}], moulds=[{**MOULD, "size_mm": (260.0, 70.0, 4.1)}])
    validate(report)
    assert report["made_for"] == {
        "software": f"skinfab {skinfab.__version__}",
        "printer": "our-printer.toml",  # not the folder: the report goes to others
        "material": "carbon-grease-ecoflex",
        "material_name": "carbon grease 846-1P in Ecoflex 00-30",
        "ink": "MG Chemicals 846-1P carbon grease",
        "bead_width_mm": 0.785,
        "bead_area_mm2": 0.484,
        "skin_thickness_mm": 2.5,
        "flattened_at_mm": 0.0,
        "neutral_mm": 1.25,
        "conductor_mm": 1.25,
        "max_distortion": 4.07,
        "seed": 3,
        "scale": 1.0,
    }
    assert report["pieces"][0]["size_mm"] == [240.0, 50.0]
    # The leads of S1 begin at its place and b = 6 mm above it.
    np.testing.assert_allclose(report["sensors"][0]["terminals_mm"], [[90, 20], [90, 26]], atol=1e-9)


def test_bad_figures_are_warned_of_after_what_was_said_before(skin: Skin, distortions: list[Distortion]) -> None:
    d = np.full(len(skin.mesh.F), 4.0)
    d[3] = 12.0
    said, added, strained = report_of(skin, [dataclasses.replace(distortions[0], d=d, max=12.0)])["warnings"]
    assert said == "mind the gap" and added.startswith("piece P1: ") and "12.0" in added
    assert strained.startswith("sensor S1: ")


def test_overall_distortion_is_weighted_by_area_on_the_object(skin: Skin, distortions: list[Distortion]) -> None:
    d = np.full(len(skin.mesh.F), 4.0)
    d[0] = 9.0
    one = dataclasses.replace(distortions[0], d=d, max=9.0)
    report = report_of(skin, [one])["distortion"]
    assert report["mean"] == pytest.approx(4 + 5 / len(d)) and report["max"] == 9.0
    assert report["p99"] == 4.0  # one face of 512 is less than one hundredth


def test_written_report_is_strict_json_and_the_same(skin: Skin, distortions: list[Distortion], tmp_path: Path) -> None:
    report = report_of(skin, distortions)
    write_report(report, tmp_path / "report.json")

    def refuse(word: str) -> float:
        raise AssertionError(word)

    assert json.loads((tmp_path / "report.json").read_text(), parse_constant=refuse) == report


def test_no_sensors_no_gcode_no_moulds(skin: Skin, distortions: list[Distortion]) -> None:
    bare = dataclasses.replace(skin, sensors=())
    report = report_of(bare, distortions, gcode=[], moulds=[], recipe=None, warnings=[])
    validate(report)
    assert report["sensors"] == [] and report["recipe"] == {}


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_is_refused_by_its_place(value: float, skin: Skin, distortions: list[Distortion]) -> None:
    with pytest.raises(RefusedError, match=r"gcode\[0\]\.time_s is not finite"):
        report_of(skin, distortions, gcode=[{**GCODE, "time_s": value}])


def test_a_distortion_for_each_piece(skin: Skin, distortions: list[Distortion]) -> None:
    with pytest.raises(ValueError, match="zip"):
        report_of(skin, distortions * 2)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda r: r.update(extra=1),
        lambda r: r.pop("seam_mm"),
        lambda r: r.update(schema=2),
        lambda r: r["made_for"].pop("ink"),
        lambda r: r["moulds"][0].update(size_mm=[1.0, 2.0]),
        lambda r: r["mesh"].update(units="ft"),
        lambda r: r["mesh"].update(sha256="short"),
        lambda r: r["pieces"][0]["distortion"].update(mean=3.9),
        lambda r: r["pieces"][0].update(id="../P1"),
        lambda r: r["gcode"][0].update(file="/etc/P1.gcode"),
        lambda r: r["gcode"][0].update(file="gcode/../../P1.gcode"),
        lambda r: r["gcode"][0].update(lines=1.5),
        lambda r: r["moulds"][0].update(watertight="yes"),
        lambda r: r["timing_s"].pop("mould"),
        lambda r: r["sensors"][0]["resistance_kohm"].update(mean=1.0),
        lambda r: r["warnings"].append(3),
    ],
)
def test_schema_refuses_what_is_not_a_report(spoil: Callable[[dict[str, Any]], Any], skin: Skin, distortions: list[Distortion]) -> None:
    report = copy.deepcopy(report_of(skin, distortions))
    validate(report)
    spoil(report)
    with pytest.raises(jsonschema.ValidationError):
        validate(report)
