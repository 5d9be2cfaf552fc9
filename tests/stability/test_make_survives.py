"""The main job on broken files, interrupted, and on a full disk: one answer, nothing half-written."""

import os
import re
import runpy
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import results

from skinfab.cli.main import main
from skinfab.errors import InputError
from skinfab.mesh.door import load_usable

ROOT = Path(__file__).parents[2]
SKINFAB = Path(sys.executable).with_name("skinfab")
CASES = runpy.run_path(str(Path(__file__).with_name("broken_meshes.py")))["all_cases"]()
HANG_S = 10


def left_in(folder: Path) -> list[str]:
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*")) if folder.exists() else []


@pytest.fixture(scope="module")
def made() -> dict[bytes, str]:
    """The meshes that were made into skins, and of which file: a third of the files are the same mesh once they are cleaned."""
    return {}


def mesh_of(path: Path) -> bytes | None:
    """What is left of a file at the door: its triangles, to 1e-4 mm and in whatever order they come; None where it is refused there."""
    try:
        mesh = load_usable(path).mesh
    except InputError:
        return None
    corners = mesh.V.round(4)[mesh.F] + 0.0  # no -0.0
    first = np.array([min(range(3), key=lambda k: triangle[k].tolist()) for triangle in corners])
    turned = np.take_along_axis(corners, ((first[:, None] + np.arange(3)) % 3)[:, :, None], axis=1).reshape(-1, 9)
    return turned[np.lexsort(turned.T[::-1])].tobytes()


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.file)
def test_broken_meshes(case, made: dict[bytes, str], tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / case.file).write_bytes(case.data)
    mesh = mesh_of(tmp_path / case.file)
    if mesh is not None and made.setdefault(mesh, case.file) != case.file:
        assert case.fate in ("as is", "cleaned")
        return
    # Time of this process, not of the wall: other tests run beside it.
    began = time.process_time()
    status = main(["make", str(tmp_path / case.file), "-o", str(tmp_path / "out")])
    assert time.process_time() - began < HANG_S
    error = capfd.readouterr().err
    assert "Traceback" not in error and "fault of skinfab" not in error and "nan" not in error.lower().split()
    if status == 0:
        report = results.read_report(tmp_path / "out")
        assert report["distortion"]["mean"] <= 4.05
        for file in (tmp_path / "out").rglob("*"):
            if file.suffix in (".obj", ".svg", ".gcode", ".json"):
                assert not any(word in file.read_text().lower() for word in (" nan", "nan ", "inf ", "infinity"))
    else:
        assert status in (1, 3)
        faults = [line for line in error.splitlines() if not line.startswith("note: ")]
        assert len(faults) == 1 and faults[0].startswith("skinfab: ") and len(faults[0]) < 400
        assert not (tmp_path / "out").exists()
    if case.fate in ("refused", "repaired"):
        assert status == 1


def catches(pid: int, number: int) -> bool:
    """Whether a process has a handler for a signal."""
    caught = re.search(r"^SigCgt:\s*(\w+)", Path(f"/proc/{pid}/status").read_text(), re.M)
    return caught is not None and bool(int(caught[1], 16) >> (number - 1) & 1)


def worked_s(pid: int) -> float:
    """Processor time that a process has had, s: where it is in its work, however busy the machine."""
    user, system = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


# What comes before the command is Python's: that it has a handler for SIGTERM is the command's first own doing.
@pytest.mark.parametrize(
    ("after_s", "number"),
    [(0.0, signal.SIGINT), (0.0, signal.SIGTERM), (0.5, signal.SIGTERM), (1.0, signal.SIGINT), (2.0, signal.SIGTERM), (3.0, signal.SIGINT)],
)
def test_interrupted(after_s: float, number: int, tmp_path: Path) -> None:
    out = tmp_path / "out"
    job = subprocess.Popen(
        [SKINFAB, "make", ROOT / "meshes/cup.obj", "-o", out], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True
    )
    while job.poll() is None and not (catches(job.pid, signal.SIGTERM) and worked_s(job.pid) >= after_s):
        time.sleep(0.002)
    job.send_signal(number)
    _, error = job.communicate(timeout=30)
    if job.returncode == 0:
        # It was through already: then everything is there.
        results.read_report(out)
        return
    assert job.returncode == 130, error
    assert "Traceback" not in error
    assert left_in(out) == []


