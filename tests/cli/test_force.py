"""`skinfab force`: simulate, train, run and bench of textures, gravity and liquids, and the ways in which they are used wrongly."""

import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.fingertip.force.gravity_simulator import PAPER_TRUTH, hold
from skinfab.fingertip.force.logs import write_wrench
from skinfab.fingertip.force.simulator import MATERIALS, Material, slide


def said(capsys: pytest.CaptureFixture[str], *arguments: object) -> dict[str, Any]:
    """Run with --json: one object on standard output, and nothing else."""
    assert main(["force", *map(str, arguments), "--json"]) == 0
    result: dict[str, Any] = json.loads(capsys.readouterr().out)
    return result


@pytest.fixture(scope="module")
def slides(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("slides")
    assert main(["force", "simulate", "texture", "-o", str(folder), "--specimens", "3", "--slides", "2", "--seed", "1"]) == 0
    return folder


@pytest.fixture(scope="module")
def model(slides: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("model")
    assert main(["force", "train", "texture", *map(str, sorted(slides.iterdir())), "-o", str(folder)]) == 0
    return folder / "model.npz"


def test_textures_from_logs_to_decisions(slides: Path, model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs = sorted(slides.iterdir())
    assert len(logs) == 36 and logs[0].read_text().startswith("# simulated: true\n# label: ")
    result = said(capsys, "run", "texture", *logs[::3], "--model", model, "-o", tmp_path)
    assert result["simulated"] and sum(d["texture"] == d["label"] for d in result["decisions"]) >= 10
    assert sorted(each.name for each in tmp_path.iterdir()) == ["result.json", "texture.csv", "texture.png"]
    rows = list(csv.DictReader((tmp_path / "texture.csv").read_text().splitlines()))
    assert len(rows) == 12 and {row["simulated"] for row in rows} == {"1"}


def test_training_tells_what_it_is_worth_on_specimens_held_out(slides: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    result = said(capsys, "train", "texture", *sorted(slides.iterdir()), "-o", tmp_path, "--features", "published")
    accuracy = result["held_out"]["accuracy"]
    assert 0.3 < accuracy["low"] < accuracy["value"] <= accuracy["high"] and result["groups"] == 18 and result["simulated"]
    assert (tmp_path / "confusion.png").read_bytes().startswith(b"\x89PNG")


def test_labels_may_stand_in_a_table(slides: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs = sorted(slides.iterdir())
    table = "\n".join(f"{log.name},{'rough' if 'towel' in log.name else 'other'},{log.name}" for log in logs)
    (tmp_path / "labels.csv").write_text(f"log,label,group\n{table}\n")
    result = said(capsys, "train", "texture", *logs, "--labels", tmp_path / "labels.csv", "-o", tmp_path / "out")
    assert result["held_out"]["classes"] == ["other", "rough"]


def test_a_simulated_model_on_a_real_log_is_warned_of(model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = slide(MATERIALS["towel"], seed=5)
    write_wrench(type(log)(log.name, log.time, log.force, log.moment), tmp_path / "real.csv")
    result = said(capsys, "run", "texture", tmp_path / "real.csv", "--model", model, "-o", tmp_path / "out")
    assert "learned from simulated slides" in result["notes"][0] and result["simulated"]


def test_a_log_that_cannot_be_decided_on_stops_no_others(
    slides: Path, model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "bad.csv").write_text("time,Fx\n0,1\n")
    options = ["--model", str(model), "-o", str(tmp_path / "out")]
    arguments = ["force", "run", "texture", str(tmp_path / "bad.csv")]
    assert main([*arguments, *options]) == 1 and not (tmp_path / "out").exists()
    good = sorted(slides.iterdir())[0]
    rubber = slide(Material(friction=0.9, pitch_mm=3.0, ripple=0.2), seed=1)
    write_wrench(rubber, tmp_path / "rubber.csv")
    capsys.readouterr()
    assert main([*arguments, str(good), str(tmp_path / "rubber.csv"), *options, "--json"]) == 1
    result = json.loads(capsys.readouterr().out)
    assert list(result["failed"]) == ["bad.csv"] and [d["log"] for d in result["decisions"]] == [good.name, "rubber.csv"]
    assert result["decisions"][1]["texture"] == "unknown" and result["decisions"][1]["probability"] is None
    assert main([*arguments, str(good), *options]) == 1
    assert "failed: " in (said_why := capsys.readouterr().err) and "bad.csv has no column Fy" in said_why


def test_gravity_from_logs_to_a_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said(capsys, "simulate", "gravity", "-o", tmp_path / "logs")
    truth = {row["log"]: row for row in csv.DictReader((tmp_path / "logs" / "truth.csv").read_text().splitlines())}
    result = said(capsys, "run", "gravity", *sorted((tmp_path / "logs").iterdir()), "-o", tmp_path / "out", "--place-sd", "0.5")
    assert any("truth.csv is the simulator's table" in note for note in result["notes"])
    assert result["simulated"] and len(result["objects"]) == 5
    for each in result["objects"]:
        true = [float(truth[each["log"]][axis]) for axis in ("x_mm", "y_mm", "z_mm")]
        ours, theirs = (np.linalg.norm(np.subtract(found["centre_mm"], true)) for found in (each, each["published"]))
        assert ours < 1.5 and each["mass_kg"] == pytest.approx(0.17 + 0.04, abs=5 * each["mass_sd_kg"])  # four fingertips of 10 g
        assert each["worst_sd_mm"] >= 0.5 and each["lines_meet"] and theirs < 8
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["gravity.csv", "gravity.png", "result.json"]


def test_a_hand_that_was_weighed_needs_two_poses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs = tmp_path / "logs"
    made = said(capsys, "simulate", "gravity", "-o", logs, "--poses", "2", "--span", "90", "--weighings", "2", "--seed", "1")["files"]
    assert len(made) == 16
    empty = [logs / f"empty-mid-{k}.csv" for k in (1, 2)]
    learned = said(capsys, "train", "gravity", *empty, "-o", tmp_path / "hand")
    copy = logs / "copy.csv"
    copy.write_bytes(Path(empty[0]).read_bytes())
    thrice = said(capsys, "train", "gravity", *empty, copy, "-o", tmp_path / "thrice")
    assert thrice["weighings"] == 2 and any("copy.csv is the same file as" in note for note in thrice["notes"])
    assert learned["simulated"] and learned["weight_n"] == pytest.approx(0.04 * 9.80665, rel=0.1) and len(learned["made_from"]) == 2
    left = learned["held_out"]
    assert left["after"]["force_n"] < left["before"]["force_n"] / 5 and left["after"]["moment_nmm"] < left["before"]["moment_nmm"] / 5
    assert main(["force", "run", "gravity", str(logs / "mid.csv"), "-o", str(tmp_path / "no")]) == 1
    assert "there are 2 poses, and 3 are needed" in capsys.readouterr().err
    model = tmp_path / "hand" / "model.npz"
    (found,) = said(capsys, "run", "gravity", logs / "mid.csv", "-o", tmp_path / "out", "--model", model)["objects"]
    assert np.linalg.norm(np.subtract(found["centre_mm"], PAPER_TRUTH[0])) < 3 * found["worst_sd_mm"] + 1.5
    assert found["mass_kg"] == pytest.approx(0.17, abs=5 * found["mass_sd_kg"])
    assert main(["force", "run", "gravity", str(empty[0]), "-o", str(tmp_path / "no"), "--model", str(model)]) == 1
    assert "no more than the empty hand" in capsys.readouterr().err
    # The same hand, simulated without weighings, is the same hand: what it holds weighs as much.
    said(capsys, "simulate", "gravity", "-o", tmp_path / "balls", "--seed", "1")
    (ball,) = said(capsys, "run", "gravity", tmp_path / "balls" / "mid.csv", "-o", tmp_path / "again", "--model", model)["objects"]
    assert ball["mass_kg"] == pytest.approx(0.17, abs=3 * ball["mass_sd_kg"]) and ball["mass_sd_kg"] < 0.012
    assert main(["force", "run", "gravity", str(tmp_path / "balls" / "mid.csv"), "-o", str(tmp_path / "alone")]) == 0
    assert " g with the fingertips; 10 poses" in capsys.readouterr().out


def test_gravity_of_moments_in_n_m_is_refused_unless_their_unit_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = hold(seed=1).log
    write_wrench(replace(log, moment=log.moment / 1000), tmp_path / "a.csv")
    assert main(["force", "run", "gravity", str(tmp_path / "a.csv"), "-o", str(tmp_path / "out")]) == 1
    assert "so the moments are in N m" in capsys.readouterr().err
    text = (tmp_path / "a.csv").read_text().replace("Mx,My,Mz", "Mx (N m),My (N m),Mz (N m)")
    (tmp_path / "b.csv").write_text(text)
    (found,) = said(capsys, "run", "gravity", tmp_path / "b.csv", "-o", tmp_path / "out")["objects"]
    assert np.linalg.norm(np.subtract(found["centre_mm"], PAPER_TRUTH[0])) < 1.5


def test_poor_poses_are_refused_and_nothing_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said(capsys, "simulate", "gravity", "-o", tmp_path / "logs", "--span", "1")
    assert main(["force", "run", "gravity", str(tmp_path / "logs" / "mid.csv"), "-o", str(tmp_path / "out")]) == 3
    error = capsys.readouterr().err
    assert "mid.csv" in error and "turn the hand farther" in error and not (tmp_path / "out").exists()


def test_liquids(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = said(capsys, "simulate", "liquid", "-o", tmp_path / "logs", "--trials", "1")
    result = said(capsys, "run", "liquid", *made["files"], "-o", tmp_path / "out")
    assert [cup["liquid"] for cup in result["cups"]] == [cup["label"] == "liquid" for cup in result["cups"]]
    assert (tmp_path / "out" / "liquid.png").is_file()
    rows = (tmp_path / "out" / "liquid.csv").read_text().splitlines()
    assert len(rows) == 1 + len(made["files"]) and rows[0].startswith("log,answer,chance") and rows[1].split(",")[1] == "solid or empty"


def test_a_limit_is_learned_from_empty_cups_and_used(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    made = said(capsys, "simulate", "liquid", "-o", tmp_path / "logs", "--trials", "2", "--seconds", "12")["files"]
    empty = [name for name in made if "-0-g-" in name]
    learned = said(capsys, "train", "liquid", *empty, "-o", tmp_path / "learned", "--false-alarm", "0.1", "--seconds", "3")
    assert learned["simulated"] and learned["pieces"] == 16 and learned["logs"] == 4 and 0 < learned["limit"] < 0.5
    assert set(learned["held_out_false_alarm"]) == {"value", "low", "high"} and len(learned["made_from"]) == 4
    result = said(capsys, "run", "liquid", *made, "--model", tmp_path / "learned" / "model.npz", "-o", tmp_path / "out")
    assert result["learned"] and result["limit"] == learned["limit"] and result["false_alarm"] == 0.1
    assert all(cup["liquid"] for cup in result["cups"] if cup["label"] == "liquid")
    assert main(["force", "run", "liquid", made[0], "--model", made[0], "-o", str(tmp_path / "no")]) == 1
    assert "is not a whole model" in capsys.readouterr().err
    assert main(["force", "train", "liquid", *map(str, made), "-o", str(tmp_path / "no")]) == 1
    assert "says that it holds a liquid" in capsys.readouterr().err and not (tmp_path / "no").exists()


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        (["run"], 2, "TOPIC"),
        (["train", "gravity", "-o", "x"], 2, "LOG"),
        (["train", "contact", "a.csv", "-o", "x"], 2, "--places"),
        (["train", "liquid", "a.csv", "-o", "x", "--false-alarm", "1"], 2, "1 is not below 1"),
        (["train", "liquid", "a.csv", "-o", "x", "--seconds", "2"], 2, "shorter than the 3 s"),
        (["run", "texture", "a.csv", "-o", "x"], 2, "--model"),
        (["run", "gravity", "nothing.csv", "-o", "x"], 1, "nothing.csv"),
        (["run", "gravity", "a.csv", "--max-sd", "-1", "-o", "x"], 2, "not a positive number"),
        (["bench", "smell", "-o", "x"], 2, "'smell' is not measured"),
        (["run", "gravity", "a.csv", "--spann", "3", "-o", "x"], 2, "'--spann' is not known here"),
    ],
)
def test_wrong_usage(
    arguments: list[str], status: int, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["force", *arguments]) == status
    assert says in capsys.readouterr().err and not list(tmp_path.iterdir())


def test_an_input_is_never_replaced(slides: Path, model: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "texture.csv"
    log.write_text(sorted(slides.iterdir())[0].read_text())
    before = log.read_bytes()
    assert main(["force", "run", "texture", str(log), "--model", str(model), "-o", str(tmp_path)]) == 1
    assert "would be replaced" in capsys.readouterr().err and log.read_bytes() == before
