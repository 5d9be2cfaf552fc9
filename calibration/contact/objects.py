"""The five objects of "Soft Sensing Skins for Arbitrary Objects", Table II: their contact sensors at rest and touched.

Only the dodecahedron's column is whole in the text at hand; of the others the rows S1 to S4 are taken as they stand, and S5 and
S6 of the cube from cells that are printed under all objects. Cells of S6 under contact are lost for both: there
stands None, and the simulator takes the median of the object's other sensors.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skinfab.errors import InputError


@dataclass(frozen=True)
class Pad:
    """A contact sensor in Table II.

    Parameters
    ----------
    r0 : float, kohm
        At rest.
    touched : float or None, kohm
        Mean at stable contact.
    scatter : float or None, kohm
        Its standard deviation over five trials.
    """

    r0: float
    touched: float | None
    scatter: float | None


_TABLE: dict[str, tuple[tuple[float, float | None, float | None], ...]] = {
    "cube": (
        (44.5, 72.7, 4.6),
        (434.4, 365.4, 65.6),
        (634.9, 1202.5, 140.0),
        (653.2, 927.0, 145.1),
        (503.0, 990.9, 182.0),
        (19.2, None, None),
    ),
    "cylinder": ((28.9, 31.9, 5.1), (593.6, 723.5, 48.4), (1249.3, 1375.9, 99.5), (342.3, 373.7, 8.3)),
    "dodecahedron": (
        (23.9, 46.6, 1.6),
        (159.5, 207.9, 29.9),
        (228.0, 292.5, 14.9),
        (109.0, 126.6, 2.9),
        (112.9, 132.6, 6.4),
        (88.7, None, None),
        (291.4, 466.5, 91.9),
        (109.6, 124.6, 7.7),
    ),
    "grip": ((20.2, 28.6, 2.9), (269.8, 318.6, 13.6), (384.0, 454.1, 27.4), (342.3, 373.7, 8.3)),
    "cup": ((545.4, 1137.2, 110.3), (2833.2, 3330.9, 138.0), (1194.1, 1356.5, 31.5), (189.2, 197.3, 4.4)),
}

#: By name, in the order of the paper's pictures.
OBJECTS: dict[str, tuple[Pad, ...]] = {name: tuple(Pad(*cells) for cells in rows) for name, rows in _TABLE.items()}


def pads(name: str) -> tuple[Pad, ...]:
    """The sensors of an object, with the lost cells filled in.

    Raises
    ------
    InputError
        There is no such object; those that there are are named.

    Examples
    --------
    >>> falling = pads("cube")[1]
    >>> round(100 * (falling.touched / falling.r0 - 1), 1)
    -15.9
    """
    if name not in OBJECTS:
        raise InputError(f"there is no object {name!r}; there are {', '.join(OBJECTS)}")
    known = [(pad.touched / pad.r0 - 1, pad.scatter / pad.r0) for pad in OBJECTS[name] if pad.touched and pad.scatter]
    change, scatter = np.median(known, axis=0)
    return tuple(pad if pad.touched else Pad(pad.r0, pad.r0 * (1 + float(change)), pad.r0 * float(scatter)) for pad in OBJECTS[name])
