"""Results appear whole or not at all: on success, on every kind of failure, and on Ctrl-C."""

import errno
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import pytest

from skinfab.errors import InputError
from skinfab.staging import staged_folder


def tree(folder: Path) -> dict[str, str]:
    return {str(p.relative_to(folder)): p.read_text() for p in folder.rglob("*") if p.is_file()}


def write_run(folder: Path, files: dict[str, str], *, moulds: tuple[str, ...] = ()) -> None:
    with staged_folder(folder) as stage:
        for name, content in files.items():
            (stage / name).parent.mkdir(exist_ok=True)
            (stage / name).write_text(content)
        listed = [{"file": name} for name in files if name.startswith("gcode/")]
        (stage / "report.json").write_text(json.dumps({"gcode": listed, "moulds": [{"file": m} for m in moulds]}))


def test_files_and_sub_folders_arrive(tmp_path: Path) -> None:
    out = tmp_path / "new" / "out"
    write_run(out, {"a.txt": "1", "gcode/P1.gcode": "G0"})
    assert tree(out).keys() == {"a.txt", "gcode/P1.gcode", "report.json"}
    assert sorted(p.name for p in out.iterdir()) == ["a.txt", "gcode", "report.json"]  # the stage is gone


def test_stale_files_of_an_earlier_run_go_and_the_users_stay(tmp_path: Path) -> None:
    write_run(tmp_path, {"gcode/P1.gcode": "1", "gcode/P2.gcode": "2", "toolpath/P1.svg": "1", "toolpath/P2.svg": "2"})
    (tmp_path / "gcode" / "mine.gcode").write_text("mine")
    (tmp_path / "toolpath" / "mine.svg").write_text("mine")
    (tmp_path / "notes.txt").write_text("mine")
    write_run(tmp_path, {"gcode/P1.gcode": "new", "toolpath/P1.svg": "new"})
    kept = tree(tmp_path)
    assert kept.keys() == {"gcode/P1.gcode", "gcode/mine.gcode", "toolpath/P1.svg", "toolpath/mine.svg", "notes.txt", "report.json"}
    assert kept["gcode/P1.gcode"] == "new"


@pytest.mark.parametrize(
    "name", ["notes.txt", "../outside.txt", "gcode/../notes.txt", "gcode/..", "mould/../../outside.txt", "/etc/x", "gcode/a/b"]
)
def test_a_doctored_report_reaches_nothing_else(name: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    write_run(out, {}, moulds=(name, "mould/P9.stl"))
    (out / "gcode" / "a").mkdir(parents=True)
    (out / "mould").mkdir()
    for file in [tmp_path / "outside.txt", out / "notes.txt", out / "gcode" / "a" / "b", out / "mould" / "P9.stl"]:
        file.write_text("x")
    write_run(out, {})
    assert tree(tmp_path).keys() == {"outside.txt", "out/notes.txt", "out/gcode/a/b", "out/report.json"}  # only P9.stl went


@pytest.mark.parametrize("report", ["", "[]", "{}", '{"gcode": 3, "moulds": []}', "[" * 100_000, "\x00"])
def test_a_foreign_report_is_no_obstacle(report: str, tmp_path: Path) -> None:
    (tmp_path / "report.json").write_text(report)
    write_run(tmp_path, {"a.txt": "1"})
    assert tree(tmp_path)["a.txt"] == "1"


@pytest.mark.parametrize("fault", [RuntimeError("x"), KeyboardInterrupt(), FileNotFoundError(errno.ENOENT, "x", "in.obj")])
def test_failure_leaves_what_was_there(fault: BaseException, tmp_path: Path) -> None:
    write_run(tmp_path, {"a.txt": "old", "gcode/P1.gcode": "old"})
    before = tree(tmp_path)
    with pytest.raises(type(fault)), staged_folder(tmp_path) as stage:  # noqa: PT012
        (stage / "a.txt").write_text("half")
        raise fault
    assert tree(tmp_path) == before and not list(tmp_path.glob(".skinfab-*"))


def test_failure_takes_back_the_folders_it_made(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError), staged_folder(tmp_path / "a" / "b"):
        raise RuntimeError
    assert list(tmp_path.iterdir()) == []


def test_full_disk_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"cannot write .*: the disk is full; free some space"), staged_folder(tmp_path) as stage:  # noqa: PT012
        (stage / "big.bin").write_bytes(b"x")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full on this system")
