"""A runner as `skinfab.cli.batch_job` is one, whose jobs do what the first line of their mesh says, in no time."""

import json
import os
import sys
import time
from pathlib import Path

from skinfab.batch.runner import serve

REPORT = {
    "mesh": {"n_faces": 4},
    "pieces": [1, 2],
    "distortion": {"mean": 4.01, "p99": 4.2},
    "seam_mm": 12.5,
    "sensors": [1],
    "gcode": [{"ink_mm3": 2.0, "time_s": 3.0}],
    "moulds": [],
    "warnings": ["thin"],
}


def work(words: list[str]) -> int:
    mesh, folder = words[1], Path(words[words.index("-o") + 1])
    what, *numbers = Path(mesh).read_text().split()
    (folder / "half.txt").write_text("half")
    if what == "sleep":
        time.sleep(float(numbers[0]))
    elif what == "sleep-once":
        begun = Path(mesh).with_suffix(".begun")
        if not begun.exists():
            begun.touch()
            time.sleep(600)
    elif what == "eat":
        eaten = []
        while True:
            eaten.append(b"x" * 5_000_000)
            time.sleep(0.001)
    elif what == "leap":
        bytearray(10**13)
    elif what == "abort":
        os.abort()
    elif what == "kill-runner":
        os.kill(os.getppid(), 9)
        time.sleep(60)
    elif what in ("failed", "refused"):
        sys.stderr.write(f"note: read\nskinfab: {mesh} was {what}, see {folder}" + "\n")
        return {"failed": 1, "refused": 3}[what]
    elif what == "full":
        sys.stderr.write(f"skinfab: cannot write {folder}: the disk is full; free some space and run again" + "\n")
        return 1
    (folder / "half.txt").unlink()
    (folder / "report.json").write_text(json.dumps(REPORT))
    return 0


if __name__ == "__main__":
    serve(work)
