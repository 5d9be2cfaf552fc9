"""`skinfab array`: the commands of docs/array.md, logs and a port, bench, and the ways in which it is used wrongly."""

import contextlib
import csv
import io
import json
import math
import re
import shlex
import shutil
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from interrupts import pressed_twice

from skinfab.bench import array as bench
from skinfab.cli.main import build_parser, main
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.learn import load_array
from skinfab.fingertip.array.protocols import presses, twirl
from skinfab.fingertip.array.simulator import Device
from skinfab.fingertip.array.watch import ArrayWatch
from skinfab.readout.frame import Recording
from skinfab.readout.logs.log import read_log, write_log
from skinfab.readout.pty_server import PtyServer

PAGE = Path(__file__).parents[2] / "docs/array.md"
RUN = ["array.png", "events.csv", "frames.csv", "result.json"]
TRAIN = ["errors.csv", "model.npz", "result.json", "train.png"]


def commands() -> list[list[str]]:
    """The page's, without `skinfab`."""
    (block,) = re.findall(r"```\n(skinfab array simulate.*?)```", PAGE.read_text(), re.DOTALL)
    return [shlex.split(line, comments=True)[1:] for line in block.splitlines()]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Logs of one simulated array, its model, and what a log of it says: by the page's commands, of fewer and shorter logs."""
    folder = tmp_path_factory.mktemp("array")
    simulate, train, run, *_ = commands()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        assert main([*simulate, "--logs", "2", "--contacts", "12", "--seed", "4", "--json"]) == 0
        logs = [name for word in train for name in (sorted(map(str, Path().glob(word))) if "*" in word else [word])]
        with contextlib.redirect_stdout(io.StringIO()) as said:
            assert main(logs) == 0
            assert main(run) == 0
    (folder / "said.txt").write_text(said.getvalue())
    return folder


def test_the_commands_of_the_page(made: Path) -> None:
    """The fixture runs the first three; a port and a benchmark are below."""
    assert [words[1] for words in commands()] == ["simulate", "train", "run", "run", "bench"]
    for words in commands():
        build_parser(words).parse_args(words)
    assert sorted(each.name for each in (made / "felt").iterdir()) == RUN


def test_the_pictures_of_the_page_are_there() -> None:
    for name in re.findall(r"\]\((pictures/[^)]+)\)", PAGE.read_text()):
        assert (PAGE.parent / name).stat().st_size > 10_000


def rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text().splitlines()))


