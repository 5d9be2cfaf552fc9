"""Reads one C3D file and writes what is in it to standard output, as a process of its own: the library can crash on damaged ones."""

from __future__ import annotations

import io
import json
import resource
import sys
from typing import Any

import numpy as np

#: The file's claims are not believed beyond this, bytes.
MEMORY = 8 << 30


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
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        arrays = contents(path)
    except (RuntimeError, ValueError, IndexError, KeyError, OSError, MemoryError, OverflowError, TypeError) as fault:
        sys.stderr.write(f"{type(fault).__name__}: {fault}")
        return 1
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    sys.stdout.buffer.write(stream.getvalue())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
