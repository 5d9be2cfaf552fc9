"""Grasps as a CSV file: a row a pose of a grasp, with each fingertip's place and turn by the joints and what its sensor read.

Columns: ``time`` (s; any that goes on), ``grasp`` and ``object`` (numbers), ``shape`` (0 sphere, 1 cylinder, 2 cuboid; empty
where nobody knows) and ``size_1`` to ``size_3`` (mm, as of `Solid`), then for each finger 1 to 4 ``f1_x f1_y f1_z`` (mm) and
``f1_rx f1_ry f1_rz`` (rotation vector, rad) in the hand's frame, ``f1_Fx`` to ``f1_Mz`` (N, N mm) in the fingertip's.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from skinfab.errors import InputError
from skinfab.files import atomic_write
from skinfab.fingertip.force.grasp import FINGERS, SHAPES, Grasp, Solid
from skinfab.fingertip.force.wrench import WRENCH
from skinfab.readout.table import Table, read_table

_POSE = ("x", "y", "z", "rx", "ry", "rz")
#: Sizes of `Solid`, by shape.
_SIZES = {"sphere": 1, "cylinder": 2, "cuboid": 3}
FINGER_COLUMNS = tuple(f"f{k + 1}_{name}" for k in range(FINGERS) for name in (*_POSE, *WRENCH))


def write_grasps(grasps: Sequence[Grasp], path: str | Path) -> None:
    """Write grasps, whole or not at all; the true centre is not among what is written.

    Examples
    --------
    >>> import tempfile
    >>> from skinfab.fingertip.force.grasp import NEW, simulate_grasp
    >>> path = Path(tempfile.mkdtemp()) / "grasps.csv"
    >>> write_grasps([simulate_grasp(NEW[0], poses=2)], path)
    >>> (back,) = read_grasps(path)
    >>> back.solid, back.force.shape, back.simulated
    (Solid(shape='sphere', size=(37.0,)), (2, 4, 3), True)
    """
    text = io.StringIO()
    if any(each.simulated for each in grasps):
        text.write("# simulated: true\n")
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["time", "grasp", "object", "shape", "size_1", "size_2", "size_3", *FINGER_COLUMNS])
    time = 0
    for number, each in enumerate(grasps):
        sizes = [f"{x:.6g}" for x in each.solid.size] if each.solid else []
        head = [str(number), str(each.object), str(SHAPES.index(each.solid.shape)) if each.solid else "", *sizes, *[""] * (3 - len(sizes))]
        for force, moment in zip(each.force, each.moment, strict=True):
            of = np.hstack([each.position, each.turn, force, moment]).ravel()
            rows.writerow([str(time), *head, *(f"{value:.8g}" for value in of)])
            time += 1
    atomic_write(path, text.getvalue())


def read_grasps(path: str | Path) -> list[Grasp]:
    """Read grasps, in the order in which they begin.

    Raises
    ------
    InputError
        The file cannot be read, lacks a column, or a grasp lacks a number, has a shape that is none, or changes its contacts
        from pose to pose; which one is said.
    """
    table = read_table(path)
    if missing := next((name for name in ("grasp", "object", *FINGER_COLUMNS) if name not in table.columns), None):
        raise InputError(f"{path} has no column {missing!r}; a grasp is f1_x ... f4_Mz, a grasp's number and an object's (docs/force.md)")
    number = table.columns["grasp"]
    if not (np.isfinite(number).all() and np.isfinite(table.columns["object"]).all()):
        raise InputError(f"{path}: each row needs the number of its grasp and of its object; fill them in")
    return [_grasp(table, np.flatnonzero(number == k), f"{path}, grasp {k:g}") for k in dict.fromkeys(number.tolist())]


def _grasp(table: Table, rows: np.ndarray, where: str) -> Grasp:
    of = np.array([table.columns[name][rows] for name in FINGER_COLUMNS]).T.reshape(len(rows), FINGERS, 12)
    if not np.isfinite(of).all():
        raise InputError(f"{where}: a number of a finger is missing; leave the grasp out or fill it in")
    numbers = table.columns["object"][rows]
    # Written with eight digits; a finger that has moved touches elsewhere, and its readings cannot be taken together.
    if not np.allclose(of[:, :, :6], of[:1, :, :6], rtol=1e-6, atol=1e-6) or (numbers != numbers[0]).any():
        raise InputError(f"{where}: fingers or object change from pose to pose; give such poses as grasps of their own")
    return Grasp(
        of[0, :, :3],
        of[0, :, 3:6],
        of[:, :, 6:9],
        of[:, :, 9:],
        _solid(table, int(rows[0]), where),
        int(numbers[0]),
        simulated=table.simulated,
    )


def _solid(table: Table, row: int, where: str) -> Solid | None:
    none = np.full(len(table.time), np.nan)
    code = float(table.columns.get("shape", none)[row])
    if not np.isfinite(code):
        return None
    if code not in range(len(SHAPES)):
        raise InputError(f"{where}: shape {code:g} is none; 0 is a sphere, 1 a cylinder, 2 a cuboid")
    shape = SHAPES[int(code)]
    size = [float(table.columns.get(f"size_{k + 1}", none)[row]) for k in range(_SIZES[shape])]
    try:
        return Solid(shape, tuple(size))
    except InputError as fault:
        raise InputError(f"{where}: {fault}") from fault
