"""The table, the page and the object say the same."""

import csv
import json
import os
import re
from pathlib import Path

from batches import quick_job

from skinfab.batch.job import Job
from skinfab.batch.plan import Plan
from skinfab.batch.run import Outcome
from skinfab.batch.table import write_tables


def test_counts_rows_and_links(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    made, bad = quick_job(tmp_path, "a"), quick_job(tmp_path / "in", "<b>")
    given = {"pieces": "fewest", "sensors": "/far/one.toml"}
    made = Job(made.name, made.mesh, given, ("sensors",))
    figures = {"n_faces": 1234, "n_pieces": 2, "d_mean": 4.01234, "seam_mm": 12.6}
    records = {
        made.name: {"job": made.name, "status": "made", "message": "", "figures": figures, "wall_s": 1.25, "attempts": 2},
        bad.name: {"job": bad.name, "status": "failed", "message": "no <faces>", "wall_s": 0.1, "attempts": 1},
    }
    plan = Plan((made, bad), ("pieces", "sensors"), {made.name: given, bad.name: {**given, "pieces": "usual"}}, ("one is the same",))
    found = write_tables(plan, Outcome(records, 1, ("left alone",)), tmp_path)
    assert found == json.loads((tmp_path / "batch.json").read_text())
    assert found["counts"] | {"made": 1, "failed": 1} == found["counts"] and sum(found["counts"].values()) == 2
    assert [job["folder"] for job in found["jobs"]] == [f"jobs/{made.name}", f"jobs/{bad.name}"]
    assert found["notes"] == ["one is the same", "left alone"]

    rows = list(csv.DictReader((tmp_path / "batch.csv").read_text().splitlines()))
    assert [(row["job"], row["status"], row["pieces"], row["n_pieces"], row["message"]) for row in rows] == [
        (made.name, "made", "fewest", "2", ""),
        (bad.name, "failed", "usual", "", "no <faces>"),
    ]
    assert (rows[0]["pieces"], rows[0]["sensors"], rows[0]["d_mean"], rows[0]["attempts"]) == ("fewest", "/far/one.toml", "4.01234", "2")

    page = (tmp_path / "batch.html").read_text()
    assert re.findall(r'href="([^"]*)"', page) == [f"jobs/{bad.name}/", f"jobs/{made.name}/report.html", f"jobs/{bad.name}/"]
    assert "no &lt;faces&gt;" in page and "<b>" not in page and "4.0123" in page and "1,234" in page and ">one.toml<" in page
    assert ">a.obj</a>" in page and ">in/&lt;b&gt;.obj</a>" in page
    assert "2 jobs (1 of them done before): 1 made, 1 whose input cannot be used" in page
    assert "<script" not in page and "http" not in page


def test_a_name_that_is_no_utf_8_is_shown_by_its_bytes(tmp_path: Path) -> None:
    job = Job("n", os.fsdecode(b"/in/\xe9.obj"), {})
    plan = Plan((job,), (), {"n": {}})
    write_tables(plan, Outcome({"n": {"job": "n", "status": "failed", "message": "no mesh"}}, 0, ()), tmp_path)
    assert (
        "n,/in/\\udce9.obj,failed," in (tmp_path / "batch.csv").read_text() and ">\\udce9.obj</a>" in (tmp_path / "batch.html").read_text()
    )
