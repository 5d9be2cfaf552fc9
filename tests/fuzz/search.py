"""Search for bytes that a parser does not stand, led by which lines they reach (atheris).

``python tests/fuzz/search.py NAME SECONDS [FOLDER]``, or without arguments their names (`make fuzz` takes all).
Findings lie in FOLDER as ``NAME-crash-*``, ``NAME-timeout-*`` or
``NAME-oom-*``, beside a folder of all inputs that reached something new. The first finding ends the search.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).resolve().parents[2])]

#: What an input of at most `LONGEST` bytes may take; more is a finding.
TIMEOUT_S, MEMORY_MB, LONGEST = 10, 2048, 20_000

#: Followed line by line; what numba compiles cannot be.
FOLLOWED = ["skinfab", "gcode", "calibration", "tomllib", "trimesh.exchange", "rosbags.serde"]
COMPILED = ["skinfab.mesh.decimate", "skinfab.flatten", "skinfab.seams", "skinfab.fingertip.array", "skinfab.fingertip.force"]
COMPILED += ["skinfab.readout.drift", "skinfab.bench", "calibration.strain.play", "calibration.contact"]


def main(name: str, seconds: str, folder: str = ".fuzz") -> None:
    import atheris

    with atheris.instrument_imports(include=FOLLOWED, exclude=COMPILED):
        import parsers
        import trimesh  # noqa: F401
    parser = parsers.PARSERS[name]
    corpus = Path(folder, name)
    corpus.mkdir(parents=True, exist_ok=True)
    for k, seed in enumerate(parser.seeds()):
        (corpus / f"seed{k}").write_bytes(seed)
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as scratch:

        def one(data: bytes) -> None:
            parsers.run(parser, data, Path(scratch))

        limits = [f"-max_total_time={seconds}", f"-timeout={TIMEOUT_S}", f"-rss_limit_mb={MEMORY_MB}", f"-max_len={LONGEST}"]
        atheris.Setup([sys.argv[0], *limits, f"-artifact_prefix={folder}/{name}-", "-print_final_stats=1", str(corpus)], one)
        atheris.Fuzz()


if __name__ == "__main__":
    if len(sys.argv) == 1:
        import parsers

        sys.stdout.write("\n".join(parsers.PARSERS) + "\n")
    else:
        main(*sys.argv[1:])
