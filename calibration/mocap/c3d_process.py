"""Reads one C3D file and writes what is in it to standard output, as a process of its own: the library can crash on damaged ones."""

from __future__ import annotations

import io
import json
import os
import resource
import sys
from typing import Any

import numpy as np

#: What any file may take, bytes of addresses and seconds of the processor: Python and the library take 160 MB and 1 s of it.
MEMORY, PROCESSOR_S = 1 << 30, 10
#: What each of its bytes may take besides: points of two bytes a number become objects, lists and arrays, 20 bytes each, in 40 ns.
MEMORY_PER_BYTE, PROCESSOR_S_PER_BYTE = 40, 1e-6
#: No file takes more, bytes.
MOST_MEMORY = 8 << 30


def contents(path: str) -> dict[str, Any]:
    """Arrays by name: ``points`` (3, m, n), ``residuals`` (m, n), and ``said``, JSON of labels, rate, units and the first frame."""
    import ezc3d

    made = ezc3d.c3d(path)
    group = made["parameters"].get("POINT", {})
    labels = [label for name in ("LABELS", *(f"LABELS{k}" for k in range(2, 256))) if name in group for label in group[name]["value"]]
    said = {
        "labels": labels,
        "rate": float(made["header"]["points"]["frame_rate"]),
        "units": next(iter(group.get("UNITS", {}).get("value", [])), ""),
    }
    points = made["data"]["points"][:3]
    residuals = made["data"]["meta_points"]["residuals"][0]
    return {"points": points, "residuals": residuals, "said": np.frombuffer(json.dumps(said).encode(), dtype=np.uint8)}


def main(path: str) -> int:
    """Write an archive of arrays; what the library had to say goes to standard error."""
    size = os.stat(path).st_size
    memory, processor_s = min(MEMORY + MEMORY_PER_BYTE * size, MOST_MEMORY), int(PROCESSOR_S + PROCESSOR_S_PER_BYTE * size)
    for kind, limit in ((resource.RLIMIT_AS, memory), (resource.RLIMIT_CPU, processor_s), (resource.RLIMIT_CORE, 0)):
        resource.setrlimit(kind, (limit, limit))
    try:
        arrays = contents(path)
    except MemoryError:
        sys.stderr.write("it claims more than a file of its size holds")
        return 1
    except (RuntimeError, ValueError, IndexError, KeyError, OSError, OverflowError, TypeError) as fault:
        sys.stderr.write(f"{type(fault).__name__}: {fault}")
        return 1
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    sys.stdout.buffer.write(stream.getvalue())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
