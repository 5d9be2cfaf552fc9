"""printrun reads our files as we do, and streams them whole over a bad line and a dropped connection."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parent))
from marlin_server import MarlinServer

from gcode.emit import emit
from gcode.plan import Plan
from gcode.printer import Printer
from gcode.program import Extrude, Prime

ROOT = Path(__file__).parents[2]
PYTHON = ROOT / ".venv-printrun/bin/python"
pytestmark = pytest.mark.skipif(not (PYTHON.parent.parent / ".stamp").exists(), reason="printrun is not here: run tests/setup_printrun.sh")


def printrun(*words: object, timeout: float = 90.0) -> dict[str, Any]:
    command = [str(PYTHON), str(Path(__file__).with_name("with_printrun.py")), *map(str, words)]
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=timeout)
    except subprocess.TimeoutExpired as fault:
        said = (fault.stderr or b"").decode() if isinstance(fault.stderr, bytes) else fault.stderr
        pytest.fail(f"{' '.join(map(str, words))} took more than {timeout:g} s and said on stderr:\n{said}")
    assert run.returncode == 0, f"{' '.join(map(str, words))} ended with {run.returncode} and said on stderr:\n{run.stderr}"
    return dict(json.loads(run.stdout))


def reading(text: str, folder: Path) -> dict[str, Any]:
    file = folder / "a.gcode"
    file.write_text(text)
    return printrun("read", file)


@pytest.mark.parametrize("arcs", ["native", "lines"])
def test_it_sums_the_same_ink(planned: Plan, printer: Printer, tmp_path: Path, arcs: str) -> None:
    found = reading(emit(planned.program, printer, arcs=arcs), tmp_path)  # type: ignore[arg-type]
    e = printer.pump.e_per_mm3
    prime = next(s.volume for s in planned.program.steps if isinstance(s, Prime))
    assert found["last_e"] / e == pytest.approx(planned.program.ink, abs=1e-5)  # prime and retract cancel
    assert found["most_e"] / e == pytest.approx(planned.program.ink + prime, abs=1e-5)
    assert found["relative_e"]
    if arcs == "lines":  # of an arc it sees the ends
        boxes = [s.shape.bbox for s in planned.program.steps if isinstance(s, Extrude)]
        assert found["box"][1][0] == pytest.approx(max(b[1][0] for b in boxes), abs=0.01)
        assert found["box"][0][1] == pytest.approx(min(b[0][1] for b in boxes), abs=0.01)


def test_it_shows_a_wrong_sign_of_e(planned: Plan, printer: Printer, faulty: Callable[[str], str], tmp_path: Path) -> None:
    found = reading(faulty("a wrong sign of E"), tmp_path)
    assert found["last_e"] / printer.pump.e_per_mm3 < planned.program.ink - 20


def test_it_shows_g90_after_m83(planned: Plan, printer: Printer, faulty: Callable[[str], str], tmp_path: Path) -> None:
    found = reading(faulty("G90 after M83"), tmp_path)
    assert not found["relative_e"]
    assert found["most_e"] / printer.pump.e_per_mm3 < 0.5 * planned.program.ink


def test_it_shows_the_way_off_the_bed(planned: Plan, printer: Printer, tmp_path: Path) -> None:
    text = emit(planned.program, printer, arcs="lines")
    moved = re.sub(r"^(G1) X\S+", r"\1 X351.0000", text, count=1, flags=re.MULTILINE)
    assert reading(text, tmp_path)["box"][1][0] < 350 < reading(moved, tmp_path)["box"][1][0]


@pytest.fixture
def job(planned: Plan, printer: Printer, tmp_path: Path) -> tuple[Path, list[str]]:
    """A file, and the commands of it that a printer should get."""
    text = emit(planned.program, printer, arcs="lines")
    file = tmp_path / "job.gcode"
    file.write_text(text)
    return file, [command for line in text.splitlines() if (command := line.partition(";")[0].strip())]


def send(server: MarlinServer, file: Path, after_a_drop: str) -> dict[str, Any]:
    """What the sender says; where a test fails, pytest shows what went over the wire as well."""
    with server:
        try:
            sent = printrun("send", file, server.address, after_a_drop)
        finally:
            sys.stdout.write("\n".join(server.log) + "\n")
    sys.stdout.write(f"the sender: {sent}\n")
    return sent


def test_a_whole_job_arrives(job: tuple[Path, list[str]]) -> None:
    file, commands = job
    server = MarlinServer()
    sent = send(server, file, "give-up")
    assert sent == {"finished": True, "errors": [], "dropped_at": None}
    assert server.obeyed == commands and len(commands) > 200
    assert server.resends == [] and server.connections == 1


def test_garbled_lines_are_asked_for_again(job: tuple[Path, list[str]]) -> None:
    file, commands = job
    server = MarlinServer(garble=frozenset({3, 10, 11, 57, 200}))
    sent = send(server, file, "give-up")
    assert sent["finished"]
    assert len(server.resends) >= 4 and all("checksum" in e or "Last Line" in e for e in sent["errors"])
    assert server.obeyed == commands  # none twice, none left out


def test_a_dropped_connection_is_reported_and_the_printer_waits(job: tuple[Path, list[str]]) -> None:
    file, commands = job
    server = MarlinServer(drop_at=60)
    sent = send(server, file, "give-up")
    assert not sent["finished"] and any("disconnected?" in e for e in sent["errors"])
    assert server.obeyed == commands[:60]


def test_a_dropped_job_is_resumed_where_it_was(job: tuple[Path, list[str]]) -> None:
    file, commands = job
    server = MarlinServer(drop_at=60)
    sent = send(server, file, "resume")
    assert sent["finished"] and server.connections == 2
    assert server.obeyed == commands  # no ink twice, none left out


def test_a_dropped_job_can_be_begun_again_on_a_fresh_mould(job: tuple[Path, list[str]]) -> None:
    file, commands = job
    server = MarlinServer(drop_at=60)
    sent = send(server, file, "restart")
    assert sent["finished"] and server.obeyed == commands[:60] + commands
