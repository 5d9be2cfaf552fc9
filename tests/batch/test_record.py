"""A record is read as it was written, or one sentence says what to remove."""

import json
from pathlib import Path
from typing import Any

import pytest

from skinfab.batch.job import Home
from skinfab.batch.record import read_record
from skinfab.errors import InputError

WHOLE: dict[str, Any] = {
    "job": "n",
    "mesh": "/a.obj",
    "settings": {"pieces": "fewest", "repair": True},
    "limits": {"time_s": 60.0, "memory_mb": None},
    "skinfab": "1.0",
    "host": "here",
    "wall_s": 1.5,
    "status": "made",
    "message": "",
    "figures": {"n_faces": 12, "d_mean": 4.01},
    "attempts": 1,
}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = Home(tmp_path).record("n")
    path.parent.mkdir(parents=True)
    return path


def test_what_was_written(path: Path) -> None:
    ended = {**WHOLE, "status": "lost", "message": "é"}
    del ended["figures"], ended["wall_s"]
    for record in (WHOLE, ended):
        path.write_text(json.dumps(record))
        assert read_record(path, "n") == record


def test_a_folder_without_a_record_is_told_before_another_is_made_for_it(path: Path) -> None:
    """The result was made, and thrown away as it could not be put there."""
    assert read_record(path, "n") is None  # an empty one makes room
    assert read_record(path.parent / "m/job.json", "m") is None
    (path.parent / "report.html").touch()
    with pytest.raises(InputError, match=r"jobs/n has no job.json; remove .*jobs/n, and the job is done again$"):
        read_record(path, "n")
    (path.parent.parent / "m").touch()
    (path.parent.parent / "k").symlink_to(path.parent / "away")
    for name in ("m", "k"):
        with pytest.raises(InputError, match=f"jobs/{name} has no job.json"):
            read_record(path.parent.parent / name / "job.json", name)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ("{", "is damaged (Expecting"),
        ("\udcff", "is damaged ("),
        ("[" * 20_000, "is damaged (its brackets are nested too deep)"),
        ("[]", "is not the record of job n"),
        ({"job": "another"}, "is not the record of job n"),
        ({"status": "?"}, "is not the record of job n"),
        ({"status": "not run"}, "is not the record of job n"),
        ({"status": ["made"]}, "is not the record of job n"),
        ({"message": None}, "damaged (message is not what was written)"),
        ({"skinfab": 1}, "damaged (skinfab"),
        ({"limits": {"time_s": 1}}, "damaged (limits"),
        ({"limits": {"time_s": "1", "memory_mb": None}}, "damaged (limits"),
        ({"wall_s": None}, "damaged (wall_s"),
        ({"peak_mb": True}, "damaged (peak_mb"),
        ({"figures": []}, "damaged (figures"),
        ({"figures": {"d_mean": "x"}}, "damaged (figures"),
        ({"figures": {"d_mean": float("nan")}}, "damaged (NaN is not a number)"),
        ({"figures": {"d_mean": 10**400}}, "is too large a number)"),
        ({"more": {"a": {"b": 1}}}, "damaged (more"),
    ],
)
def test_a_damaged_record_says_what_to_remove(path: Path, wrong: Any, says: str) -> None:
    path.write_text(wrong if isinstance(wrong, str) else json.dumps({**WHOLE, **wrong}), errors="surrogateescape")
    with pytest.raises(InputError) as told:
        read_record(path, "n")
    assert says in str(told.value) and str(told.value).endswith(f"; remove {path.parent}, and the job is done again")


def test_one_that_cannot_be_read(path: Path) -> None:
    path.mkdir()
    with pytest.raises(InputError, match=r"cannot read .*job.json \(Is a directory\); remove"):
        read_record(path, "n")
