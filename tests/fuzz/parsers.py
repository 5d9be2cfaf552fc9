"""Every door through which a file of somebody else comes in: what reads it, and files that it reads, to be broken.

A parser may give a result that holds together, or one sentence; anything else it does to any bytes at all is a finding.
"""

from __future__ import annotations

import io
import math
import re
import subprocess
import zipfile
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from unittest import mock

import forked
import numpy as np
import seeds

from calibration.mocap.markers import read_markers
from calibration.mocap.vicon import read_vicon
from calibration.strain.document import load_calibration
from gcode.check import judge
from gcode.parse import parse
from gcode.printer import Printer, load_printer
from gcode.words import read_text
from skinfab.batch.job import Job
from skinfab.batch.plan import Plan, read_plan
from skinfab.batch.record import read_record
from skinfab.batch.run import Outcome
from skinfab.batch.table import write_tables
from skinfab.document import load_skin
from skinfab.errors import LONGEST, InputError, RefusedError
from skinfab.fingertip.array.learn import load_array
from skinfab.fingertip.force.gravity_model import load_hand
from skinfab.fingertip.force.labels import with_labels
from skinfab.fingertip.force.liquid_model import load_liquid
from skinfab.fingertip.force.motion_file import read_events
from skinfab.fingertip.force.shape import ShapeModel
from skinfab.fingertip.force.texture_model import load_texture
from skinfab.fingertip.force.touch_model import load_touches, read_places
from skinfab.fingertip.nail.labels import read_labels
from skinfab.fingertip.nail.model_file import load_nail
from skinfab.fingertip.optical.model_file import load_edge
from skinfab.fingertip.optical.picture import read_picture
from skinfab.fingertip.optical.targets import read_targets
from skinfab.fingertip.saved import load_model
from skinfab.material import load_material
from skinfab.mesh.door import load_usable
from skinfab.mesh.io import load_mesh
from skinfab.placement.sensors_file import read_sensors_file
from skinfab.readout.decode import AnyDecoder
from skinfab.readout.logs.log import read_log, read_log_table
from skinfab.seams.manual import read_cuts
from skinfab.strip_table import read_strips
from skinfab.wiring import read_wiring


@dataclass(frozen=True)
class Parser:
    """A door.

    Parameters
    ----------
    read : callable
        Reads a file and holds what it gives against what it promises.
    seeds : callable
        Makes whole files for a start.
    suffix : str
        Of the file's name.
    """

    read: Callable[[Path], None]
    seeds: Callable[[], list[bytes]]
    suffix: str


def run(parser: Parser, data: bytes, folder: Path) -> str:
    """Give these bytes to a parser: its sentence, or nothing where it read them.

    Raises
    ------
    AssertionError
        What it gave, or said, breaks its promise.
    Exception
        Anything else is a finding too.
    """
    path = folder / f"given{parser.suffix}"
    path.write_bytes(data)
    try:
        parser.read(path)
    except (InputError, RefusedError) as fault:
        said = str(fault)
        assert said.strip() and "\n" not in said and len(said) <= LONGEST, said
        return said
    return ""


def _mesh(path: Path) -> None:
    loaded = load_mesh(path)
    V, F = loaded.mesh.V, loaded.mesh.F
    assert np.isfinite(V).all() and len(F) and F.min() >= 0 and F.max() < len(V)
    assert V.dtype == np.float64 and F.dtype == np.int64
    usable = load_usable(path).mesh
    assert np.isfinite(usable.V).all() and (np.bincount(usable.F.ravel(), minlength=len(usable.V)) > 0).all()


def _unchecked() -> AbstractContextManager[object]:
    """A zip that is hit anywhere fails by its checksums and is looked at no further: somebody who means harm makes them right."""
    return mock.patch.object(zipfile.ZipExtFile, "_update_crc", return_value=None)


