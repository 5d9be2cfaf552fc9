"""Print how the whole command grows with the mesh: ``python benchmarks/large.py [TRIANGLES ...]``.

Imports, reading, checks, flattening, figures and writing are inside the times; each command runs in a process of its own.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from skinfab.bench.disks import bumpy_cap
from skinfab.decimals import write_rows

SIZES = (34_000, 137_000, 546_000, 2_200_000)
WAYS = {"bff": ["--method", "bff"], "auto --simplify auto": ["--method", "auto", "--simplify", "auto"]}


def measured(command: list[str]) -> tuple[float, float, float]:
    """Seconds by the clock, seconds of processor time, and the most memory at once in MB."""
    began = time.perf_counter()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    wall = time.perf_counter() - began
    if status:
        raise SystemExit(f"{' '.join(command)} ended with status {status}")
    return wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1000


def growth(sizes: list[int], values: list[float]) -> float:
    """The exponent of the power law through the last two sizes."""
    return float(np.log(values[-1] / values[-2]) / np.log(sizes[-1] / sizes[-2]))


def make(triangles: int, path: Path) -> int:
    """Write a disk of so many triangles; how many there are."""
    V, F = bumpy_cap(triangles)
    path.write_bytes(write_rows(b"v", V) + write_rows(b"f", F + 1.0))
    return len(F)


def main() -> None:
    wanted = [int(word) for word in sys.argv[1:]] or list(SIZES)
    print("| method | triangles | s | processor s | MB | bytes a triangle | growth |\n|" + "---|" * 7)
    with tempfile.TemporaryDirectory() as folder:
        for name, options in WAYS.items():
            sizes: list[int] = []
            walls: list[float] = []
            for triangles in wanted:
                mesh = Path(folder, "cap.obj")
                # Not in this process: the system counts the memory of a parent into its children's.
                with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as apart:
                    n = apart.submit(make, triangles, mesh).result()
                command = [
                    sys.executable,
                    "-m",
                    "skinfab",
                    "flatten",
                    str(mesh),
                    "--units",
                    "mm",
                    "-o",
                    str(Path(folder, "flat.obj")),
                    *options,
                ]
                wall, cpu, peak = min(measured(command) for _ in range(2))
                sizes.append(n)
                walls.append(wall)
                slope = f"{growth(sizes, walls):.2f}" if len(sizes) > 1 else ""
                print(f"| {name} | {n} | {wall:.2f} | {cpu:.2f} | {peak:.0f} | {peak * 1e6 / n:.0f} | {slope} |", flush=True)


if __name__ == "__main__":
    main()
