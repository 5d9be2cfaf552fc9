"""Sensors from a file: `--sensors FILE.toml`.

A list of sensors, each at a place of one's own or wherever it fits, and a table for automatic placement::

    [auto]                              # fill the rest; leave the table out for the listed sensors alone
    kinds = ["contact-spiral"]          # what to place: "contact-spiral", "strain-lines"; default both
    sizes = [22, 15]                    # outer diameters of contact spirals, mm; default the paper's
    per_piece = 2                       # so many contact sensors on each piece where they fit; default by its faces and area

    [[sensor]]
    kind = "contact-spiral"
    params = { n = 3, x = 1.7, b = 1.5, l = 3, s = 15 }
    pose = { piece = "P1", x = 12.5, y = 20.0, angle_deg = 90 }   # where the pattern's origin lies on the flat piece

    [[sensor]]
    id = "S1"                           # optional; default C1, C2, ... and S1, S2, ...
    channel = 7                         # optional; default the next free one, from 0
    kind = "strain-lines"
    params = { l1 = 60, l2 = 54, b = 6 }
    pose = "auto"                       # wherever it fits best; a strain sensor on a finger: across the middle joint

    [[sensor]]
    kind = "contact-spiral"
    params = { n = 3, x = 1.7, b = 1.5, l = 3, s = 15 }
    pose = { point = [4.0, 0.0, 31.5] } # mm on the object: its middle goes to the nearest point of the surface

    [[sensor]]
    kind = "strain-neck"
    params = { l1 = 15, l2 = 40, l3 = 32, b1 = 2, b2 = 12 }
    pose = { joint = [0.0, 0.0, 45.0], along = [0, 0, 1], facing = [0, 1, 0] }   # across that joint, on the side that faces y

`point` takes an `angle_deg` too; without one, the direction with the most room is chosen. The bead's width, the
gap and the pad's side are the material's unless `params` has `bead`, `gap` or `pad`. `along` is the object's long axis
unless given; `facing` may be left out, and may stand alone: anywhere, but where the surface faces that way. The least is a
kind and its size, ``params = { s = 15 }``: other parameters follow from it, and without a pose it goes wherever it fits.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, TypeAlias

from skinfab.errors import InputError
from skinfab.material import Material
from skinfab.patterns.base import Pattern
from skinfab.patterns.registry import PATTERNS, make_pattern
from skinfab.placement.auto import AutoOptions
from skinfab.placement.check import refuse_narrow_bead
from skinfab.placement.sensor import ID, ID_WORDS, Sensor
from skinfab.toml_file import read_toml

Vector: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True)
class FlatPose:
    """A pose on a flat piece: mm and rad."""

    piece: str
    x: float
    y: float
    angle: float


@dataclass(frozen=True)
class OnObject:
    """A place on the object, mm; without an angle (rad, on the flat piece) any direction will do."""

    point: Vector
    angle: float | None


@dataclass(frozen=True)
class Anywhere:
    """Wherever it fits best, "auto": across a joint (a point of it, mm, and the direction stretched by bending), and where the
    surface faces a direction, if these are given."""

    joint: Vector | None = None
    along: Vector | None = None
    facing: Vector | None = None


Pose: TypeAlias = FlatPose | OnObject | Anywhere


@dataclass(frozen=True)
class Request:
    """One sensor as the file asks for it; `where` is "sensor 3 (C2) of FILE"."""

    where: str
    id: str
    channel: int
    pattern: Pattern
    pose: Pose


@dataclass(frozen=True)
class SensorsFile:
    """What a file asks for; `auto` is None where it has no [auto] table."""

    requests: tuple[Request, ...]
    auto: AutoOptions | None


def read_sensors_file(path: str | Path, *, material: Material, present: Sequence[Sensor] = ()) -> SensorsFile:
    """Read a file of sensors; ids and channels of those that are `present` already are taken.

    Raises
    ------
    InputError
        No such file, not TOML, or a field unknown, missing or of the wrong type: says which sensor and which field.
    """
    try:
        data = read_toml(Path(path), path)
    except OSError as fault:
        raise InputError(f"cannot read sensors from {path}: {fault.strerror}") from fault
    where = Path(path).name
    _known(data, ("auto", "sensor"), where)
    tables = data.get("sensor", [])
    if not isinstance(tables, list) or not all(isinstance(t, dict) for t in tables):
        raise InputError(f"{where}: 'sensor' must be a list of tables; write [[sensor]] with two brackets")
    if not tables and "auto" not in data:
        raise InputError(f"{where} asks for no sensor; add a [[sensor]] or an [auto] table")
    auto = _auto(data["auto"], f"{where}, [auto]") if "auto" in data else None
    return SensorsFile(_requests(tables, where, material, present), auto)


def _auto(table: Any, where: str) -> AutoOptions:
    if not isinstance(table, dict):
        raise InputError(f"{where}: it must be a table")
    _known(table, tuple(f.name for f in fields(AutoOptions)), where)
    options: dict[str, Any] = {}
    if "kinds" in table:
        kinds = table["kinds"]
        if not isinstance(kinds, list) or not all(isinstance(k, str) for k in kinds):
            raise InputError(f"{where}: kinds is {kinds!r}; it must be a list of names")
        options["kinds"] = tuple(kinds)
    if "sizes" in table:
        if not isinstance(table["sizes"], list):
            raise InputError(f"{where}: sizes is {table['sizes']!r}; it must be a list of diameters, mm")
        options["sizes"] = tuple(_number(s, "sizes", where) for s in table["sizes"])
    if "per_piece" in table:
        options["per_piece"] = _count(table["per_piece"], "per_piece", where, least=1)
    try:
        return AutoOptions(**options)
    except InputError as fault:
        raise InputError(f"{where}: {fault}") from fault


def _requests(tables: Sequence[Mapping[str, Any]], where: str, material: Material, present: Sequence[Sensor]) -> tuple[Request, ...]:
    ids = [*(s.id for s in present), *(t["id"] for t in tables if "id" in t)]
    channels = [*(s.channel for s in present), *(t["channel"] for t in tables if "channel" in t)]
    requests = []
    for k, table in enumerate(tables, 1):
        id = table["id"] if "id" in table else _default_id(table.get("kind"), ids)
        here = f"sensor {k} ({id}) of {where}" if id and isinstance(id, str) else f"sensor {k} of {where}"
        _known(table, ("id", "channel", "kind", "params", "pose"), here)
        for name in ("kind", "params"):
            if name not in table:
                raise InputError(f"{here}: field {name!r} is missing; it needs kind and params")
        if not isinstance(table["kind"], str) or not isinstance(table["params"], dict):
            raise InputError(f"{here}: kind must be a name and params a table such as {{ s = 15 }}")
        try:
            pattern = make_pattern(
                table["kind"], {"bead": material.ink.bead_width, "gap": material.gap, "pad": material.pad, **table["params"]}
            )
            refuse_narrow_bead(pattern, material.ink)
        except InputError as fault:
            raise InputError(f"{here}: {fault}") from fault
        if not isinstance(id, str) or not ID.fullmatch(id):
            raise InputError(f'sensor {k} of {where}: id is {str(id)[:40]!r}; it must be a name such as "C1": {ID_WORDS}')
        channel = _count(table["channel"], "channel", here) if "channel" in table else _next(channels, lambda n: n)
        ids.append(id)
        channels.append(channel)
        pose = _pose(table.get("pose", "auto"), here)
        if isinstance(pose, Anywhere) and pose.joint is not None and pattern.senses != "strain":
            raise InputError(f"{here}: a {pattern.kind} is not stretched by a joint; give it a point or a direction to face")
        requests.append(Request(here, id, channel, pattern, pose))
    taken = {"id": [s.id for s in present], "channel": [str(s.channel) for s in present]}
    for name, values in (("id", [r.id for r in requests]), ("channel", [str(r.channel) for r in requests])):
        for request, value in zip(requests, values, strict=True):
            if value in taken[name]:
                raise InputError(f"{request.where}: {name} {value} is that of a sensor which is there already; choose another")
        twice = [r.where for r, value in zip(requests, values, strict=True) if values.count(value) > 1]
        if twice:
            value = next(v for v in values if values.count(v) > 1)
            raise InputError(f"{twice[1]}: {name} {value} is used more than once; give each sensor its own")
    return tuple(requests)


def _default_id(kind: Any, taken: Sequence[Any]) -> str | None:
    """The next free name of that kind of pattern; None where there is no such kind."""
    if not isinstance(kind, str) or kind not in PATTERNS:
        return None
    letter = PATTERNS[kind].senses[0].upper()
    return str(_next(taken, lambda n: f"{letter}{n + 1}"))


def _pose(pose: Any, where: str) -> Pose:
    if pose == "auto":
        return Anywhere()
    if not isinstance(pose, dict):
        forms = "{ piece, x, y, angle_deg }, { point = [x, y, z] }, { joint = [x, y, z] } or { facing = [x, y, z] }"
        raise InputError(f'{where}: pose is {pose!r}; it must be "auto", {forms}')
    if "point" in pose:
        _known(pose, ("point", "angle_deg"), f"{where}, pose")
        angle = math.radians(_number(pose["angle_deg"], "angle_deg", where)) if "angle_deg" in pose else None
        return OnObject(_vector(pose, "point", where), angle)
    if "joint" in pose or "facing" in pose or "along" in pose:
        _known(pose, ("joint", "along", "facing"), f"{where}, pose")
        if "along" in pose and "joint" not in pose:
            raise InputError(f"{where}, pose: along is the direction that a joint stretches; give the joint too")
        joint = _vector(pose, "joint", where) if "joint" in pose else None
        return Anywhere(joint, *(_direction(pose, name, where) if name in pose else None for name in ("along", "facing")))
    _known(pose, ("piece", "x", "y", "angle_deg"), f"{where}, pose")
    for name in ("piece", "x", "y"):
        if name not in pose:
            raise InputError(f"{where}, pose: field {name!r} is missing; it needs piece, x and y, or a point")
    if not isinstance(pose["piece"], str):
        raise InputError(f'{where}, pose: piece is {pose["piece"]!r}; it must be a name such as "P1"')
    x, y, degrees = (_number(pose.get(name, 0.0), name, f"{where}, pose") for name in ("x", "y", "angle_deg"))
    return FlatPose(pose["piece"], x, y, math.radians(degrees))


def _known(table: Mapping[str, Any], names: Sequence[str], where: str) -> None:
    for name in table:
        if name not in names:
            near = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
            hint = f" (did you mean {near[0]!r}?)" if near else ""
            raise InputError(f"{where}: unknown field {name!r}{hint}; it knows {', '.join(names)}")


def _number(value: Any, name: str, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise InputError(f"{where}: {name} is {value!r}; it must be a number")
    return float(value)


def _vector(pose: Mapping[str, Any], name: str, where: str) -> Vector:
    value = pose[name]
    if not isinstance(value, list) or len(value) != 3:
        raise InputError(f"{where}: {name} is {value!r}; it must be [x, y, z]")
    x, y, z = (_number(c, name, where) for c in value)
    return x, y, z


def _direction(pose: Mapping[str, Any], name: str, where: str) -> Vector:
    """A vector made one long."""
    x, y, z = _vector(pose, name, where)
    length = math.hypot(x, y, z)
    if not length:
        raise InputError(f"{where}: {name} is [0, 0, 0], which is no direction; [0, 0, 1] is up along z")
    return x / length, y / length, z / length


def _count(value: Any, name: str, where: str, *, least: int = 0) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise InputError(f"{where}: {name} is {value!r}; it must be a whole number, {least} or more")
    return value


def _next(taken: Sequence[Any], name: Any) -> Any:
    return next(name(n) for n in range(len(taken) + 1) if name(n) not in taken)
