"""The report as plain values: every figure a script may ask for, in the shape of `report.schema.json`."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path, PureWindowsPath
from typing import Any

import numpy as np

from skinfab import __version__
from skinfab.electrical import ink_volume, resistance
from skinfab.errors import RefusedError
from skinfab.files import atomic_write
from skinfab.flatten.distortion import Distortion
from skinfab.material import Material
from skinfab.patterns.registry import parameters
from skinfab.pieces import Piece
from skinfab.placement.sensor import Sensor
from skinfab.placement.wrap_strain import StrainAlong
from skinfab.report.cautions import cautions
from skinfab.report.strains import SensorStrains, sensor_strains, strain_facts
from skinfab.skin import Skin
from skinfab.wiring import board_of

#: Version of the report's shape.
SCHEMA = 1

Facts = Mapping[str, Any]


def build_report(
    skin: Skin,
    distortions: Sequence[Distortion],
    *,
    material: Material,
    gcode: Sequence[Facts] = (),
    moulds: Sequence[Facts] = (),
    recipe: Facts | None = None,
    timing_s: Facts,
    peak_rss_mb: float,
    warnings: Sequence[str] = (),
    strains: SensorStrains | None = None,
) -> dict[str, Any]:
    """Everything `make` found out, as plain JSON values.

    Parameters
    ----------
    skin : Skin
    distortions : sequence of Distortion
        One a piece, in the order of ``skin.pieces``.
    material : Material
        What the sensors' ink and resistance are computed with.
    gcode : sequence of mappings
        file, lines, time_s, ink_mm3, bbox_mm ((2, 2) or (2, 3)), arcs; and, where it is known, primed_mm3:
        the most ink that is in the nozzle beside what is laid.
    moulds : sequence of mappings
        file, watertight, cavity_ml; and, where they are known, size_mm: the outer size in x, y, z; wire_slots: which pad's wire
        leaves where (sensor, terminal, at_mm in the piece frame, shared).
    recipe : mapping, optional
    timing_s : mapping
        Seconds of each phase, and "total".
    peak_rss_mb : float
    warnings : sequence of str
        What was said on the way; what the figures themselves warn of is added here (`skinfab.report.cautions`).
    strains : SensorStrains, optional
        Of the skin's sensors; without them the conductors are taken to lie in the skin's neutral surface.

    Returns
    -------
    dict
        Valid by ``report.schema.json``; areas and boundaries of pieces are those of the flat shapes.

    Raises
    ------
    RefusedError
        A value is not finite, so the result behind it cannot be right.
    """
    strains = strains or sensor_strains(skin, material)
    report: dict[str, Any] = {
        "schema": SCHEMA,
        "made_for": _made_for(skin, material, strains),
        "mesh": _mesh(skin),
        "pieces": [_piece(piece, d) for piece, d in zip(skin.pieces, distortions, strict=True)],
        "distortion": _overall(skin, distortions),
        "seam_mm": float(np.linalg.norm(np.subtract(*skin.mesh.V[np.reshape(skin.seams, (-1, 2)).T]), axis=1).sum()),
        "sensors": [_sensor(s, material, along, strains.even) for s, along in zip(skin.sensors, strains.along, strict=True)],
        "gcode": [_plain(facts) for facts in gcode],
        "moulds": [_plain(facts) for facts in moulds],
        "recipe": _plain(recipe or {}),
        "timing_s": _plain(timing_s),
        "peak_rss_mb": float(peak_rss_mb),
        "warnings": list(warnings),
    }
    if bad := _not_finite(report, ""):
        raise RefusedError(f"report: {bad} is not finite; the result was not written")
    report["warnings"] += cautions(skin, distortions, report["sensors"])
    return report


def write_report(report: Mapping[str, Any], path: str | Path) -> None:
    """Write the report as strict JSON (no NaN), whole or not at all."""
    atomic_write(path, json.dumps(report, indent=1, allow_nan=False, ensure_ascii=False) + "\n")


def report_schema() -> dict[str, Any]:
    """The JSON Schema (draft 2020-12) of a report.

    Examples
    --------
    >>> report_schema()["properties"]["schema"]
    {'const': 1}
    """
    text = (resources.files("skinfab") / "report" / "report.schema.json").read_text(encoding="utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


def _made_for(skin: Skin, material: Material, strains: SensorStrains) -> dict[str, Any]:
    """What must be the same for the result to be the same, and to be of use at the printer."""
    return {
        "software": f"skinfab {__version__}",
        "printer": _profile(skin.printer),
        "material": _profile(skin.material),
        "material_name": material.name,
        "ink": material.ink.name,
        "bead_width_mm": material.ink.bead_width,
        "bead_area_mm2": material.ink.bead_area_mm2,
        "skin_thickness_mm": material.depth,
        "flattened_at_mm": skin.flattened_at,
        "neutral_mm": strains.neutral_mm,
        "conductor_mm": strains.conductor_mm,
        "max_distortion": skin.max_distortion,
        "seed": skin.seed,
        "scale": skin.source.scale,
    }


def _profile(name: str) -> str:
    """A bundled profile's name, or the name of a file of one's own: its folder means nothing on another machine."""
    return PureWindowsPath(name).name if name.endswith(".toml") else name


def _mesh(skin: Skin) -> dict[str, Any]:
    source = skin.source
    return {
        "file": source.file,
        "sha256": source.sha256,
        "n_vertices": len(skin.mesh.V),
        "n_faces": len(skin.mesh.F),
        "units": source.units,
        "bbox_mm": skin.object.bbox.tolist(),
    }


def _piece(piece: Piece, d: Distortion) -> dict[str, Any]:
    outline = piece.outline
    return {
        "id": piece.id,
        "size_mm": list(piece.size),
        "n_faces": len(piece.F),
        "area_mm2": piece.area,
        "distortion": {"mean": d.mean, "p95": d.p95, "p99": d.p99, "max": d.max},
        "flipped": d.flipped,
        "overlap_mm2": d.overlap_mm2,
        "boundary_mm": float(np.linalg.norm(outline - np.roll(outline, -1, axis=0), axis=1).sum()),
    }


def _overall(skin: Skin, distortions: Sequence[Distortion]) -> dict[str, float]:
    """Mean, 99 % quantile and maximum of d over all pieces, weighted by area on the object."""
    if not skin.pieces:
        return {"mean": 4.0, "p99": 4.0, "max": 4.0}
    d = np.concatenate([each.d for each in distortions])
    area = np.concatenate([skin.mesh.face_areas[piece.faces] for piece in skin.pieces])
    order = np.argsort(d)
    share = np.cumsum(area[order]) / area.sum()
    p99 = d[order[min(int(np.searchsorted(share, 0.99)), len(d) - 1)]]
    return {"mean": float(np.average(d, weights=area)), "p99": float(p99), "max": float(d.max())}


def _sensor(sensor: Sensor, material: Material, along: StrainAlong, even: float) -> dict[str, Any]:
    length = sensor.path.length
    board, board_input = board_of(sensor.channel)
    r = resistance(length, material.ink)
    return {
        "id": sensor.id,
        "kind": sensor.pattern.kind,
        "piece": sensor.piece,
        "params": _plain(parameters(sensor.pattern)),
        "length_mm": length,
        # The pads are ink too, though no current runs their whole length.
        "ink_mm3": ink_volume(sensor.printed_path.length, material.ink),
        "resistance_kohm": {"low": r.low, "median": r.median, "high": r.high},
        "wrap_strain": strain_facts(sensor, along, material, even=even),
        "channel": sensor.channel,
        "board": board,
        "board_input": board_input,
        "terminals_mm": [sensor.path.start.tolist(), sensor.path.end.tolist()],
    }


def _plain(value: Any) -> Any:
    """The same value in the types JSON knows: arrays and tuples as lists, NumPy numbers as numbers, paths as text."""
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    return value.as_posix() if isinstance(value, Path) else value


def _not_finite(value: Any, where: str) -> str:
    """Where in the report the first number lies that is none; "" when there is none."""
    if isinstance(value, dict):
        return next((bad for key, each in value.items() if (bad := _not_finite(each, f"{where}.{key}".lstrip(".")))), "")
    if isinstance(value, list):
        return next((bad for k, each in enumerate(value) if (bad := _not_finite(each, f"{where}[{k}]"))), "")
    return where if isinstance(value, float) and not np.isfinite(value) else ""