def _skin(path: Path) -> None:
    with _unchecked():
        skin = load_skin(path)
    assert np.isfinite(skin.mesh.V).all() and all(np.isfinite(piece.UV).all() for piece in skin.pieces)
    assert all(math.isfinite(number) for s in skin.sensors for number in (s.x, s.y, s.angle)) and math.isfinite(skin.max_distortion)


def _skin_json(path: Path) -> None:
    """The document's text alone is broken, and may become longer or shorter."""
    _skin(_with_text(path, seeds.document(), "skin.json"))


def _with_text(path: Path, archive: bytes, text: str) -> Path:
    """This archive with the file as its text."""
    document = path.with_suffix(".zip")
    with zipfile.ZipFile(io.BytesIO(archive)) as whole, zipfile.ZipFile(document, "w") as made:
        for name in whole.namelist():
            made.writestr(name, path.read_bytes() if name == text else whole.read(name))
    return document


@cache
def _printers() -> tuple[Printer, ...]:
    return load_printer("generic-marlin"), load_printer("generic-grbl")


def _gcode(path: Path) -> None:
    text = read_text(path)
    for printer in _printers():
        said = judge(text, printer)
        assert all("\n" not in str(finding) for finding in said.findings) and "\n" not in said.broken_off
    assert parse(text).steps is not None


def _frames(path: Path) -> None:
    data = path.read_bytes()
    for size in (len(data) or 1, 7):
        decoder, kept = AnyDecoder(), 0
        for k in range(0, len(data), size):
            for frame in decoder.feed(data[k : k + size], host_time=k / 1e4):
                assert decoder.stream is not None and len(frame.values) == len(decoder.stream.channels)
                kept += 1
        decoder.reset()
        assert kept <= len(data)


def _log(path: Path) -> None:
    made = read_log(path).recording
    assert made.values.shape == (len(made), len(made.stream.channels)) == made.valid.shape
    table, _ = read_log_table(path)
    assert all(len(column) == len(table.time) for column in table.columns.values()) and np.isfinite(table.time).all()


def _markers(path: Path) -> None:
    made = read_vicon(path)
    assert np.isfinite(made.time).all() and all(each.shape == (len(made.time), 3) for each in made.positions.values())


def _c3d(path: Path) -> None:
    with mock.patch.object(subprocess, "run", forked.run):
        made = read_markers(path)
    assert made.positions and all(each.shape == (len(made.time), 3) for each in made.positions.values())
    assert np.isfinite(made.time).all() and not any("\n" in note for note in made.notes)


def _printer(path: Path) -> None:
    assert min(load_printer(path).bed.size) > 0


def _material(path: Path) -> None:
    assert load_material(path).ink.bead_width > 0


def _plan(path: Path) -> None:
    assert read_plan(path, output=path.parent / "out").jobs


def _record(path: Path) -> None:
    """The record of a job, with the tables that show it."""
    job = Job("n", str(path.parent / "a.obj"), {})
    record = read_record(path, job.name)
    assert record is not None
    write_tables(Plan((job,), (), {job.name: {}}), Outcome({job.name: record}, 1, ()), path.parent)


def _sensors(path: Path) -> None:
    made = read_sensors_file(path, material=load_material())
    assert made.requests or made.auto


def _cuts(path: Path) -> None:
    assert all(len(each) > 1 and each.min() >= 0 and each.max() < 100 for each in read_cuts(path, 100))


def _strips(path: Path) -> None:
    made = read_strips(path)
    assert len(made.length_mm) == len(made.r_kohm) > 0 and np.isfinite(made.length_mm).all() and (made.r_kohm > 0).all()


def _wiring(path: Path) -> None:
    assert all(wire.channel >= 0 and math.isfinite(wire.median) for wire in read_wiring(path))


def _model(path: Path) -> None:
    with _unchecked():
        assert all(np.isfinite(array).all() for array in load_model(path, kind="nail").arrays.values())


#: What reads a model, by its kind.
_LOADERS: dict[str, Callable[[Path], object]] = {
    "force contact": load_touches,
    "force hand": load_hand,
    "force texture": load_texture,
    "force shape": lambda path: ShapeModel.load(path).limits,
    "force liquid": load_liquid,
    "nail phasors": load_nail,
    "optical edge": load_edge,
    "tactel array": load_array,
}


