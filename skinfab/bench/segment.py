"""Automatic seams: pieces and length of seam against the bound and against time, beside xatlas."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinfab.bench.contestants import Contestant, Flat, contestants
from skinfab.bench.disks import bumpy_cap
from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.timing import ENOUGH_S, one_processor, timed_twice
from skinfab.errors import InputError, RefusedError
from skinfab.flatten.distortion import best_scale, measure
from skinfab.mesh.door import load_usable
from skinfab.mesh.model import Mesh
from skinfab.mesh.topology import Topology
from skinfab.progress import Progress, silent
from skinfab.seams.auto import Aim, Seams, find_seams
from skinfab.seams.finish import finish
from skinfab.seams.judge import Limits

#: What `find_seams` can aim at, its default first.
AIMS: tuple[Aim, ...] = ("usual", "fewest")
#: Bounds on the mean d that seams are found for; the default is among them.
BOUNDS = (4.02, 4.05, 4.1, 4.2)
#: The peer, which knows no bound.
PEER = "xatlas"

#: Both aims are run once on this many triangles, to a bound that needs darts, before anything is timed: numba's compiling.
_WARM_UP, _WARM_UP_BOUND = 300, 4.01
#: Between two pieces, as a share of the first one's width.
_GAP = 0.1


@dataclass(frozen=True)
class Row:
    """One method on one object.

    Parameters
    ----------
    object : str
    triangles : int
    method : str
        One of `AIMS`, or the peer.
    bound : float
        On the mean d; NaN for the peer.
    pieces : int
    seam : float
        Length of all cut edges, each once, over the root of the area.
    mean_d, p99_d, max_d : float
        Over all pieces.
    flipped : int
    overlap_mm2 : float
    seconds : float
        Of the process itself, from the mesh to the finished flat pieces; the least of the repeats.
    peak_mb : float
        By how much memory rose above what it was before; NaN where the system does not tell.
    repeats : int
    """

    object: str
    triangles: int
    method: str
    bound: float
    pieces: int
    seam: float
    mean_d: float
    p99_d: float
    max_d: float
    flipped: int
    overlap_mm2: float
    seconds: float
    peak_mb: float
    repeats: int


def mesh_files(given: Sequence[Path] = ()) -> list[Path]:
    """The meshes that come with the project, where its folder is there, and those given.

    Raises
    ------
    InputError
        There are none.
    """
    files = [*sorted((Path(__file__).parents[2] / "meshes").glob("*.obj")), *given]
    if not files:
        raise InputError("the folder meshes is not beside the package, so there is nothing to find seams on; name mesh files with --meshes")
    return list(dict.fromkeys(files))


def run(
    folder: Path, *, meshes: Sequence[Path] = (), sizes: Sequence[int] = (), repeats: int = REPEATS, progress: Progress = silent
) -> dict[str, Any]:
    """Measure, and write segment.csv, segment.png and segment.txt into `folder`; with `sizes` growth.csv and growth.png, too.

    Parameters
    ----------
    folder : Path
        There already.
    meshes : sequence of Path
        Beside those of `mesh_files`.
    sizes : sequence of int
        Triangles of a test ball that all methods are run on once, for how their time grows.
    repeats : int
        Of each method on each object, in turn with the others; the least time counts.
    progress : Progress

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement) and "rows"; with `sizes` "growth", too.

    Raises
    ------
    InputError
        A mesh cannot be used, or a file not be written.
    """
    from skinfab.bench.segment_chart import draw
    from skinfab.bench.segment_growth import follow, growth_sentence
    from skinfab.bench.segment_words import sentence
    from skinfab.files import atomic_write

    objects = [(file.stem, load_usable(file, mend=True).mesh) for file in mesh_files(meshes)]
    peer = next(c for c in contestants() if c.name == PEER)
    notes = [] if peer.present else [f"{PEER} is not installed here and was left out; pip install {PEER} adds it"]
    with one_processor() as alone:
        if not alone:
            notes.append("this system cannot keep a process on one processor: libraries with threads of their own may use more")
        for aim in AIMS:
            _seams(Mesh(*bumpy_cap(_WARM_UP)), aim, Limits(mean=_WARM_UP_BOUND))
        present = peer if peer.present else None
        rows, refused = measure_objects(objects, present, repeats=repeats, progress=progress)
        growth, too_large = follow(folder, sizes, present, progress=progress) if sizes else ([], [])
    notes += refused + too_large
    write_csv(rows, folder / "segment.csv")
    # From here on only what the table holds is used, so that chart and sentence cannot say anything else.
    table = read_csv(folder / "segment.csv")
    said = sentence(table)
    draw(table, folder / "segment.png", notes=[note for note in notes if note not in too_large])
    said = "\n".join([said, *([growth_sentence(growth)] if growth else [])])
    atomic_write(folder / "segment.txt", "\n".join([said, *notes]) + "\n")
    return {"sentence": said, "notes": notes, "rows": table, **({"growth": growth} if sizes else {})}


def measure_objects(
    objects: Sequence[tuple[str, Mesh]],
    peer: Contestant | None,
    *,
    aims: Sequence[Aim] = AIMS,
    bounds: Sequence[float] = BOUNDS,
    repeats: int = REPEATS,
    progress: Progress = silent,
) -> tuple[list[Row], list[str]]:
    """A row for every object, method and bound, and a sentence for each that was refused. Methods take turns on an object."""
    rows: list[Row] = []
    refused: list[str] = []
    for k, (name, mesh) in enumerate(objects):
        tasks: list[tuple[str, float]] = [(aim, bound) for bound in bounds for aim in aims]
        tasks += [] if peer is None else [(peer.name, np.nan)]
        seconds: dict[tuple[str, float], list[float]] = {task: [] for task in tasks}
        peaks: dict[tuple[str, float], list[float]] = {task: [] for task in tasks}
        flat: dict[tuple[str, float], Flat] = {}
        for turn in range(repeats):
            for j, task in enumerate(tasks):
                progress((k + (turn + j / len(tasks)) / repeats) / len(objects), f"{name}: {task[0]}")
                if sum(seconds[task]) >= ENOUGH_S or (turn and task not in flat):
                    continue
                try:
                    flat[task], own, _, peak_mb = timed_twice(_work(mesh, task, peer))
                except RefusedError as error:
                    refused.append(f"{name}: {task[0]} at {task[1]:g} was refused: {error}")
                    continue
                seconds[task].append(own)
                peaks[task].append(peak_mb)
        rows += [judged(name, mesh, *task, flat[task], seconds[task], peaks[task]) for task in tasks if task in flat]
    return rows, refused


def judged(
    name: str, mesh: Mesh, method: str, bound: float, flat: Flat, seconds: Sequence[float], peaks_mb: Sequence[float] = (np.nan,)
) -> Row:
    """How good a result is: its pieces right side up, clear of each other and at the scale of the least d, however they came."""
    V, topology = mesh.V[flat.origin], Topology(flat.F)
    count, piece = topology.face_components()
    uv = _in_a_row(flat, count, piece)
    d = measure(V, flat.F, uv * best_scale(V, flat.F, uv), topology=topology)
    # Each cut edge lies on two sides of pieces, the mesh's own boundary on one.
    ends = V[topology.E[topology.is_boundary]]
    sides = float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())
    seam = (sides - float(mesh.edge_lengths[mesh.topology.is_boundary].sum())) / 2
    return Row(
        object=name,
        triangles=len(mesh.F),
        method=method,
        bound=bound,
        pieces=int(count),
        seam=max(seam, 0.0) / float(np.sqrt(mesh.area)),
        mean_d=d.mean,
        p99_d=d.p99,
        max_d=d.max,
        flipped=d.flipped,
        overlap_mm2=d.overlap_mm2,
        seconds=min(seconds),
        peak_mb=min(peaks_mb),
        repeats=len(seconds),
    )


def as_flat(mesh: Mesh, seams: Seams) -> Flat:
    """The pieces as one result, faces in the mesh's order."""
    F, count = np.empty_like(mesh.F), 0
    for piece, _ in seams.pieces:
        F[piece.faces] = piece.F + count
        count += len(piece.vertices)
    return Flat(F, np.concatenate([v.UV for _, v in seams.pieces]), np.concatenate([piece.vertices for piece, _ in seams.pieces]))


