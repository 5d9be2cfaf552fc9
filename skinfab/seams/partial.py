"""Open a skin along its seams as they are now: lenient, so that a person can work on half-finished cuts."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skinfab.flatten.distortion import Distortion
from skinfab.material import Material
from skinfab.pieces import Piece
from skinfab.placement.carry import carry, put_back
from skinfab.placement.lifted import Lifted, in_line
from skinfab.placement.sensor import Sensor
from skinfab.progress import Progress, silent
from skinfab.seams.auto import Aim, find_seams
from skinfab.seams.cut import OpenPiece, open_pieces
from skinfab.seams.enclosed import enclosed_text
from skinfab.seams.finish import finish
from skinfab.seams.judge import Limits
from skinfab.seams.lenient import LaidFlat, kept_flat, lay_flat, require_method
from skinfab.seams.parted import parted_text
from skinfab.seams.pieces import to_pieces
from skinfab.seams.rules import edge_mask, edge_rules
from skinfab.skin import Skin

IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Fault:
    """Something wrong with a piece, or with a part of the object that is none yet.

    Parameters
    ----------
    text : str
        One sentence: what, where, what to do.
    faces : (k,) int64
        The mesh faces concerned; none where it is about a sensor.
    piece : str
        Id of the flat piece; "" where it could not be laid flat.
    """

    text: str
    faces: IntArray
    piece: str = ""


@dataclass(frozen=True, eq=False)
class Reopened:
    """A skin cut anew.

    Parameters
    ----------
    skin : Skin
        With new pieces, and its sensors where their spots now lie; those that have none are lifted.
    faults : tuple of Fault
        About parts that lie not flat, pieces that break a limit, and sensors.
    distortions : tuple of Distortion
        Of the pieces, in their order.
    lost : tuple of Sensor
        Sensors whose spot is on no piece any more, as they were.
    back : tuple of Sensor
        Lifted ones that came back.
    notes : tuple of str
        Why an automatic cut gives as many pieces as it does, where the bed or a neck is why.
    """

    skin: Skin
    faults: tuple[Fault, ...]
    distortions: tuple[Distortion, ...]
    lost: tuple[Sensor, ...]
    back: tuple[Sensor, ...] = ()
    notes: tuple[str, ...] = ()


def reopen(
    skin: Skin,
    limits: Limits,
    *,
    method: str = "auto",
    cones: int | None = None,
    anew: Collection[str] = (),
    material: Material | None = None,
    progress: Progress = silent,
) -> Reopened:
    """The pieces that a skin's seams now give, flattened where they changed.

    A piece whose faces and cuts are the same is the same object as before, under the same id. Of what a piece was parted
    into, the largest part keeps its id.

    Parameters
    ----------
    skin : Skin
    limits : Limits
        What pieces should keep to; those that do not are shown all the same, and named.
    method : str
        How changed pieces are flattened: "auto" as `skinfab segment` does, "bff-cones" (cuts further), or one of
        `flatten.methods.METHODS`.
    cones : int, optional
        How many for "bff-cones"; default as many as pay.
    anew : collection of str
        Ids of pieces to flatten by `method` though their cuts did not change.
    material : Material, optional
        Says whether sensors still fit.
    progress : Progress, optional

    Returns
    -------
    Reopened

    Raises
    ------
    InputError
        No such method, or cones without it. A bad cut is never raised: it is a fault in the result.
    """
    require_method(method, cones)
    mesh = skin.mesh
    cut = edge_mask(mesh, skin.seams)
    forbidden = None if skin.marks is None else edge_mask(mesh, skin.marks.forbidden)
    opened = open_pieces(mesh, cut | mesh.topology.is_boundary)
    old = {int(piece.faces.min()): piece for piece in skin.pieces}
    laid: list[tuple[LaidFlat, Piece | None]] = []
    done = 0
    for part in opened:
        progress(done / len(mesh.F), "flattening")
        done += len(part.faces)
        before = old.get(int(part.faces[0]))
        same = before if before is not None and before.id not in anew and _is_same(before, part) else None
        if same is not None:
            kept = OpenPiece(same.faces, same.vertices, same.F, same.topology)
            laid.append((kept_flat(mesh, kept, same.UV, limits), same))
        else:
            laid.append((lay_flat(mesh, part, limits, method=method, cones=cones, forbidden=forbidden), None))
    for flat, _ in laid:
        cut[flat.cut] = True
    pieces, distortions, faults = _named(skin, laid)
    seams = mesh.topology.E[cut & ~mesh.topology.is_boundary]
    progress(1.0, "flattening")
    return _with_sensors(
        replace(skin, seams=seams, pieces=pieces, max_distortion=limits.mean),
        skin,
        faults,
        distortions,
        material=material,
    )


def auto_cut(
    skin: Skin,
    limits: Limits,
    *,
    neck: float = 4.0,
    material: Material | None = None,
    aim: Aim = "usual",
    progress: Progress = silent,
) -> Reopened:
    """Automatic seams in place of the skin's own: locked ones stay, forbidden edges are left alone, preferences are heeded.

    Without marks they are the seams of `skinfab segment` for the same surface.

    Parameters
    ----------
    skin : Skin
        Its unlocked seams are forgotten.
    limits : Limits
    neck : float, mm
        Pieces are not joined across less than this.
    material : Material, optional
        Says whether sensors still fit.
    aim : "fewest", "usual" or "simplest"
        See `find_seams`.
    progress : Progress, optional

    Returns
    -------
    Reopened
        Faults are about sensors, and pieces that locked seams part off though they are too small to handle.

    Raises
    ------
    InputError, RefusedError
        No seams give good pieces, or the marks forbid them or contradict each other.
    """
    mesh = skin.mesh
    rules = None if skin.marks is None or skin.marks.empty else edge_rules(mesh, skin.marks)
    found = find_seams(mesh, limits, neck=neck, rules=rules, aim=aim, progress=lambda part: progress(0.95 * part, "cutting and flattening"))
    notes = tuple(parted_text(found.pieces, limits))
    found = finish(mesh, found, limits)
    pieces = to_pieces(mesh, found.pieces)
    by_first_face = {int(piece.faces[0]): verdict.distortion for piece, verdict in found.pieces}
    new = replace(skin, seams=mesh.topology.E[found.cut & ~mesh.topology.is_boundary], pieces=pieces, max_distortion=limits.mean)
    small = [] if rules is None else enclosed_text(mesh, pieces, rules.locked, neck)
    faults = [Fault(text, piece.faces, piece.id) for text, piece in small]
    progress(1.0, "cutting and flattening")
    distortions = [by_first_face[int(piece.faces[0])] for piece in pieces]
    return replace(_with_sensors(new, skin, faults, distortions, material=material), notes=notes)


def _with_sensors(
    new: Skin, before: Skin, faults: list[Fault], distortions: Sequence[Distortion], *, material: Material | None
) -> Reopened:
    carried = carry(new.mesh, before.sensors, before.pieces, new.pieces, material=material)
    old, lost = {piece.id: piece for piece in before.pieces}, {sensor.id for sensor in carried.lost}
    lifted = []
    for place, each in enumerate(in_line(before.sensors, before.lifted)):
        if isinstance(each, Lifted):
            lifted.append(replace(each, place=place))
        elif each.id in lost and each.piece in old:
            lifted.append(Lifted(each, old[each.piece], place=place))
    put = put_back(new.mesh, lifted, carried.sensors, new.pieces, material=material)
    nowhere = np.zeros(0, dtype=np.int64)
    said = (*faults, *(Fault(remark, nowhere) for remark in carried.remarks))
    return Reopened(replace(new, sensors=put.sensors, lifted=put.still), said, tuple(distortions), carried.lost, put.back)


def _is_same(piece: Piece, part: OpenPiece) -> bool:
    """Whether they have the same faces and the same cuts, however their vertices are numbered."""
    if len(piece.vertices) != len(part.vertices) or not np.array_equal(piece.faces, part.faces):
        return False
    number = np.full(len(part.vertices), -1)
    number[part.F.ravel()] = piece.F.ravel()
    return bool(np.array_equal(number[part.F], piece.F))


def _named(skin: Skin, laid: list[tuple[LaidFlat, Piece | None]]) -> tuple[tuple[Piece, ...], list[Distortion], list[Fault]]:
    """Pieces under old ids or new ones, old ones first; their distortion; what is wrong."""
    ids = _ids(skin, [(flat.piece.faces, same) if flat.UV is not None else None for flat, same in laid])
    place = {piece.id: k for k, piece in enumerate(skin.pieces)}
    areas = [round(float(skin.mesh.face_areas[flat.piece.faces].sum()), 6) for flat, _ in laid]
    order = sorted(range(len(laid)), key=lambda k: (place.get(ids[k], len(place)), -areas[k]))
    pieces, distortions, faults = [], [], []
    for k in order:
        flat, same = laid[k]
        if flat.UV is not None and flat.distortion is not None:
            p = flat.piece
            pieces.append(same if same is not None else Piece(ids[k], p.faces, p.vertices, p.F, flat.UV, p.topology))
            distortions.append(flat.distortion)
        if flat.fault:
            count = len(flat.piece.faces)
            who = ids[k] or (f"a part of {count} triangles" if len(laid) > 1 else "the object")
            faults.append(Fault(f"{who} {flat.fault}", flat.piece.faces, ids[k]))
    return tuple(pieces), distortions, faults


def _ids(skin: Skin, parts: list[tuple[IntArray, Piece | None] | None]) -> list[str]:
    """An id for each part ("" for those that are None): its own, that of the old piece it has most of, or a new one."""
    mesh = skin.mesh
    ids = [part[1].id if part is not None and part[1] is not None else "" for part in parts]
    owner = np.full(len(mesh.F), len(skin.pieces))
    for k, piece in enumerate(skin.pieces):
        owner[piece.faces] = k
    claims = []
    for k, part in enumerate(parts):
        if part is not None and not ids[k]:
            shares = np.bincount(owner[part[0]], mesh.face_areas[part[0]], len(skin.pieces) + 1)[:-1]
            claims += [(-float(share), k, skin.pieces[j].id) for j, share in enumerate(shares) if share > 0]
    # The largest claim first; every id goes to one part.
    for _, k, id in sorted(claims):
        if not ids[k] and id not in ids:
            ids[k] = id
    used = {id.lower() for id in ids}
    areas = [0.0 if part is None else float(mesh.face_areas[part[0]].sum()) for part in parts]
    number = 0
    for k in sorted(range(len(parts)), key=lambda k: (-round(areas[k], 6), k)):
        if parts[k] is not None and not ids[k]:
            while f"p{number + 1}" in used:
                number += 1
            ids[k] = f"P{number + 1}"
            used.add(ids[k].lower())
    return ids
