"""The sensors of "Soft Sensing Skins for Arbitrary Objects" on our seven objects, and their resistances beside the paper's table II.

Run it to print the table of docs/resistance.md; a test makes it anew and compares. `sensors_toml` gives what
`skinfab place --sensors` places.
"""

from __future__ import annotations

import math
import statistics
import sys
from dataclasses import dataclass

from skinfab.electrical import resistance
from skinfab.material import load_material
from skinfab.patterns.base import Pattern
from skinfab.patterns.strain_lines import StrainLines
from skinfab.placement.auto import spiral_of_size


@dataclass(frozen=True)
class Cell:
    """A cell of table II: channel, outer diameter s in mm, resistance at rest in kohm, and whether it can be trusted as scanned."""

    channel: str
    s: float
    r0: float
    sure: bool = True


#: Table II as far as it can be read. S5 to S8 hold one object's values under all columns: they are the dodecahedron's, which alone
#: has eight sensors. Of the other columns S1 to S4 differ from each other, but S4 of cylinder and grip (Jamar) are one number.
TABLE_II = {
    "cup": [Cell("S1", 15, 545.4), Cell("S2", 45, 2833.2), Cell("S3", 45, 1194.1), Cell("S4", 20, 189.2)],
    "cylinder": [Cell("S1", 20, 28.9), Cell("S2", 45, 593.6), Cell("S3", 45, 1249.3), Cell("S4", 38, 342.3, sure=False)],
    "grip": [Cell("S1", 32, 20.2), Cell("S2", 38, 269.8), Cell("S3", 38, 384.0), Cell("S4", 38, 342.3, sure=False)],
    "cube": [Cell("S1", 15, 44.5), Cell("S2", 15, 434.4), Cell("S3", 15, 634.9), Cell("S4", 15, 653.2)],
    "dodecahedron": [Cell(f"S{k}", 22, r0) for k, r0 in enumerate((23.9, 159.5, 228.0, 109.0, 112.9, 88.7, 291.4, 109.6), start=1)],
}

#: The strain sensors, section II.B: l1, l2 and b in mm. Their resistances are in a figure only, which the scan does not have.
STRAIN = {"human_finger": (53.0, 43.0, 6.0), "robot_finger": (60.0, 54.0, 6.0)}


def patterns(name: str) -> list[Pattern]:
    """What the paper puts on this object; its contact sensors by their size, with the project's proportions."""
    material = load_material()
    if name in STRAIN:
        l1, l2, b = STRAIN[name]
        return [
            StrainLines(l1=l1, l2=l2, b=b, bead=material.ink.bead_width, gap=material.gap, pad=material.pad),
            spiral_of_size(10.0, material),
        ]
    return [spiral_of_size(cell.s, material) for cell in TABLE_II[name]]


def sensors_toml(name: str) -> str:
    """A file for `skinfab place --sensors`: all of them where they fit best."""
    from skinfab.patterns.registry import parameters

    rows = []
    for pattern in patterns(name):
        own = {key: value for key, value in parameters(pattern).items() if key not in ("bead", "gap", "pad")}
        params = ", ".join(f"{key} = {str(value).lower()}" for key, value in own.items())
        rows.append(f'[[sensor]]\nkind = "{pattern.kind}"\nparams = {{ {params} }}\npose = "auto"\n')
    return "\n".join(rows)


def table() -> str:
    """The table of docs/resistance.md, and the sentence below it."""
    ink = load_material().ink
    lines = [
        "| object | sensor | s, mm | line, mm | predicted R0, kΩ (nine in ten) | paper's R0, kΩ | paper / predicted | inside |",
        "|---|---|---|---|---|---|---|---|",
    ]
    logs, inside, sure = [], [], []
    for name, cells in TABLE_II.items():
        for cell, pattern in zip(cells, patterns(name), strict=True):
            length = pattern.path().length
            r = resistance(length, ink)
            logs.append(math.log(cell.r0 / r.median))
            inside.append(r.low <= cell.r0 <= r.high)
            sure.append(cell.sure)
            which = cell.channel if cell.sure else f"{cell.channel} (doubtful)"
            predicted = f"{r.median:.0f} ({r.low:.0f} to {r.high:.0f})"
            ratio, hit = cell.r0 / r.median, "yes" if inside[-1] else "no"
            lines.append(f"| {name} | {which} | {cell.s:g} | {length:.0f} | {predicted} | {cell.r0:g} | {ratio:.2f} | {hit} |")
    for name in STRAIN:
        for pattern in patterns(name):
            length = pattern.path().length
            r = resistance(length, ink)
            size = f"{pattern.s:g}" if hasattr(pattern, "s") else "strain"
            lines.append(f"| {name} | | {size} | {length:.0f} | {r.median:.0f} ({r.low:.0f} to {r.high:.0f}) | not given | | |")
    counted = [log for log, real in zip(logs, sure, strict=True) if real]
    hits = sum(each for each, real in zip(inside, sure, strict=True) if real)
    eight = logs[-8:]
    means = [math.exp(statistics.mean(each)) for each in (counted, eight)]
    spreads = [statistics.stdev(each) for each in (counted, eight)]
    words = (
        f"Of the {len(counted)} cells that are not doubtful {hits} lie inside their interval. The geometric mean of paper / predicted is "
        f"{means[0]:.2f}, the standard deviation of its logarithm {spreads[0]:.2f} "
        f"(dodecahedron alone: {means[1]:.2f} and {spreads[1]:.2f}; the profile says {ink.log_sigma:g})."
    )
    return "\n".join([*lines, "", words])


if __name__ == "__main__":
    sys.stdout.write(table() + "\n")
