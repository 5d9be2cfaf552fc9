"""Runs the C3D library's process for thousands of files: forked each time from one that has everything imported."""

from __future__ import annotations

import atexit
import json
import os
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

#: What a file of at most 20 kB may take of a forked process.
MEMORY_MB = 2048

_SERVER = """
import json, os, sys
import ezc3d, numpy
from calibration.mocap import c3d_process
for line in sys.stdin:
    path, out, said = json.loads(line)
    if not (child := os.fork()):
        for name, at in ((out, 1), (said, 2)):
            os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), at)
        code = 70
        try:
            code = c3d_process.main(path)
            sys.stdout.flush()
        finally:
            os._exit(code)
    _, status, used = os.wait4(child, 0)
    print(os.waitstatus_to_exitcode(status), used.ru_maxrss // 1024, flush=True)
"""


@cache
def _server() -> subprocess.Popen[str]:
    command = [sys.executable, "-P", "-c", _SERVER]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    server = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)
    atexit.register(_stop, server)
    return server


def _stop(server: subprocess.Popen[str]) -> None:
    server.kill()
    server.communicate()


def run(command: list[str], **_: object) -> subprocess.CompletedProcess[bytes]:
    """`subprocess.run` for ``python -m calibration.mocap.c3d_process FILE``; a file that takes too much memory is a finding."""
    server = _server()
    assert server.stdin and server.stdout
    with tempfile.TemporaryDirectory(dir=Path(command[-1]).parent) as folder:
        out, said = Path(folder, "out"), Path(folder, "said")
        server.stdin.write(json.dumps([command[-1], str(out), str(said)]) + "\n")
        server.stdin.flush()
        code, memory = map(int, server.stdout.readline().split())
        assert memory < MEMORY_MB, f"the library took {memory} MB"
        return subprocess.CompletedProcess(command, code, out.read_bytes(), said.read_bytes())