def _in_a_row(flat: Flat, count: int, piece: NDArray[np.int64]) -> NDArray[np.float64]:
    """Each piece right side up, beside the one before: where one came to lie on a sheet with others is no matter here."""
    a, b, c = (flat.UV[flat.F[:, k]] for k in range(3))
    turned = np.linalg.det(np.stack([b - a, c - a], axis=1)) < 0
    UV, x = flat.UV.copy(), 0.0
    for k in range(count):
        vertices = np.unique(flat.F[piece == k])
        if 2 * turned[piece == k].sum() > (piece == k).sum():
            UV[vertices, 0] *= -1
        low, width = UV[vertices].min(axis=0), float(np.ptp(UV[vertices, 0]))
        UV[vertices] += [x, 0.0] - low
        x += (1 + _GAP) * width
    return UV


def _work(mesh: Mesh, task: tuple[str, float], peer: Contestant | None) -> Callable[[], Flat]:
    method, bound = task
    if peer is not None and method == peer.name:
        return peer.prepare(mesh.V, mesh.F)
    aim = next(aim for aim in AIMS if aim == method)
    fresh = Mesh(mesh.V, mesh.F)  # nothing that an earlier run has found out about it
    return lambda: as_flat(fresh, _seams(fresh, aim, Limits(mean=bound)))


def _seams(mesh: Mesh, aim: Aim, limits: Limits) -> Seams:
    return finish(mesh, find_seams(mesh, limits, aim=aim), limits)
