"""After a crash the work is there."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from gui.state.autosave import Autosave, left_over
from skinfab.document import save_skin
from skinfab.errors import InputError
from skinfab.mesh.model import Mesh
from skinfab.skin import Skin, Source

V, F = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])
SKIN = Skin(Mesh(V, F, "flat"), Source("flat.obj", "0" * 64, "mm", 1.0), np.zeros((0, 2), dtype=np.int64), ())


@pytest.fixture
def autosave(tmp_path):
    complaints = []
    kept = Autosave(tmp_path, failed=complaints.append)
    kept.complaints = complaints
    yield kept
    kept.close()


def orphan(folder):
    """Make the copies look as if their process were gone."""
    for file in [*folder.glob("*.skin"), *folder.glob("*.json")]:
        file.rename(folder / f"999999999-{file.name.split('-')[1]}")


def test_the_newest_state_is_kept(autosave, tmp_path):
    for seed in range(5):
        autosave.keep(replace(SKIN, seed=seed), Path("/lab/cup.skin"))
    assert autosave.settle()
    assert left_over(tmp_path) == [], "this process still runs"
    orphan(tmp_path)
    (left,) = left_over(tmp_path)
    assert left.load().seed == 4 and left.path == Path("/lab/cup.skin") and abs(left.when - time.time()) < 60
    left.discard()
    assert left_over(tmp_path) == [] and not list(tmp_path.glob("*.skin")) and not list(tmp_path.glob("*.json"))


def test_nothing_is_left_of_what_was_saved(autosave, tmp_path):
    autosave.keep(SKIN, None)
    autosave.settle()
    autosave.drop()
    assert [p.suffix for p in tmp_path.iterdir()] == [".lock"], "held until the end"
    autosave.close()
    assert list(tmp_path.iterdir()) == []


def test_a_process_number_that_came_again_hides_nothing(tmp_path):
    """In a container the window often has the number that the one which crashed had."""
    crashed = tmp_path / f"{os.getpid()}-abcd.skin"
    save_skin(SKIN, crashed)
    crashed.with_suffix(".lock").touch()
    assert [left.file for left in left_over(tmp_path)] == [crashed]


def test_a_full_disk_is_said_and_the_next_copy_tried(autosave, tmp_path, monkeypatch):
    import gui.state.autosave as module

    def full(skin, path):
        raise InputError(f"cannot write {path}: the disk is full; free some space and run again")

    with monkeypatch.context() as patch:
        patch.setattr(module, "save_skin", full)
        autosave.keep(SKIN, None)
        assert autosave.settle()
    assert "the disk is full" in autosave.complaints[0]
    autosave.keep(SKIN, None)
    assert autosave.settle() and len(list(tmp_path.glob("*.skin"))) == 1


def test_a_damaged_copy_is_refused_in_a_sentence(tmp_path):
    (tmp_path / "999999999-00.skin").write_bytes(b"PK\x03\x04")
    (left,) = left_over(tmp_path)
    with pytest.raises(InputError, match="not a whole skin document"):
        left.load()


def test_what_a_killed_process_was_at_is_there(tmp_path):
    script = (
        "import sys, time; sys.path[:0] = [sys.argv[2], '.']; from pathlib import Path; from dataclasses import replace\n"
        "from test_autosave import SKIN; from gui.state.autosave import Autosave\n"
        "kept = Autosave(Path(sys.argv[1]), failed=print)\n"
        "kept.keep(replace(SKIN, seed=7), None); kept.settle(); print('kept', flush=True); time.sleep(60)\n"
    )
    child = subprocess.Popen([sys.executable, "-c", script, str(tmp_path), str(Path(__file__).parent)], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "kept\n"
    os.kill(child.pid, signal.SIGKILL)
    child.communicate()
    (left,) = left_over(tmp_path)
    assert left.load().seed == 7 and left.path is None
