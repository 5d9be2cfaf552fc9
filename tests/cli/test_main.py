"""The command frame: exit statuses, one line a fault, quick help, clean ends."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from skinfab import __version__
from skinfab.cli.main import COMMANDS, build_parser

SKINFAB = Path(sys.executable).with_name("skinfab")

# A stand-in for a sub-command, so that every way to end can be had at will: the frame runs it as it runs its own.
FRAME = """
import sys, types, time, os
from skinfab import cli
from skinfab.cli import main as frame
from skinfab.errors import InputError, RefusedError
def run(args):
    {body}
    return 0
def add_parser(subparsers):
    p = subparsers.add_parser("inspect")
    p.add_argument("--whole-word", action="store_true")
    p.set_defaults(run=run)
module = types.ModuleType("skinfab.cli.inspect")
module.add_parser = add_parser
sys.modules["skinfab.cli.inspect"] = module
sys.exit(frame.main(["inspect", *sys.argv[1:]]))
"""


def run(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(SKINFAB), *arguments], capture_output=True, text=True, timeout=60, **options)  # type: ignore[call-overload]


def run_body(body: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    program = [sys.executable, "-c", FRAME.format(body=body), *arguments]
    return subprocess.run(program, capture_output=True, text=True, timeout=60, env={**os.environ, **environment})


def test_help_lists_every_command_and_imports_none() -> None:
    shown = run("--help")
    assert shown.returncode == 0 and shown.stderr == ""
    for name in COMMANDS:
        assert f"\n    {name} " in shown.stdout
    program = "import sys; from skinfab.cli.main import main; main(['--help']); print(sorted(sys.modules), file=sys.stderr)"
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stderr
    for heavy in ["numpy", "scipy", "rich", *(f"skinfab.cli.{name}" for name in COMMANDS)]:
        assert f"'{heavy}'" not in loaded


def test_version() -> None:
    assert run("--version").stdout == f"skinfab {__version__}\n"


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help_and_loads_no_numpy_for_it(name: str) -> None:
    program = f"import sys; from skinfab.cli.main import main; s = main(['{name}', '--help']); sys.exit(s or 'numpy' in sys.modules)"
    shown = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert shown.returncode == 0, shown.stderr
    assert shown.stdout.startswith(f"usage: skinfab {name}")


@pytest.mark.parametrize("arguments", [[], ["flaten"], ["--nonsense"], ["inspect", "--nonsense", "x"]])
def test_wrong_usage_is_status_2(arguments: list[str]) -> None:
    shown = run(*arguments)
    assert shown.returncode == 2 and shown.stdout == "" and "usage: skinfab" in shown.stderr


def test_options_are_not_shortened() -> None:
    assert run_body("pass", "--whole-word").returncode == 0
    assert run_body("pass", "--whole").returncode == 2


@pytest.mark.parametrize(
    ("body", "status", "line"),
    [
        ("raise InputError('a.obj: no faces;\\n give another')", 1, "skinfab: a.obj: no faces; give another"),
        ("raise RefusedError('piece P1 overlaps')", 3, "skinfab: piece P1 overlaps"),
        ("raise MemoryError", 1, "skinfab: not enough memory"),
        ("open('/nowhere/x')", 1, "skinfab: /nowhere/x: No such file or directory"),
        ("1 / 0", 1, "skinfab: unexpected ZeroDivisionError: division by zero; SKINFAB_TRACEBACK=1 shows where"),
        ("raise KeyboardInterrupt", 130, "skinfab: interrupted; nothing half-written was left"),
    ],
)
def test_each_fault_is_one_line_and_its_status(body: str, status: int, line: str) -> None:
    shown = run_body(body)
    assert shown.returncode == status and shown.stdout == ""
    assert shown.stderr.startswith(line) and shown.stderr.count("\n") == 1


def test_traceback_on_request() -> None:
    shown = run_body("1 / 0", SKINFAB_TRACEBACK="1").stderr
    assert "Traceback" in shown and "line 7, in run" in shown


def test_warnings_stay_off_the_terminal_unless_asked_for() -> None:
    body = "import numpy as np, warnings; np.float64(1) / np.zeros(1); warnings.warn('look here')"
    assert run_body(body).stderr == ""
    assert "look here" in run_body(body, PYTHONWARNINGS="default").stderr


def test_one_thread_unless_the_user_chose() -> None:
    body = "print(os.environ['OMP_NUM_THREADS'], os.environ['OPENBLAS_NUM_THREADS'], 'numpy' in sys.modules)"
    free = {k: v for k, v in os.environ.items() if "NUM_THREADS" not in k}
    program = [sys.executable, "-c", FRAME.format(body=body)]
    assert subprocess.check_output(program, env=free, text=True) == "1 1 False\n"
    assert subprocess.check_output(program, env={**free, "OMP_NUM_THREADS": "7"}, text=True) == "7 1 False\n"


def test_reader_that_goes_away_is_no_fault() -> None:
    body = "print('x' * 1_000_000); print('y' * 1_000_000)"
    work = subprocess.Popen([sys.executable, "-c", FRAME.format(body=body)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert work.stdout is not None and work.stderr is not None
    work.stdout.read(10)
    work.stdout.close()
    assert work.stderr.read() == b"" and work.wait(timeout=30) == 141
    work.stderr.close()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full on this system")
def test_full_standard_output_is_one_line() -> None:
    with Path("/dev/full").open("w") as full:
        shown = subprocess.run([sys.executable, "-c", FRAME.format(body="print('x')")], stdout=full, stderr=subprocess.PIPE, text=True)
    assert (shown.returncode, shown.stderr) == (1, "skinfab: No space left on device\n")


def default_signals() -> None:
    # A shell that started the tests in the background has SIGINT ignored, and children inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signals_unwind(number: signal.Signals, tmp_path: Path) -> None:
    lines = ["from skinfab.files import atomic_path", f"with atomic_path({str(tmp_path / 'out.txt')!r}) as p:"]
    lines += ["    p.write_text('half')", "    print('ready', flush=True)", "    time.sleep(30)"]
    body = "\n    ".join(lines)
    work = subprocess.Popen(
        [sys.executable, "-c", FRAME.format(body=body)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=default_signals,
    )
    assert work.stdout is not None
    assert work.stdout.readline() == "ready\n"
    assert len(list(tmp_path.iterdir())) == 1
    time.sleep(0.1)
    work.send_signal(number)
    _, complaint = work.communicate(timeout=20)
    assert (work.returncode, complaint) == (130, "skinfab: interrupted; nothing half-written was left\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["calibration", "gcode", "gui", "make", "inspect"])
def test_scripts_of_the_users_do_not_get_in_the_way(name: str, tmp_path: Path) -> None:
    (tmp_path / f"{name}.py").write_text("raise SystemExit('the wrong file was imported')")
    shown = run("gcode", "--help", cwd=tmp_path)
    assert shown.returncode == 0 and "wrong file" not in shown.stderr


def test_parser_holds_the_wanted_command_only(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []

    def load(name: str) -> object:
        asked.append(name)

        class Module:
            add_parser: Callable[..., object] = staticmethod(lambda subparsers: subparsers.add_parser("mould"))

        return Module

    monkeypatch.setattr("importlib.import_module", load)
    build_parser(["mould", "gcode"])
    assert asked == ["skinfab.cli.mould"]


def test_a_swallowed_interrupt_comes_again() -> None:
    """A KeyboardInterrupt that is raised inside a callback may be dropped there; the command ends all the same."""
    body = (
        "class Swallows:",
        "    def __del__(self):",
        "        os.kill(os.getpid(), 2)",
        "        time.sleep(0.1)",
        "Swallows()",
        "print('swallowed', flush=True)",
        "time.sleep(30)",
    )
    code = FRAME.format(body="\n    ".join(body))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=20)
    assert "swallowed\n".startswith(done.stdout)  # it may come again in the middle of the word
    assert (done.returncode, done.stderr) == (130, "skinfab: interrupted; nothing half-written was left\n")


@pytest.mark.parametrize(
    "fault", ["InputError('half a file')", "OSError(5, 'broken', 'x')", "MemoryError", "ValueError('?')", "SystemError"]
)
def test_an_interrupt_turned_into_another_error_is_one_all_the_same(fault: str) -> None:
    body = ("try:", "    os.kill(os.getpid(), 2)", "    time.sleep(5)", "except KeyboardInterrupt:", f"    raise {fault}")
    done = run_body("\n    ".join(body))
    assert (done.returncode, done.stderr) == (130, "skinfab: interrupted; nothing half-written was left\n")


def test_an_interrupt_waits_until_a_module_is_loaded(tmp_path: Path) -> None:
    """A compiled module may abort the process when it is met by an exception while it sets itself up."""
    (tmp_path / "slow.py").write_text("import os, time\nos.kill(os.getpid(), 15)\ntime.sleep(0.1)\nprint('loaded', flush=True)\n")
    body = (f"sys.path.insert(0, {str(tmp_path)!r})", "import slow", "time.sleep(5)", "print('not reached')")
    done = run_body("\n    ".join(body))
    assert (done.returncode, done.stdout) == (130, "loaded\n")
    assert done.stderr == "skinfab: interrupted; nothing half-written was left\n"


@pytest.mark.parametrize("way_out", ["finally", "except KeyboardInterrupt", "except BaseException"])
def test_cleaning_up_is_not_cut_short_by_a_second_interrupt(way_out: str) -> None:
    """The first interrupt is repeated in case it was swallowed: not so while it is being handled, however long that takes."""
    body = (
        "frame.AGAIN_S = 0.05",
        "try:",
        "    os.kill(os.getpid(), 2)",
        "    time.sleep(5)",
        f"{way_out}:",
        "    time.sleep(0.3)",
        "    os.kill(os.getpid(), 15)",
        "    time.sleep(0.3)",
        "    print('cleaned', flush=True)",
        *(["    raise"] if way_out != "finally" else []),
    )
    done = run_body("\n    ".join(body))
    assert (done.returncode, done.stdout) == (130, "cleaned\n")
    assert done.stderr == "skinfab: interrupted; nothing half-written was left\n"