def _fingertip(path: Path) -> None:
    """The text of a model, of the kind that it says; what it says of itself is broken, and its arrays are not."""
    said = re.search(rb'"kind": "([\w ]+)"', path.read_bytes())
    kind = said[1].decode() if said else ""
    kind = kind if kind in _LOADERS else "force liquid"
    _LOADERS[kind](_with_text(path, seeds.fingertips()[kind], "model.json"))


def _calibration(path: Path) -> None:
    assert math.isfinite(load_calibration(path).u0)


def _targets(path: Path) -> None:
    for name in ("one", "two"):
        (path.parent / f"{name}.png").write_bytes(seeds.picture(name))
    read = read_targets(path)
    assert len(read.names) == len(read.images) == len(read.edges) == len(read.groups) > 0
    assert all(math.isfinite(edge.offset_mm) and math.isfinite(edge.angle_rad) for edge in read.edges)


def _picture(path: Path) -> None:
    image, _ = read_picture(path)
    assert image.dtype == np.uint8 and image.ndim == 2 and image.size


def _nail_labels(path: Path) -> None:
    labels, _ = read_labels(path)
    assert labels and all(0 <= each.start_s < each.end_s for each in labels)


def _events(path: Path) -> None:
    assert all(each.start <= each.end for several in read_events(path).values() for each in several)


def _places(path: Path) -> None:
    assert all(np.isfinite(place).all() and place.shape == (3,) for place in read_places(path).values())


def _force_labels(path: Path) -> None:
    assert with_labels([], path) == []


_LOGS = {name: Parser(_log, partial(seeds.logs, f"a.{name}"), f".{name}") for name in ("mcap", "bag")}

#: All of them, by name.
PARSERS: dict[str, Parser] = {
    **{kind: Parser(_mesh, partial(seeds.meshes, kind), f".{kind}") for kind in ("obj", "stl", "ply", "off", "glb")},
    "skin": Parser(_skin, seeds.documents, ".skin"),
    "skin-json": Parser(_skin_json, seeds.document_texts, ".json"),
    "model": Parser(_model, seeds.models, ".model"),
    "fingertip-json": Parser(_fingertip, seeds.fingertip_texts, ".json"),
    "gcode": Parser(_gcode, seeds.programs, ".gcode"),
    "printer": Parser(_printer, seeds.profiles, ".toml"),
    "material": Parser(_material, seeds.materials, ".toml"),
    "sensors": Parser(_sensors, seeds.sensor_files, ".toml"),
    "plan": Parser(_plan, seeds.plans, ".toml"),
    "record": Parser(_record, seeds.records, ".json"),
    "cuts": Parser(_cuts, seeds.cuts, ".txt"),
    "strips": Parser(_strips, seeds.strip_tables, ".csv"),
    "wiring": Parser(_wiring, seeds.wirings, ".csv"),
    "frames": Parser(_frames, seeds.wire, ".bin"),
    "recording": Parser(_log, partial(seeds.logs, "a.frames"), ".frames"),
    "csv": Parser(_log, seeds.tables, ".csv"),
    **_LOGS,
    "db3": Parser(_log, partial(seeds.logs, "bag"), ".db3"),
    "vicon": Parser(_markers, seeds.captures, ".csv"),
    "c3d": Parser(_c3d, seeds.c3d, ".c3d"),
    "targets": Parser(_targets, seeds.targets, ".csv"),
    "picture": Parser(_picture, seeds.pictures, ".png"),
    "nail-labels": Parser(_nail_labels, seeds.nail_labels, ".csv"),
    "events": Parser(_events, seeds.events, ".csv"),
    "places": Parser(_places, seeds.places, ".csv"),
    "force-labels": Parser(_force_labels, seeds.force_labels, ".csv"),
    "calibration": Parser(_calibration, seeds.calibrations, ".json"),
}
