"""The file of a batch: every list multiplies, and what is wrong in it is told with its line."""

import os
import shutil
from pathlib import Path

import pytest

from skinfab.batch.job import option_words
from skinfab.batch.plan import line_of, read_plan
from skinfab.cli.main import build_parser
from skinfab.errors import InputError


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "in").mkdir()
    for name in ("a.obj", "b.stl", "in/c.obj"):
        (tmp_path / name).write_text(name)
    (tmp_path / "one.toml").write_text("[auto]\n")
    return tmp_path


def plan(folder: Path, text: str) -> tuple[list[tuple[str, dict]], tuple[str, ...]]:
    (folder / "batch.toml").write_text(text)
    found = read_plan(folder / "batch.toml", output=folder / "out")
    return [(Path(job.mesh).name, dict(job.settings)) for job in found.jobs], found.notes


def test_meshes_times_settings(folder: Path) -> None:
    jobs, notes = plan(
        folder, 'meshes = ["**/*.obj", "b.stl", "a.obj"]\n[settings]\nmax-distortion = ["short", "4.20"]\nrepair = [false, true]\nseed = 7'
    )
    assert [name for name, _ in jobs] == ["a.obj"] * 4 + ["c.obj"] * 4 + ["b.stl"] * 4 and notes == ()
    assert [settings for _, settings in jobs[:4]] == [
        {"max-distortion": 4.1, "seed": 7},  # what is the default is left out
        {"max-distortion": 4.1, "repair": True, "seed": 7},
        {"max-distortion": 4.2, "seed": 7},
        {"max-distortion": 4.2, "repair": True, "seed": 7},
    ]


def test_every_setting_is_understood_by_make(folder: Path) -> None:
    text = 'meshes = "a.obj"\n[settings]\npieces = "fewest"\nthickness = 1\nscale = 2\nunits = "cm"\nsensors = "one.toml"\nwrap = 8.0'
    ((_, settings),), _ = plan(folder, text)
    args = build_parser(["make"]).parse_args(["make", "a.obj", "-o", "out", *option_words(settings)])
    assert (args.pieces, args.thickness, args.scale, args.units, args.wrap) == ("fewest", 1.0, 2.0, "cm", 8.0)
    assert args.sensors == folder / "one.toml"


def test_limits_are_of_the_jobs_and_not_of_their_names(folder: Path) -> None:
    names = set()
    for limits in ("", "[limits]\ntime_s = 5\nmemory_mb = 100"):
        (folder / "batch.toml").write_text(f'meshes = "a.obj"\n{limits}')
        (job,) = read_plan(folder / "batch.toml", output=folder / "out").jobs
        names.add(job.name)
    assert len(names) == 1 and (job.time_s, job.memory_mb) == (5.0, 100.0)


@pytest.mark.parametrize(
    ("pattern", "names"),
    [
        ("**/*.obj", ["a.obj", "c.obj", "d.obj"]),
        ("in/**/?.obj", ["c.obj", "d.obj"]),
        ("in/*/*", ["d.obj"]),
        ("in/../[ab].*", ["a.obj", "b.stl"]),
    ],
)
def test_patterns(folder: Path, pattern: str, names: list[str]) -> None:
    (folder / "in/.deep").mkdir()
    (folder / "in/.deep/d.obj").write_text("d")
    (folder / "in/.deep/around").symlink_to(folder)
    for text in (pattern, f"{folder}/{pattern}"):
        assert sorted(name for name, _ in plan(folder, f"meshes = {text!r}")[0]) == names


