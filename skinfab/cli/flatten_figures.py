"""What `skinfab flatten --json` writes: how good the pieces are, and from what they were made."""

from __future__ import annotations

from typing import Any

import numpy as np

from skinfab.flatten.distortion import Distortion, mean_over, stretch
from skinfab.mesh.io import Loaded
from skinfab.mesh.model import Mesh
from skinfab.pieces import Piece


def overall(mesh: Mesh, pieces: list[Piece], distortions: list[Distortion]) -> tuple[float, float]:
    """Mean d over the object's area, and the largest."""
    if len(pieces) == 1:
        return distortions[0].mean, distortions[0].max
    areas = [mesh.face_areas[p.faces].sum() for p in pieces]
    return float(np.average([d.mean for d in distortions], weights=areas)), max(d.max for d in distortions)


def figures(
    loaded: Loaded,
    mesh: Mesh,
    pieces: list[Piece],
    distortions: list[Distortion],
    *,
    method: str,
    max_distortion: float,
    seconds: float,
    flattened_at: float,
) -> dict[str, Any]:
    """The figures of one flattening, ready for JSON; `mesh` is the surface that was flattened, `flattened_at` mm outside the object."""
    areas = [float(mesh.face_areas[p.faces].sum()) for p in pieces]
    kept = [_at_kept_area(mesh, piece, area) for piece, area in zip(pieces, areas, strict=True)]
    mean, most = overall(mesh, pieces, distortions)
    return {
        "mesh": {"file": loaded.file, "sha256": loaded.sha256, "units": loaded.units, "scale": loaded.scale, "notes": list(loaded.notes)},
        "method": method,
        "n_faces": len(mesh.F),
        "flattened_at_mm": flattened_at,
        "pieces": [
            {
                "id": p.id,
                "n_faces": len(p.F),
                "size_mm": p.size,
                "area_mm2": p.area,
                "area_on_object_mm2": area,
                "distortion": {"mean": d.mean, "p95": d.p95, "p99": d.p99, "max": d.max},
                "angle_mean": mean_over(d.angle, mesh.face_areas[p.faces]),
                "area_mean": mean_over(d.area, mesh.face_areas[p.faces]),
                "mean_at_kept_area": k,
                "flipped": d.flipped,
                "overlap_mm2": d.overlap_mm2,
            }
            for p, d, area, k in zip(pieces, distortions, areas, kept, strict=True)
        ],
        "distortion": {"mean": mean, "mean_at_kept_area": float(np.average(kept, weights=areas)), "max": most},
        "max_distortion": max_distortion,
        "within": mean <= max_distortion,
        "flatten_s": seconds,
    }


def _at_kept_area(mesh: Mesh, piece: Piece, area: float) -> float:
    """Mean d of the same shape at the scale that keeps the object's area: the other common choice."""
    square, product = stretch(piece.V(mesh), piece.F, piece.UV * np.sqrt(area / piece.area))
    with np.errstate(divide="ignore", invalid="ignore"):
        return mean_over(square * (1 + 1 / product**2), mesh.face_areas[piece.faces])
