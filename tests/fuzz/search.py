"""Search for bytes that a parser does not stand, led by which lines they reach (atheris).

``python tests/fuzz/search.py SECONDS [NAME ...]``: each of these parsers, or all (`make fuzz`), for so long.
Findings lie in .fuzz as ``NAME-crash-*``, ``NAME-timeout-*`` or
``NAME-oom-*``, beside a folder of all inputs that reached something new. The first finding ends a parser's search.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import parsers

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).resolve().parents[2])]

FOLDER = ".fuzz"
#: What an input of at most `LONGEST` bytes may take; more is a finding.
TIMEOUT_S, MEMORY_MB, LONGEST = 10, 2048, 20_000

#: Followed line by line, but for what numba compiles, which cannot be.
OURS = ["skinfab", "gcode", "calibration"]
FOLLOWED = [*OURS, "tomllib", "trimesh.exchange", "rosbags.serde"]


def compiled() -> list[str]:
    """Every module that imports numba, one by one: atheris follows the modules of a package that it is told to leave out."""
    root = Path(__file__).resolve().parents[2]
    files = (file for package in OURS for file in sorted((root / package).rglob("*.py")))
    return [
        ".".join(file.relative_to(root).with_suffix("").parts)
        for file in files
        if re.search(r"^\s*(?:import|from) numba\b", file.read_text(encoding="utf-8"), re.MULTILINE)
    ]


def main(seconds: str, *names: str) -> int:
    """Search each of these parsers, or all, in a process of its own: how many ended with a finding."""
    import atheris

    with atheris.instrument_imports(include=FOLLOWED, exclude=compiled()):
        import parsers
        import trimesh  # noqa: F401
    findings = 0
    for name in names or parsers.PARSERS:
        sys.stdout.write(f"{name}\n")
        sys.stdout.flush()
        if not (child := os.fork()):  # imports are followed slowly: once for all
            search(parsers.PARSERS[name], name, seconds)
            os._exit(0)
        findings += os.waitpid(child, 0)[1] != 0
    return findings


def search(parser: parsers.Parser, name: str, seconds: str) -> None:
    """Never comes back: what is searched ends the process."""
    import atheris
    import parsers

    corpus = Path(FOLDER, name)
    corpus.mkdir(parents=True, exist_ok=True)
    for k, seed in enumerate(parser.seeds()):
        (corpus / f"seed{k}").write_bytes(seed)
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as scratch:

        def one(data: bytes) -> None:
            parsers.run(parser, data, Path(scratch))

        limits = [f"-max_total_time={seconds}", f"-timeout={TIMEOUT_S}", f"-rss_limit_mb={MEMORY_MB}", f"-max_len={LONGEST}"]
        atheris.Setup([sys.argv[0], *limits, f"-artifact_prefix={FOLDER}/{name}-", "-print_final_stats=1", str(corpus)], one)
        atheris.Fuzz()


if __name__ == "__main__":
    sys.exit(bool(main(*sys.argv[1:])))