def test_a_folder_that_goes_away_meanwhile_is_passed_over(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Below / there are processes that end."""

    def listed(path: Path) -> list[str]:
        if Path(path).name == "in":
            shutil.rmtree(path)
        return listing(path)

    listing = os.listdir
    monkeypatch.setattr(os, "listdir", listed)
    assert plan(folder, "meshes = '**/*.obj'") == ([("a.obj", {})], ())


def test_results_are_no_meshes_and_the_same_is_done_once(folder: Path) -> None:
    (folder / "out/jobs/x").mkdir(parents=True)
    (folder / "out/jobs/x/flat.obj").write_text("v")
    (folder / "in/again.obj").write_text("a.obj")
    jobs, notes = plan(folder, 'meshes = ["**/*.obj"]\n[settings]\nseed = [1, 1.0, 2]'.replace("1.0", '"1"'))
    assert [name for name, _ in jobs] == ["a.obj"] * 2 + ["c.obj"] * 2
    assert notes == ("5 of 9 jobs are asked for twice (a.obj is the same as a.obj) and done once",)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("meshes = [", "batch.toml is not a TOML file"),
        ("", "meshes is missing"),
        ('\nmesh = ["a.obj"]', "line 2, mesh: it is not known here; did you mean meshes?"),
        ("meshes = []", "line 1, meshes: it must be a list of files or patterns"),
        ("meshes = [3]", "line 1, meshes: it must be a list"),
        ('meshes = ["*.ply"]', "line 1, meshes: '*.ply' matches no file in"),
        ('meshes = ["a**/b"]', "line 1, meshes: 'a**/b'"),
        ('meshes = ["a.obj"]\nsettings = 3', "line 2, settings: it must be a table; write [settings]"),
        ('meshes = "a.obj"\n[settings]\n\nmax_distortion = 4.1', "line 4, [settings] max_distortion: it is not known here; did you mean m"),
        ('meshes = "a.obj"\n[settings]\noutput = "x"', "line 3, [settings] output: it is not known here"),
        ('meshes = "a.obj"\n[settings]\npieces = ["usual", "most"]', "line 3, [settings] pieces: invalid choice: 'most'"),
        ('meshes = "a.obj"\n[settings]\nmax-distortion = 4', "line 3, [settings] max-distortion: 4 is not above 4"),
        ('meshes = "a.obj"\n[settings]\nseed = [[1]]', "line 3, [settings] seed: [1] is neither a text, a number, true nor false"),
        ('meshes = "a.obj"\n[settings]\nseed = true', "line 3, [settings] seed: True does not go here; it must be a text or a number"),
        ('meshes = "a.obj"\n[settings]\nrepair = "yes"', "line 3, [settings] repair: 'yes' does not go here; it must be true or false"),
        ('meshes = "a.obj"\n[settings]\nseed = []', "line 3, [settings] seed: the list is empty"),
        ('meshes = "a.obj"\n[settings]\nsensors = "two.toml"', "line 3, [settings] sensors: there is no file"),
        ('meshes = "a.obj"\n[settings]\nprinter = ["generic-grbl", "nope"]', "line 3, [settings] printer: no printer profile named 'nope'"),
        ('meshes = "a.obj"\n[settings]\nprinter = "one.toml"', "line 3, [settings] printer: printer profile"),
        ('meshes = "a.obj"\n[settings]\nmaterial = "nope"', "line 3, [settings] material: no material profile named 'nope'; there"),
        ('meshes = "a.obj"\n[settings]\nprinter = ""', "line 3, [settings] printer: it is empty; give a name or a file"),
        ('meshes = "a.obj"\n[settings]\nmaterial = ""', "line 3, [settings] material: it is empty; give a name or a file"),
        ('meshes = "a.obj"\n[settings]\ncuts = "in"', "/in is a folder; paths count from the folder of batch.toml"),
        ('meshes = "a.obj"\n[settings]\ncomplete = true', "[settings]: a.obj: --complete goes with --cuts"),
        ('meshes = "a.obj"\n[limits]\ntime = 3', "line 3, [limits] time: it is not known here; did you mean time_s?"),
        ('meshes = "a.obj"\n[limits]\nmemory_mb = 0', "line 3, [limits] memory_mb: 0 is not a positive number"),
        ('meshes = "a.obj"\n[limits]\ntime_s = nan', "line 3, [limits] time_s: nan is not a positive number"),
        (f'meshes = "a.obj"\n[settings]\nseed = {list(range(1001))}\nscale = {list(range(1, 1001))}', "1,001,000 jobs, more than"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_its_line(folder: Path, text: str, says: str) -> None:
    with pytest.raises(InputError) as told:
        plan(folder, text)
    assert says in str(told.value) and "\n" not in str(told.value)
    assert "batch.toml" in str(told.value)


def test_it_says_what_it_looks_for(folder: Path) -> None:
    """A pattern may have a whole disk to look through."""
    (folder / "batch.toml").write_text('meshes = ["**/*.obj", "b.stl"]')
    said: list[str] = []
    read_plan(folder / "batch.toml", output=folder / "out", progress=lambda fraction, label: said.append(label))
    assert said == ["looking for **/*.obj", "looking for b.stl", "reading 3 files"]


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read .*no\.toml: No such file"):
        read_plan(tmp_path / "no.toml", output=tmp_path)


@pytest.mark.parametrize(
    ("text", "table", "key", "line"),
    [
        ('a = 1\n["settings"]  # why\n  "pieces"=2', "settings", "pieces", 3),
        ("a = 1\nsettings.pieces = 2", "settings", "pieces", 2),
        ("[limits]\npieces = 1\n[settings]\npieces = 2", "settings", "pieces", 4),
        ("[settings]\nx = 1", "", "settings", 1),
    ],
)
def test_lines_are_found(text: str, table: str, key: str, line: int) -> None:
    assert line_of(text, table, key) == line
