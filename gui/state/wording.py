"""The library's sentences are the command line's too: here its options become the window's own words."""

from __future__ import annotations

import re

#: What the command line says, and the window in its place; the first that fits is used at each place.
WORDING: tuple[tuple[str, str], ...] = (
    (r"--thickness ([\d.e+-]+): ", r"a skin \1 mm thick: "),
    (r"give --thickness ([\d.e+-]+) or less", r"give \1 mm or less"),
    (
        r"or leave it to skinfab make, which rounds it off by itself",
        "or the thickness that the material pours, with which it is rounded off by itself",
    ),
    (r"check --units and --thickness, or scale the object up with --scale", "open it again in another unit, or give less"),
    (r"check --units and --scale", "open it again in another unit"),
    (r"run again with --repair: ", "open it again and tick Repair: "),
    (r"--repair: ", "repair would: "),
    (r"use --repair", "open it again and tick Repair"),
    (r"--repair closes", "Repair, when it is opened, closes"),
    (r", or leave --wrap out", ", or do not skin the outside alone"),
    (r"--wrap ([\d.e+-]+): ", r"the outside alone, by a ball of \1 mm: "),
    (r"--wrap: ", "the outside alone: "),
    (r"use --method auto", "use Seams > Flatten by > auto"),
    (r"use --cones 8 or --cones auto", "give 8, or 0 for as many as pay"),
    (r"raise --max-distortion", "raise the bound on mean d"),
)


def in_window(sentence: str) -> str:
    """A sentence of the library in words that mean something before a window.

    Examples
    --------
    >>> in_window("1 edge is open; --repair closes small holes")
    '1 edge is open; Repair, when it is opened, closes small holes'
    """
    for said, shown in WORDING:
        sentence = re.sub(said, shown, sentence)
    return sentence
