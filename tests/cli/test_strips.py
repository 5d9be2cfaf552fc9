"""From the plate to a fitted profile and to a skin made with it, as a lab would."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.material import load_material, material_toml

ROOT = Path(__file__).resolve().parents[2]


def fill_in(table: Path, *, area: float, sigma: float, contact: float) -> None:
    rng = np.random.default_rng(4)
    rows = list(csv.DictReader(table.read_text().splitlines()))
    with table.open("w", newline="") as out:
        writer = csv.DictWriter(out, rows[0].keys())
        writer.writeheader()
        for row in rows[:-1]:
            median = 0.63 * float(row["length_mm"]) / area + 2 * contact
            writer.writerow(row | {"r_kohm": f"{median * np.exp(sigma * rng.normal()):.3f}"})
        writer.writerow(rows[-1])  # the last one broke


def test_print_measure_fit_and_use(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["strips", "-o", str(out), "--copies", "3"]) == 0
    assert (out / "gcode/P1.gcode").is_file() and (out / "mould/P1.stl").is_file()
    assert "skinfab strips --fit" in capsys.readouterr().out
    assert main(["gcode", "check", str(out / "gcode/P1.gcode")]) == 0
    fill_in(out / "strips.csv", area=0.3, sigma=0.1, contact=8.0)
    filled = (out / "strips.csv").read_bytes()
    assert main(["strips", "-o", str(out), "--copies", "3"]) == 0
    assert (out / "strips.csv").read_bytes() == filled and "left as it is" in capsys.readouterr().err

    profile = tmp_path / "our ink.toml"
    assert main(["strips", "--fit", str(out / "strips.csv"), "-o", str(profile), "--json"]) == 0
    said = capsys.readouterr()
    fit = json.loads(said.out)["fit"]
    assert "no resistance on line 10; left out" in said.err and fit["n"] == 8
    assert fit["effective_area_mm2"]["low"] < 0.3 < fit["effective_area_mm2"]["high"]
    ink = load_material(profile).ink
    assert ink.effective_area_mm2 == fit["effective_area_mm2"]["value"] and ink.bead_area_mm2 == 0.484
    assert "standard error" in profile.read_text().splitlines()[2]

    cube = str(ROOT / "meshes/cube.obj")
    for name, options in (("a", []), ("b", ["--material", str(profile)])):
        assert main(["make", cube, "-o", str(tmp_path / name), *options]) == 0
    a, b = (json.loads((tmp_path / name / "report.json").read_text()) for name in ("a", "b"))
    for before, after in zip(a["sensors"], b["sensors"], strict=True):
        assert after["resistance_kohm"]["median"] > 1.3 * before["resistance_kohm"]["median"]
        assert after["ink_mm3"] == before["ink_mm3"]
    assert b["made_for"]["material"] == "our ink.toml"
    # The document finds its profile again, and can be given another.
    document = str(tmp_path / "b/skin.skin")
    for name, options in (("c", []), ("d", ["--material", "carbon-grease-ecoflex"])):
        assert main(["make", document, "-o", str(tmp_path / name), *options]) == 0
    c, d = (json.loads((tmp_path / name / "report.json").read_text()) for name in ("c", "d"))
    assert c["sensors"][0]["resistance_kohm"] == b["sensors"][0]["resistance_kohm"]
    assert d["sensors"][0]["resistance_kohm"] == a["sensors"][0]["resistance_kohm"]


def test_what_cannot_be_told_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.csv").write_text("length_mm,r_kohm\n" + "100,50\n" * 8)
    assert main(["strips", "--fit", str(tmp_path / "a.csv"), "-o", str(tmp_path / "m.toml")]) == 3
    assert "8 strips of 1 length" in capsys.readouterr().err and not (tmp_path / "m.toml").exists()


def test_resistances_in_ohm_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = [(length, 1000 * (0.63 * length / 0.4 + 10) * off) for length in (40, 160, 640) for off in (0.9, 1.0, 1.1)]
    (tmp_path / "a.csv").write_text("length_mm;r_kohm\n" + "".join(f"{a};{r:.1f}\n".replace(".", ",") for a, r in rows))
    assert main(["strips", "--fit", str(tmp_path / "a.csv"), "-o", str(tmp_path / "m.toml")]) == 3
    assert "are these ohm? Divide them by 1000" in capsys.readouterr().err and not (tmp_path / "m.toml").exists()


def test_a_broken_strip_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = [(length, (0.63 * length / 0.4 + 10) * off) for length in (40, 160, 640) for off in (0.9, 1.0, 1.1, 1.05)]
    rows[5] = (160, 9000.0)
    (tmp_path / "a.csv").write_text("sensor,length_mm,r_kohm\n" + "".join(f"L{a}-{k},{a},{r:.1f}\n" for k, (a, r) in enumerate(rows)))
    assert main(["strips", "--fit", str(tmp_path / "a.csv"), "-o", str(tmp_path / "m.toml")]) == 0
    said = capsys.readouterr().err
    assert "warning: L160-5 (line 7) has 9000 kohm, " in said and "times what the other strips lead one to expect: measure it again" in said


@pytest.mark.parametrize(
    ("options", "status", "says"),
    [
        (["--fit", "a.csv", "-o", "DIR"], 2, "does not end in .toml"),
        (["--fit", "a.csv", "-o", "m.toml", "--copies", "3"], 2, "not for --fit"),
        (["-o", "DIR", "--copies", "1"], 1, "a plate has 2 to 8"),
        (["-o", "DIR", "--material", "none"], 1, "no material profile named 'none'"),
    ],
)
def test_wrong_usage(
    options: list[str], status: int, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["strips", *options]) == status
    assert says in capsys.readouterr().err and not (tmp_path / "DIR").exists()


def test_a_profile_is_written_as_it_was(tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text(material_toml(load_material(), comments=["two\nlines"]))
    assert load_material(tmp_path / "m.toml") == load_material()
    assert (tmp_path / "m.toml").read_text().startswith("# two lines\n")
