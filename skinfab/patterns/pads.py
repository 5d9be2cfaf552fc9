"""Contact pads: small filled squares that the stroke of the conductor begins and ends with.

The joint of wire and ink is the weakest point of these skins ("Soft Sensing Skins for Arbitrary
Objects", section IV): a pad gives the wire an area of ink to be pierced or sewn through.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import ArrayLike

from skinfab.paths import Line, Path


def pad_stroke(*, at: ArrayLike, side: float, bead: float, upward: bool) -> Path:
    """A filled square drawn by one stroke that starts at a lead's end and runs on in the lead's direction.

    The lead arrives in -x. The square of ink lies to the left of `at`; it grows away from the other lead,
    so that the two pads stay as far apart as the leads are.

    Parameters
    ----------
    at : (2,) float, mm
        End of the lead.
    side : float, mm
        Side of the square of ink, two beads or more.
    bead : float, mm
        Width of the bead. The rows lie at most this far apart, so that they fill the square.
    upward : bool
        Whether the square lies at y >= at[1] or at y <= at[1] (centre lines).

    Returns
    -------
    Path
        Lines alternately along x and y, from `at` to a corner of the square.

    Examples
    --------
    >>> pad = pad_stroke(at=(0, 0), side=3.0, bead=1.0, upward=True)
    >>> pad.bbox.tolist(), pad.length
    ([[-2.0, 0.0], [0.0, 2.0]], 8.0)
    """
    x, y = np.asarray(at, dtype=float)
    reach = side - bead  # of the centre line
    gaps = max(math.ceil(reach / bead - 1e-9), 1)
    rows = [y + (1 if upward else -1) * reach * k / gaps for k in range(gaps + 1)]
    corners = [(x, y)]
    for k, row in enumerate(rows):
        far = (x - reach, x)[k % 2]
        corners += [(corners[-1][0], row), (far, row)]
    del corners[1]  # the first row starts at the lead itself
    return Path(tuple(Line(np.array(a), np.array(b)) for a, b in itertools.pairwise(corners)))