def test_a_write_the_kernel_refuses_for_want_of_space(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the disk is full"), staged_folder(tmp_path) as stage:  # noqa: PT012
        (stage / "big.bin").symlink_to("/dev/full")
        (stage / "big.bin").write_bytes(b"x" * 100_000)
    assert list(tmp_path.iterdir()) == []


def test_a_file_over_the_size_limit_is_one_line(tmp_path: Path) -> None:
    program = f"""
from skinfab.staging import staged_folder
from skinfab.errors import InputError
try:
    with staged_folder({str(tmp_path)!r}) as stage:
        (stage / "big.bin").write_bytes(b"x" * 200_000)
except InputError as fault:
    print(fault)
"""
    limit = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (100_000, 100_000))
    said = subprocess.run([sys.executable, "-c", program], preexec_fn=limit, capture_output=True, text=True)
    assert said.stdout == f"cannot write {tmp_path}: File too large\n" and list(tmp_path.iterdir()) == []


def test_a_folder_in_the_way_stops_it_before_anything_moves(tmp_path: Path) -> None:
    (tmp_path / "z.txt").mkdir()
    with pytest.raises(InputError, match=r"z\.txt: a folder of that name is in the way"):
        write_run(tmp_path, {"a.txt": "1", "z.txt": "2"})
    assert [p.name for p in tmp_path.iterdir()] == ["z.txt"]


def test_a_file_in_place_of_the_target(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine")
    for target in (tmp_path / "out", tmp_path / "out" / "deeper"):
        with pytest.raises(InputError, match="a file of that name is in the way"), staged_folder(target):
            raise AssertionError("never reached")
    assert tree(tmp_path) == {"out": "mine"}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("delay_s", [0.0, 0.01, 0.03, 0.1])
def test_ctrl_c_leaves_no_file(number: signal.Signals, delay_s: float, tmp_path: Path) -> None:
    program = f"""
import sys, threading, time, types
threading.Thread(target=time.sleep, args=(0.5,)).start()  # like a progress bar's: it may be the one that gets the signal
from skinfab.cli import main as frame
from skinfab.staging import staged_folder
def run(args):
    print("go", flush=True)
    while True:
        with staged_folder({str(tmp_path / "out")!r}) as stage:
            for k in range(200):
                (stage / f"{{k}}.bin").write_bytes(b"x" * 10_000)
            for k in range(200):
                (stage / f"{{k}}.bin").unlink()
def add_parser(subparsers):
    subparsers.add_parser("make").set_defaults(run=run)
module = types.ModuleType("skinfab.cli.make")
module.add_parser = add_parser
sys.modules["skinfab.cli.make"] = module
sys.exit(frame.main(["make"]))
"""
    default = partial(signal.signal, signal.SIGINT, signal.default_int_handler)
    work = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=default)
    assert work.stdout is not None and work.stdout.readline() == "go\n"
    time.sleep(delay_s)
    work.send_signal(number)
    _, said = work.communicate(timeout=20)
    assert (work.returncode, said) == (130, "skinfab: interrupted; nothing half-written was left\n")
    assert list(tmp_path.iterdir()) == []


def test_another_disk_inside_the_target_is_refused_before_anything_moves(tmp_path: Path) -> None:
    elsewhere = Path("/dev/shm")
    if not elsewhere.is_dir() or elsewhere.stat().st_dev == tmp_path.stat().st_dev:
        pytest.skip("there is no second file system at /dev/shm to link to")
    with tempfile.TemporaryDirectory(dir=elsewhere) as other:
        out = tmp_path / "out"
        out.mkdir()
        (out / "gcode").symlink_to(other)

        def write() -> None:
            with staged_folder(out) as folder:
                (folder / "gcode").mkdir()
                (folder / "gcode/P1.gcode").write_text("; new\n")
                (folder / "a.txt").write_text("new")

        with pytest.raises(InputError, match="gcode lies on another disk"):
            write()
        assert sorted(p.name for p in out.iterdir()) == ["gcode"] and not any(Path(other).iterdir())