#: Makes the cube into folder after folder, each with a limit, and says what came of it: one start for all, and a small preview.
LIMITED = """
import resource, signal, sys
from skinfab.cli.main import main
from skinfab.report import preview

preview._DPI = 40
mesh, *folders = sys.argv[1:]
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
for folder in folders:
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(folder.rpartition("/")[2]), resource.RLIM_INFINITY))
    print("status", main(["make", mesh, "-o", folder]), file=sys.stderr)
"""


def test_no_room_for_a_file(tmp_path: Path) -> None:
    """The kernel refuses to let any file grow past a limit, as it does on a full disk."""
    folders = [tmp_path / str(most_bytes) for most_bytes in (0, 1_000, 30_000, 100_000)]
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, ROOT / "meshes/cube.obj", *folders],
        capture_output=True,
        text=True,
        timeout=120,
        env={**os.environ, "NUMBA_CACHE_DIR": "", "MPLCONFIGDIR": str(tmp_path / "mpl")},
    )
    assert done.returncode == 0, done.stderr
    *said, rest = re.split(r"^status (\d)\n", done.stderr, flags=re.M)
    assert said[1::2] == ["1"] * len(folders) and rest == ""
    for text, folder in zip(said[::2], folders, strict=True):
        assert text.splitlines()[-1].startswith(f"skinfab: cannot write {folder}")
        assert left_in(folder) == []


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can mount a small file system")
def test_full_disk(tmp_path: Path) -> None:
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=200k", "tmpfs", disk], capture_output=True, text=True)
    if mounted.returncode:
        pytest.skip(f"no small file system can be mounted here: {mounted.stderr.strip()}")
    try:
        done = subprocess.run(
            [SKINFAB, "make", ROOT / "meshes/robot_finger.obj", "-o", disk / "out"], capture_output=True, text=True, timeout=120
        )
        assert done.returncode == 1
        assert done.stderr.splitlines()[-1].startswith("skinfab: cannot write") and "disk is full" in done.stderr
        assert left_in(disk) == []
    finally:
        subprocess.run(["umount", disk], check=True)


@pytest.fixture(scope="module")
def two_pieces(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What is made of the cube with a cut round one side."""
    folder = tmp_path_factory.mktemp("cube")
    (folder / "cuts.txt").write_text("0 1\n1 3\n3 2\n2 0\n")
    words = ["make", str(ROOT / "meshes/cube.obj"), "--cuts", str(folder / "cuts.txt"), "--complete", "-o", str(folder / "out")]
    assert main(words) == 0
    assert len(results.read_report(folder / "out")["pieces"]) == 2
    return folder / "out"


def test_an_earlier_result_survives_a_failed_run(two_pieces: Path, tmp_path: Path) -> None:
    out = two_pieces
    before = {p: p.read_bytes() for p in out.rglob("*") if p.is_file()}
    (tmp_path / "bad.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
    assert main(["make", str(tmp_path / "bad.obj"), "-o", str(out)]) == 1
    assert {p: p.read_bytes() for p in out.rglob("*") if p.is_file()} == before


def test_a_second_run_leaves_no_stale_piece(two_pieces: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    shutil.copytree(two_pieces, out)
    (out / "gcode/mine.gcode").write_text("; my own\n")
    assert main(["make", str(ROOT / "meshes/cube.obj"), "-o", str(out)]) == 0
    listed = {entry["file"] for part in ("gcode", "moulds") for entry in results.read_report(out)[part]}
    assert {str(p.relative_to(out)) for f in ("gcode", "mould") for p in (out / f).iterdir()} == listed | {"gcode/mine.gcode"}
