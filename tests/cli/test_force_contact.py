"""`skinfab force simulate|run contact`: logs to contacts and events, and the ways in which it is used wrongly."""

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from interrupts import pressed_twice

from skinfab.cli.main import main
from skinfab.fingertip.force.motion import MotionWatch
from skinfab.fingertip.force.motion_simulator import grasp_log
from skinfab.fingertip.force.wrench import force_stream
from skinfab.readout.frame import Recording
from skinfab.readout.packets import FRAME_64
from skinfab.readout.pty_server import PtyServer


def said(capsys: pytest.CaptureFixture[str], *arguments: object) -> dict[str, Any]:
    """Run with --json: one object on standard output, and nothing else."""
    assert main(["force", *map(str, arguments), "--json"]) == 0
    result: dict[str, Any] = json.loads(capsys.readouterr().out)
    return result


@pytest.fixture(scope="module")
def grasps(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("grasps")
    assert main(["force", "simulate", "contact", "-o", str(folder), "--grasps", "2", "--seed", "40"]) == 0
    return folder


def test_from_logs_to_contacts_and_events(grasps: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logs = sorted(grasps.glob("grasp-*.csv"))
    assert len(logs) == 2 and logs[0].read_text().startswith("# simulated: true\n")
    result = said(capsys, "run", "contact", *logs, "--truth", grasps / "truth.csv", "-o", tmp_path)
    assert result["simulated"] and result["evaluation"]["all"]["recall"]["value"] > 0.8 < result["evaluation"]["all"]["precision"]["value"]
    assert sorted(each.name for each in tmp_path.iterdir()) == ["contact.png", "contacts.csv", "events.csv", "result.json"]
    rows = list(csv.DictReader((tmp_path / "contacts.csv").read_text().splitlines()))
    assert len(rows) == sum(log["samples"] for log in result["logs"].values()) and {row["simulated"] for row in rows} == {"1"}
    on = np.array([[float(row[name]) for name in ("x_mm", "y_mm", "z_mm")] for row in rows])
    np.testing.assert_allclose(np.linalg.norm(on, axis=1), 20, atol=1e-3)
    events = list(csv.DictReader((tmp_path / "events.csv").read_text().splitlines()))
    assert len(events) == sum(len(log["events"]) for log in result["logs"].values())
    assert json.loads((tmp_path / "result.json").read_text()) == result


def test_a_mesh_stands_for_the_dome(grasps: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    import trimesh

    trimesh.creation.icosphere(subdivisions=4, radius=20).export(tmp_path / "tip.stl")
    log = grasps / "grasp-40.csv"
    dome = said(capsys, "run", "contact", log, "-o", tmp_path / "dome")
    mesh = said(capsys, "run", "contact", log, "--tip", tmp_path / "tip.stl", "-o", tmp_path / "mesh")
    kinds = [[event["kind"] for event in result["logs"]["grasp-40.csv"]["events"]] for result in (dome, mesh)]
    assert kinds[0] == kinds[1]


def test_what_is_said_without_json(grasps: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["force", "run", "contact", str(grasps / "grasp-40.csv"), "-o", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert "grasp-40.csv (simulated): touched in" in out and "x sliding" in out


@pytest.mark.parametrize(
    ("arguments", "status", "says"),
    [
        (["run", "contact"], 2, "give logs, or a --port"),
        (["run", "contact", "LOG", "--port", "/dev/null"], 2, "give logs, or a --port"),
        (["run", "contact", "LOG", "--seconds", "3"], 2, "--seconds is for a --port"),
        (["run", "contact", "LOG", "--friction", "90"], 2, "not below 90"),
        (["run", "contact", "LOG", "--radius", "10", "--tip", "a.stl"], 2, "two fingertips"),
        (["run", "contact", "LOG", "--tare", "2"], 1, "something touches"),
        (["run", "contact", "LOG", "LOG"], 1, "two logs are called"),
        (["run", "contact", "missing.csv"], 1, "missing.csv"),
        (["run", "contact", "LOG", "--truth", "LOG"], 1, "no table of events"),
    ],
)
def test_wrong_use_is_told(
    arguments: list[str], status: int, says: str, grasps: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [str(grasps / "grasp-40.csv") if word == "LOG" else word for word in arguments]
    assert main(["force", *words, "-o", str(tmp_path / "out")]) == status
    error = capsys.readouterr().err
    assert says in error and "Traceback" not in error and not (tmp_path / "out").exists()


def test_a_truth_without_the_log_is_refused(grasps: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "truth.csv").write_text("log,kind,start_s,end_s\nother.csv,sliding,1,2\n")
    arguments = ["run", "contact", str(grasps / "grasp-40.csv"), "--truth", str(tmp_path / "truth.csv"), "-o", str(tmp_path / "out")]
    assert main(["force", *arguments]) == 1
    assert "no event of grasp-40.csv" in capsys.readouterr().err
    (tmp_path / "truth.csv").write_text("log,kind,start_s,end_s\ngrasp-40.csv,sliding,2,1\n")
    assert main(["force", *arguments]) == 1
    assert "row 1" in capsys.readouterr().err


def test_a_time_that_runs_backwards_is_told(grasps: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = (grasps / "grasp-40.csv").read_text().splitlines()
    (tmp_path / "back.csv").write_text("\n".join([*lines[:3000], *lines[3400:2999:-1], *lines[3401:]]) + "\n")
    result = said(capsys, "run", "contact", tmp_path / "back.csv", "-o", tmp_path / "out")
    assert any("does not go on at 400 samples" in note for note in result["notes"])


def test_a_log_is_not_replaced(grasps: Path, tmp_path: Path) -> None:
    (tmp_path / "contacts.csv").write_text((grasps / "grasp-40.csv").read_text())
    before = (tmp_path / "contacts.csv").read_bytes()
    assert main(["force", "run", "contact", str(tmp_path / "contacts.csv"), "-o", str(tmp_path)]) == 1
    assert (tmp_path / "contacts.csv").read_bytes() == before


def altered(log: Path, path: Path, columns: slice, factor: float) -> Path:
    """The log with some of its columns multiplied."""
    head, *rows = [line for line in log.read_text().splitlines() if not line.startswith("#")]
    table = np.array([[float(x) for x in row.split(",")] for row in rows])
    table[:, columns] *= factor
    path.write_text("\n".join([head, *(",".join(f"{x:.7g}" for x in row) for row in table)]))
    return path


def test_a_flipped_sign_is_asked_about(grasps: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = altered(grasps / "grasp-40.csv", tmp_path / "flipped.csv", slice(1, 7), -1.0)
    assert main(["force", "run", "contact", str(log), "-o", str(tmp_path / "out")]) == 0
    said = capsys.readouterr()
    assert "is the force's sign that of the force on the fingertip" in said.err and "where the force's line misses the surface" in said.out
    right = grasps / "grasp-40.csv"
    assert main(["force", "run", "contact", str(right), "-o", str(tmp_path / "right")]) == 0
    assert "sign" not in capsys.readouterr().err


def test_moments_in_newton_metres_are_refused(grasps: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = altered(grasps / "grasp-40.csv", tmp_path / "metres.csv", slice(4, 7), 0.001)
    assert main(["force", "run", "contact", str(log), "-o", str(tmp_path / "out")]) == 1
    assert "the moments are in N m" in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_a_second_ctrl_c_loses_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log, _ = grasp_log(seed=3, episodes=1)
    values = np.column_stack([log.force, log.moment])
    made = Recording.of_values(force_stream("fingertip", 200.0, simulated=True), values, device_time=np.arange(len(log)) / 200)
    with (
        PtyServer(made.stream, made, rate_hz=0, kind=FRAME_64) as device,
        pressed_twice(MotionWatch, "skinfab.fingertip.force.motion_figure.draw_motions", after=400),
    ):
        result = said(capsys, "run", "contact", "--port", device.path, "--seconds", 60, "-o", tmp_path)
    assert json.loads((tmp_path / "result.json").read_text()) == result
    assert sorted(each.name for each in tmp_path.iterdir()) == ["contact.png", "contacts.csv", "events.csv", "result.json"]
    assert len((tmp_path / "contacts.csv").read_text().splitlines()) == 1 + 400
