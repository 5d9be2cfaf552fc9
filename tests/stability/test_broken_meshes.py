"""Every broken file: one answer, in time, of one line where it cannot be used."""

import json
import runpy
import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from skinfab.cli.main import main
from skinfab.errors import InputError
from skinfab.mesh.door import load_usable
from skinfab.mesh.fans import corner_fans, winding

BROKEN = runpy.run_path(str(Path(__file__).with_name("broken_meshes.py")))
CASES = BROKEN["all_cases"]()
HANG_S = 10


@pytest.fixture(autouse=True)
def _no_hang() -> Iterator[None]:
    def too_long(*_: object) -> None:
        raise TimeoutError(f"no answer in {HANG_S} s")

    before = signal.signal(signal.SIGALRM, too_long)
    signal.alarm(HANG_S)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def _written(case, folder: Path) -> Path:
    path = folder / case.file
    path.write_bytes(case.data)
    return path


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.file)
def test_inspect_answers(case, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    status = main(["inspect", str(_written(case, tmp_path)), "--json"])
    out, err = capfd.readouterr()
    if case.fate in ("as is", "cleaned"):
        assert (status, err) == (0, "")
        assert json.loads(out)["usable"] is True
        assert bool(json.loads(out)["cleaning_does"]) == (case.fate == "cleaned")
    else:
        assert status == 1
        assert len(err.splitlines()) == 1 and len(err) < 400
        assert case.says in err
        assert out == "" or json.loads(out)["usable"] is False


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.file)
def test_what_passes_the_door_is_sound(case, tmp_path: Path) -> None:
    path = _written(case, tmp_path)
    if case.fate in ("refused", "repaired"):
        with pytest.raises(InputError) as caught:
            load_usable(path)
        assert case.says in str(caught.value)
        assert ("--repair" in str(caught.value)) == (case.fate == "repaired")
        if case.fate == "refused":
            with pytest.raises(InputError):
                load_usable(path, mend=True)
            return
    loaded = load_usable(path, mend=case.fate == "repaired")
    if case.fate == "cleaned":
        assert any(case.says in note for note in loaded.notes), loaded.notes
    mesh = loaded.mesh
    assert np.isfinite(mesh.V).all() and mesh.area > 0
    assert (np.unique(mesh.F) == np.arange(len(mesh.V))).all()
    assert mesh.topology.edge_count.max() <= 2
    assert corner_fans(mesh.topology)[0] == len(mesh.V)  # one fan a vertex
    assert not winding(mesh.topology).turn.any()


@pytest.mark.parametrize("case", [c for c in CASES if c.fate == "cleaned"], ids=lambda case: case.file)
def test_cleaning_twice_does_nothing_more(case, tmp_path: Path) -> None:
    from skinfab.mesh.repair import clean

    mesh = load_usable(_written(case, tmp_path)).mesh
    again, done = clean(mesh)
    assert done == [] and again is mesh


def test_the_cases_are_real(tmp_path: Path) -> None:
    """What a plain reader makes of some of them: NaN in silence, a face of a vertex that is not there."""
    import trimesh

    by_name = {case.file: case for case in CASES}
    held = trimesh.load(_written(by_name["nan.obj"], tmp_path), process=False)
    assert np.isnan(held.vertices).any()
    held = trimesh.load(_written(by_name["out_of_range.ply"], tmp_path), process=False)
    assert held.faces.max() >= len(held.vertices)


@pytest.mark.parametrize("name", ["nowhere.obj", "folder.obj", "folder"])
def test_paths_that_are_no_files(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "folder.obj").mkdir()
    (tmp_path / "folder").mkdir()
    assert main(["inspect", str(tmp_path / name)]) == 1
    out, err = capsys.readouterr()
    assert out == "" and len(err.splitlines()) == 1 and name in err
