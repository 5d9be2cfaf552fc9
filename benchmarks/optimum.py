"""Print how near the flattenings come to the least d there is: ``python benchmarks/optimum.py [FOLDER]``.

FOLDER holds the scans (default: ../shared/meshes); without them the closed forms are measured alone.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from skinfab.bench.disks import bumpy_cap
from skinfab.bench.optimum import nearness, real_disks
from skinfab.bench.timing import one_processor
from skinfab.flatten.disk import flatten_isometric

HEAD = (
    "| disk | triangles | bff | isometric | bijective | SLIM, Tutte start | SLIM, BFF start | above the least | flips | overlap mm^2 "
    "| isometric s | bijective s | SLIM s | isometric / SLIM | isometric / SLIM until there |"
)


def hemisphere(triangles: int) -> tuple[np.ndarray, np.ndarray]:
    """A half sphere of radius 50 mm: the bench's cap, its rim and bumps smoothed away."""
    _, F = bumpy_cap(triangles)
    rings = round((len(F) / 6) ** 0.5)
    axis = np.arange(-rings, rings + 1)
    q, r = (a.ravel() for a in np.meshgrid(axis, axis, indexing="ij"))
    ring = np.maximum(np.maximum(abs(q), abs(r)), abs(q + r))
    inside = ring <= rings
    polar, angle = np.pi / 2 * ring[inside] / rings, np.arctan2(r * np.sqrt(3) / 2, q + r / 2)[inside]
    return 50 * np.stack([np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle), np.cos(polar)], axis=1), F


def main() -> None:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2] / "shared/meshes"
    disks = {"hemisphere": hemisphere(6_000), "bumpy cap": bumpy_cap(20_000), **real_disks(folder)}
    flatten_isometric(*bumpy_cap(300))  # compiled
    with one_processor():
        print(HEAD + "\n|" + "---|" * 15)
        for name, (V, F) in disks.items():
            n = nearness(name, V, F)
            d = " | ".join(f"{value:.5f}" for value in (n.bff, n.isometric, n.bijective, n.slim_tutte, n.slim_bff))
            s = " | ".join(f"{value:.3g}" for value in (n.isometric_s, n.bijective_s, n.slim_s))
            ratios = f"{n.isometric_s / n.slim_s:.3f} | {n.isometric_s / n.slim_there_s:.3f}"
            print(f"| {name} | {n.triangles} | {d} | {n.excess:+.4%} | {n.flipped} | {n.overlap_mm2:.3g} | {s} | {ratios} |", flush=True)


if __name__ == "__main__":
    main()
