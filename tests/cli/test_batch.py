"""`skinfab batch` as it is typed: interrupted, run again, and what is left of it."""

import csv
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import results
from batches import wait_for

from skinfab.cli.main import main

CUBE = Path(__file__).parents[2] / "meshes/cube.obj"
SKINFAB = Path(sys.executable).with_name("skinfab")


def test_interrupted_then_done_with_a_bad_mesh_among_them(tmp_path: Path) -> None:
    (tmp_path / "tetrahedron.obj").write_text("v 0 0 0\nv 20 0 0\nv 0 20 0\nv 0 0 20\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
    (tmp_path / "bad.obj").write_text("v 0 0\n")
    (tmp_path / "plan.toml").write_text('meshes = ["*.obj"]\n[settings]\nthickness = 2.0\n[limits]\ntime_s = 600\nmemory_mb = 4000\n')
    out = tmp_path / "out"
    words = [str(SKINFAB), "batch", "plan.toml", "-o", "out", "--workers", "1"]
    work = subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for(lambda: begun(out), 120)
    work.send_signal(signal.SIGINT)
    printed, complaint = work.communicate(timeout=60)
    assert (work.returncode, printed, complaint) == (130, "", "skinfab: interrupted; nothing half-written was left\n")
    assert [path.suffix for path in (out / ".under-way").iterdir()] == [".lock"] and not (out / "jobs").exists()
    broken = json.loads((out / "batch.json").read_text())
    assert broken["counts"]["not run"] == 2 and f'href="jobs/{broken["jobs"][0]["job"]}' not in (out / "batch.html").read_text()
    assert not any(Path(f"/proc/{pid}").exists() for pid in begun(out))

    done = subprocess.run([*words, "--json"], cwd=tmp_path, capture_output=True, text=True, timeout=300)
    assert done.returncode == 1
    assert done.stderr == "warning: 1 of 2 jobs has no result; out/batch.html says why\n"
    found = json.loads(done.stdout)
    assert found == json.loads((out / "batch.json").read_text())
    assert found["done_before"] == 0 and {k: n for k, n in found["counts"].items() if n} == {"made": 1, "failed": 1}
    bad, good = found["jobs"]
    assert "a vertex needs three numbers" in bad["message"]
    assert (bad["attempts"], good["attempts"]) == (2, 1)
    report = results.read_report(out / good["folder"])
    assert report["made_for"]["flattened_at_mm"] == 1.0 and good["figures"]["n_sensors"] == len(report["sensors"]) > 0
    rows = list(csv.DictReader((out / "batch.csv").read_text().splitlines()))
    assert [(row["status"], row["thickness"]) for row in rows] == [("failed", "2.0"), ("made", "2.0")]
    assert f'href="{good["folder"]}/report.html"' in (out / "batch.html").read_text()
    assert sorted(path.name for path in out.iterdir()) == [".lock", "batch.csv", "batch.html", "batch.json", "jobs", "jobs.jsonl"]


def begun(out: Path) -> list[int]:
    """Workers of the jobs that began."""
    return [int(path.read_text().split()[2]) for path in (out / ".under-way").glob("*.lock") if path.read_text()]


@pytest.mark.parametrize(
    ("words", "text", "status", "says"),
    [
        (["plan.txt"], "", 2, "'plan.txt' does not end in .toml"),
        (["plan.toml", "--workers", "0"], "", 2, "whole number from 1 up"),
        (["plan.toml", "--workers", "1", "--scheduler", "x"], "", 2, "not allowed with"),
        (["none.toml"], "", 1, "cannot read none.toml"),
        (["plan.toml"], 'meshes = ["*.obj"]', 1, "plan.toml, line 1, meshes: '*.obj' matches no file"),
        (["plan.toml"], 'meshes = ["plan.toml"]\n[settings]\nseeds = 1', 1, "line 3, [settings] seeds: it is not known here; did you"),
        (["plan.toml", "-o", "plan.toml/"], f'meshes = ["{CUBE}"]', 1, "plan.toml: it is a file, not a folder; choose another"),
    ],
)  # fmt: skip
def test_wrong_input_gets_one_line(
    words: list[str],
    text: str,
    status: int,
    says: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plan.toml").write_text(text)
    assert main(["batch", "-o", "out", *words]) == status
    assert says in capfd.readouterr().err.splitlines()[-1]
    assert os.listdir(tmp_path) == ["plan.toml"]