def test_what_is_simulated_says_so(made: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = read_log(made / "logs/presses-1.csv")
    assert log.recording.stream.simulated and len(log.recording.stream.channels) == 68
    assert {each["simulated"] for each in rows(made / "logs/twirl-1-events.csv")} == {"1"}
    words = ["array", "simulate", "--density", "8x16", "--logs", "1", "--contacts", "1", "-o", str(made / "dense")]
    assert main(words) == 0 and "8x16" in capsys.readouterr().out
    assert len(read_log(made / "dense/presses-1.csv").recording.stream.channels) == 8 * 16 + 4


def test_the_same_seed_gives_the_same_logs(made: Path, tmp_path: Path) -> None:
    assert main(["array", "simulate", "--logs", "2", "--contacts", "12", "--seed", "4", "-o", str(tmp_path), "--json"]) == 0
    for each in tmp_path.iterdir():
        assert each.read_bytes() == (made / "logs" / each.name).read_bytes()


def test_held_out_errors_are_told(made: Path) -> None:
    assert sorted(each.name for each in (made / "model").iterdir()) == TRAIN
    result = json.loads((made / "model/result.json").read_text())
    assert result["simulated"] and [len(each["sha256"]) for each in result["made_from"]] == [64] * 4
    by = {(each["way"], each["quantity"]): each["rms"] for each in result["errors"]}
    assert by["learned", "axial"] < 0.3 * by["published", "axial"] and by["learned", "line"] < 0.5 * by["published", "line"]
    model, facts = load_array(made / "model/model.npz")
    assert model.geometry.skin == pytest.approx(3.8, abs=0.1) and facts["simulated"]
    said = (made / "said.txt").read_text()
    assert "on logs that were held out" in said and all(f"  {name}" in said for name in ("axial", "angle", "force", "line"))


def test_a_log_is_read(made: Path) -> None:
    result = json.loads((made / "felt/result.json").read_text())
    assert result["simulated"] and result["frames"] == 100 and sum(result["states"].values()) == 100
    true = rows(made / "logs/twirl-1-events.csv")
    assert [each["kind"] for each in result["events"]] == [each["kind"] for each in true]
    assert [each["kind"] for each in rows(made / "felt/events.csv")] == [each["kind"] for each in true]
    frames = rows(made / "felt/frames.csv")
    truth = read_log(made / "logs/twirl-1.csv").recording.column("axial_mm")[6:]
    off = [float(each["axial_mm"]) - x for each, x in zip(frames, truth.tolist(), strict=True) if each["axial_mm"] and math.isfinite(x)]
    assert np.sqrt(np.mean(np.square(off))) < 0.3 and {each["simulated"] for each in frames} == {"1"}


def test_pulls_along_the_skin_are_told(made: Path, tmp_path: Path) -> None:
    words = ["array", "run", str(made / "logs/pushes-1.csv"), "--model", str(made / "model/model.npz"), "-o", str(tmp_path / "o")]
    assert main([*words, "--json"]) == 0
    log, off = read_log(made / "logs/pushes-1.csv").recording, []
    force, along, around = (log.column(name)[15:] for name in ("force_n", "along_n", "around_n"))
    for k, each in enumerate(rows(tmp_path / "o/frames.csv")):
        if force[k] > 0:
            assert each["state"] == "point" and float(each["radius_mm"]) == 0 and each["line_deg"] == ""
            off += [float(each["tilt_along_deg"]) - math.degrees(math.atan2(along[k], force[k]))]
            off += [float(each["tilt_around_deg"]) - math.degrees(math.atan2(around[k], force[k]))]
    assert len(off) == 72 and np.sqrt(np.mean(np.square(off))) < 2.5


def test_several_contacts_are_told_each(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    device = Device(seed=4)
    a, b = device.skin.pressed(1.0, axial_mm=6.0, angle_rad=0.0), device.skin.pressed(1.2, axial_mm=18.0, angle_rad=1.2)
    Z = np.array([0 * a] * 18 + [a] * 10 + [a + b] * 10 + [b] * 10)
    volts = device.volts(Z, np.random.default_rng(0)).reshape(len(Z), -1)
    write_log(Recording.of_values(device.geometry.stream(simulated=True), volts, device_time=np.arange(len(Z)) / 15), tmp_path / "ab.csv")
    assert main(["array", "run", str(tmp_path / "ab.csv"), "-o", str(tmp_path / "o")]) == 0
    assert "events: 2 touch, 1 lift" in capsys.readouterr().out
    events = rows(tmp_path / "o/events.csv")
    assert [(each["kind"], each["contact"]) for each in events] == [("touch", "1"), ("touch", "2"), ("lift", "1")]
    both = [each for each in rows(tmp_path / "o/frames.csv") if each["state"] == "several"]
    assert len(both) == 10 and all(float(each["force_n"]) == pytest.approx(2.2, abs=0.1) for each in both)
    assert all(len(each["points"].split()) == 2 for each in both)
    assert json.loads((tmp_path / "o/result.json").read_text())["largest_force_n"] == pytest.approx(2.2, abs=0.1)


def test_without_a_model_the_array_is_as_drawn(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["array", "run", str(made / "logs/presses-1.csv"), "-o", str(tmp_path / "o"), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert json.loads((tmp_path / "o/result.json").read_text()) == result
    assert any("as drawn" in note for note in result["notes"]) and result["states"]["point"] >= 34


def test_a_port_is_read_as_it_comes(
    made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the page's command, into the folder where a log's results are."""
    (tmp_path / "model").symlink_to(made / "model")
    shutil.copytree(made / "felt", tmp_path / "felt")
    monkeypatch.chdir(tmp_path)
    recording, truth = twirl(Device(seed=4), seed=4001)
    with PtyServer(recording.stream, recording, rate_hz=0) as device:
        swapped = {"/dev/ttyACM0": str(device.path), "60": "8"}
        assert main([*(swapped.get(word, word) for word in commands()[3]), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["simulated"] and result["frames"] >= 95 and 0 < result["latency_ms"]["median"] <= result["latency_ms"]["worst"]
    assert [each["kind"] for each in result["events"]] == [each.kind for each in truth]


def test_a_port_that_sends_another_array(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recording = presses(Device(Geometry.of_density("8x16")), 4)
    with PtyServer(recording.stream, recording) as device:
        words = ["array", "run", "--port", str(device.path), "--model", str(made / "model/model.npz"), "-o", str(tmp_path / "o")]
        assert main(words) == 1
    assert "8 x 16 tactels, and the model 8 x 8" in capsys.readouterr().err and not (tmp_path / "o").exists()


def test_bench_writes_all_of_it(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench, "measure", partial(bench.measure, densities=("8x8",), devices=1, rods=1, layers=1))
    monkeypatch.setattr(bench, "track", partial(bench.track, logs=1))
    monkeypatch.setattr(bench, "ablation", partial(bench.ablation, devices=1, rods=1))
    monkeypatch.setattr(bench, "stood", partial(bench.stood, (1, 1), rates=(15.0,)))
    assert main(["array", "bench", "--repeats", "1", "-o", str(tmp_path), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    names = ["array.csv", "array.png", "array.txt", "array_ablation.csv", "array_seed.png", "array_still.csv", "array_twirl.csv"]
    assert result["simulated"] and [Path(file).name for file in result["files"]] == names
    assert all((tmp_path / name).stat().st_size for name in names)
    table = {(each["experiment"], each["method"]): each for each in result["rows"]}
    assert f"{table['along', 'matched']['worst']:.2g} matched" in result["sentence"]
    assert (tmp_path / "array.txt").read_text().splitlines()[0] == result["sentence"]
    terms = rows(tmp_path / "array_ablation.csv")
    first = terms[0]
    for each in terms[1:]:
        assert any(each[key] != first[key] for key in first if key != "term"), each["term"]  # else it would not be needed


@pytest.mark.parametrize(
    ("words", "status", "says"),
    [
        (["run", "-o", "o"], 2, "give a LOG or --port PORT"),
        (["run", "a.csv", "--port", "/dev/null", "-o", "o"], 2, "one of them"),
        (["run", "a.csv", "--seconds", "3", "-o", "o"], 2, "--seconds is for a port"),
        (["run", "missing.csv", "-o", "o"], 1, "missing.csv"),
        (["train", "missing.csv", "-o", "o"], 1, "missing.csv"),
        (["train", "x.csv", "--fill", "1.5", "-o", "o"], 2, "1.5"),
        (["simulate", "--density", "8", "-o", "o"], 1, "no density"),
        (["simulate", "--logs", "0", "-o", "o"], 2, "from 1 up"),
        (["bench", "--repeats", "0", "-o", "o"], 2, "from 1 up"),
        (["press", "-o", "o"], 2, "press"),
    ],
)
def test_wrong_usage(
    words: list[str], status: int, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["array", *words]) == status
    assert says in capsys.readouterr().err and not (tmp_path / "o").exists()


def test_logs_that_cannot_be_learned_from(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one = made / "logs/presses-1.csv"
    copy = tmp_path / "copy.csv"
    copy.write_bytes(one.read_bytes())
    out = ["-o", str(tmp_path / "o")]
    assert main(["array", "train", str(one), str(copy), *out]) == 1 and "the same log" in capsys.readouterr().err
    assert main(["array", "train", str(one), *out]) == 1 and "give two or more" in capsys.readouterr().err
    dense = presses(Device(Geometry.of_density("8x16")), 20)
    write_log(dense, tmp_path / "dense.csv")
    assert main(["array", "train", str(one), str(tmp_path / "dense.csv"), *out]) == 1
    assert f"{tmp_path}/dense.csv is of 8 x 16 tactels and {one} of 8 x 8; give logs of one array" in capsys.readouterr().err
    assert not (tmp_path / "o").exists()


def test_a_model_of_something_else(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "m.npz").write_bytes(b"\x80\x04 pickled")
    words = ["array", "run", str(made / "logs/presses-1.csv"), "--model", str(tmp_path / "m.npz"), "-o", str(tmp_path / "o")]
    assert main(words) == 1 and "pickle" in capsys.readouterr().err


def test_a_log_is_not_written_over(made: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recording = read_log(made / "logs/presses-1.csv").recording
    write_log(Recording.of_frames(recording.stream, list(recording)), tmp_path / "frames.csv")
    assert main(["array", "run", str(tmp_path / "frames.csv"), "-o", str(tmp_path)]) == 1
    assert "would be replaced" in capsys.readouterr().err


def test_a_second_ctrl_c_loses_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recording, _ = twirl(Device(seed=4), seed=4001)
    with (
        PtyServer(recording.stream, recording, rate_hz=0) as device,
        pressed_twice(ArrayWatch, "skinfab.fingertip.array.figure.draw_run", after=60),
    ):
        assert main(["array", "run", "--port", str(device.path), "--seconds", "60", "-o", str(tmp_path), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert json.loads((tmp_path / "result.json").read_text()) == result
    assert sorted(each.name for each in tmp_path.iterdir()) == ["array.png", "events.csv", "frames.csv", "result.json"]
    assert len((tmp_path / "frames.csv").read_text().splitlines()) == 1 + result["frames"] > 20
