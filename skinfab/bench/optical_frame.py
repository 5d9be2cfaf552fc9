"""Ways to read an edge from a frame of the optical fingertip: processor time against errors of offset, depth and angle (simulated).

All that learn do so from the same images of one fingertip and are judged on others. The published way finds a good feature or
none, and is judged where it finds one; it merges pins, and so has the seed's fingertip of 271, on the same edges.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.timing import one_processor
from skinfab.fingertip.optical.edge import Edge
from skinfab.fingertip.optical.judge import off_by
from skinfab.fingertip.optical.labelled import FOLLOWED_MM, labelled
from skinfab.fingertip.optical.pins import Image, Tracked
from skinfab.fingertip.optical.published import feature
from skinfab.fingertip.optical.regress import Examples, learn
from skinfab.fingertip.optical.simulator import Fingertip, paper_fingertip
from skinfab.progress import Progress, silent

FloatArray = NDArray[np.float64]
Read = Callable[[Image], Edge | None]
#: Images that are learned from, judged on and timed; edges lie within so many mm of the middle.
COUNTS, JUDGED, TIMED, REACH_MM = (100, 300, 1000), 300, 60, 5.0
PUBLISHED, LINEAR, WHOLE, DEFAULT = "published moments", "pins, ridge", "image, kernel ridge", "pins, kernel ridge"
#: The seed's frame, on a core of 3 GHz, ms.
SEED_MS = (16.0, 30.0)
#: Ridge of the linear way in parts of the pins' mean square (best of 0.001 to 0.3 on other images); pixels a side of the shrunken image.
_RIDGE, _SMALL = 0.3, 40


@dataclass(frozen=True)
class Row:
    """One way that learned from so many images.

    Parameters
    ----------
    method : str
    learned : int
    offset_mm, depth_mm, angle_deg : float
        Mean absolute errors; NaN where the way does not tell.
    told : float
        Part of the images of which it says anything.
    ms : float
        Least processor time a frame.
    judged : int
    simulated : bool
    """

    method: str
    learned: int
    offset_mm: float
    depth_mm: float
    angle_deg: float
    told: float
    ms: float
    judged: int
    simulated: bool = True


def frame(folder: Path, *, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write optical_frame.csv, .png and .txt into `folder`, which is there.

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement) and "rows".
    """
    from skinfab.bench.optical_frame_chart import draw
    from skinfab.files import atomic_write

    kinds = (f"{len(tip.rest)} pins and {tip.dome.size_px} px" for tip in (Fingertip(), paper_fingertip()))
    notes = [
        f"simulated fingertips: one of {', the published moments on one of '.join(kinds)}, which they need: of 127 they merge all at rest",
        f"edges within {REACH_MM:g} mm, pressed {FOLLOWED_MM[0]:g} to {FOLLOWED_MM[1]:g} mm deep",
    ]
    with one_processor() as alone:
        notes += [] if alone else ["this system cannot keep a process on one processor"]
        write_csv(measure(repeats=repeats, progress=progress), folder / "optical_frame.csv")
    # From here on only what the table holds is used, so that chart and sentence cannot say anything else.
    table = read_csv(folder / "optical_frame.csv")
    words = sentence(table)
    atomic_write(folder / "optical_frame.txt", "\n".join([words, *notes]) + "\n")
    draw(table, folder / "optical_frame.png")
    return {"sentence": words, "notes": notes, "rows": table}


def measure(*, counts: Sequence[int] = COUNTS, judged: int = JUDGED, repeats: int = REPEATS, progress: Progress = silent) -> list[Row]:
    """A row for every way and number of images."""
    tip = Fingertip()
    seen = [(one.image, one.edge) for one in labelled(tip, max(counts), reach_mm=REACH_MM, depths_mm=FOLLOWED_MM, seed=1)]
    other, dense = (
        [(one.image, one.edge) for one in labelled(each, judged, reach_mm=REACH_MM, depths_mm=FOLLOWED_MM, seed=2)]
        for each in (tip, paper_fingertip())
    )
    every = Examples.of([image for image, _ in seen], [edge for _, edge in seen], rest=tip.image(tip.rest))
    small = Examples(every.pins, np.array([shrunken(image) for image, _ in seen]), np.zeros((len(seen), 1), dtype=bool), every.truth)
    ways: list[tuple[str, int, Read, Sequence[tuple[Image, Edge]]]] = [(PUBLISHED, 0, as_published, dense)]
    for j, count in enumerate(counts):
        progress(j / len(counts), f"{count} images")
        some = np.arange(count)
        for name, read in ((LINEAR, linear(every[some])), (WHOLE, whole(small[some])), (DEFAULT, learn(every[some]).edge)):
            ways.append((name, count, read, other))
    rows = [judge(name, count, read, judged_on) for name, count, read, judged_on in ways]
    times = least_ms([(read, judged_on) for _, _, read, judged_on in ways], repeats)
    return [replace(row, ms=ms) for row, ms in zip(rows, times, strict=True)]


def least_ms(ways: Sequence[tuple[Read, Sequence[tuple[Image, Edge]]]], repeats: int) -> list[float]:
    """Processor time a frame of each way, the least of each frame's: in turns, so that what else the machine does hits all alike."""
    taken = np.empty((repeats, len(ways), min(TIMED, *(len(images) for _, images in ways))))
    for j in range(repeats):
        for k, (read, images) in enumerate(ways):
            for i, (image, _) in enumerate(images[: taken.shape[2]]):
                began = time.process_time()
                read(image)
                taken[j, k, i] = time.process_time() - began
    return [float(ms) for ms in 1000 * taken.min(axis=0).mean(axis=1)]


def as_published(image: Image) -> Edge | None:
    """A good feature's direction, and its middle as a point of the edge."""
    found = feature(image)
    if found is None or not found.good:
        return None
    x, y = found.centroid
    off = -(x * math.cos(found.angle_rad) + y * math.sin(found.angle_rad)) / paper_fingertip().dome.px_per_mm
    return Edge(off, found.angle_rad)


def linear(examples: Examples) -> Callable[[Image], Edge]:
    """Ridge regression on the pins' movements."""
    mean, centre = examples.moved.mean(axis=0), examples.truth.mean(axis=0)
    X = examples.moved - mean
    W = np.linalg.solve(X.T @ X + _RIDGE * (X**2).sum() / X.shape[1] * np.eye(X.shape[1]), X.T @ (examples.truth - centre))

    def read(image: Image) -> Edge:
        said = (examples.pins.track(image).moved.ravel() - mean) @ W + centre
        return Edge(float(said[0]), math.atan2(said[2], said[1]), float(said[3]))

    return read


def shrunken(image: Image) -> FloatArray:
    """A blurred, small image as features, grey."""
    soft = cv2.GaussianBlur(image, (0, 0), image.shape[0] / _SMALL / 2)
    return cv2.resize(soft, (_SMALL, _SMALL), interpolation=cv2.INTER_AREA).ravel().astype(float)


def whole(examples: Examples) -> Callable[[Image], Edge]:
    """Kernel ridge regression on the image itself."""
    model = learn(examples)
    none = np.zeros(1, dtype=bool)
    return lambda image: model.edge_of(Tracked(shrunken(image), none, 0))


def judge(name: str, learned: int, read: Read, other: Sequence[tuple[Image, Edge]]) -> Row:
    """Errors on other images; how long a frame takes is measured later."""
    said = [read(image) for image, _ in other]
    pairs = [(edge, truth) for edge, (_, truth) in zip(said, other, strict=True) if edge is not None]
    if pairs:
        truth = np.array([[t.offset_mm, math.cos(t.angle_rad), math.sin(t.angle_rad), t.depth_mm] for _, t in pairs])
        offset, depth, angle = (float(each) for each in np.abs(off_by([edge for edge, _ in pairs], truth)).mean(axis=0))
    else:
        offset = depth = angle = math.nan
    return Row(name, learned, offset, depth, angle, len(pairs) / len(other), math.nan, len(other))


def sentence(table: Sequence[Mapping[str, Any]]) -> str:
    """Published beside improved: every number in it comes from the table."""
    most = max(row["learned"] for row in table)
    old = next(row for row in table if row["method"] == PUBLISHED)
    new, plain = (next(r for r in table if r["method"] == name and r["learned"] == most) for name in (DEFAULT, LINEAR))
    image = next(r for r in table if r["method"] == WHOLE and r["learned"] == most)
    return (
        f"On a simulated fingertip the published moments find a good feature in {100 * old['told']:.0f} % of the frames, "
        f"{old['angle_deg']:.1f} degrees and {old['offset_mm']:.2f} mm off on average, in {old['ms']:.2f} ms (the seed: {SEED_MS[0]:g} to "
        f"{SEED_MS[1]:g} ms on a core of 3 GHz); {new['method']} after {most} images reads all, {new['angle_deg']:.1f} degrees and "
        f"{new['offset_mm']:.2f} mm off, in {new['ms']:.2f} ms; ridge alone is {plain['offset_mm']:.2f} mm off in {plain['ms']:.2f} ms, "
        f"{image['method']} {image['offset_mm']:.2f} mm in {image['ms']:.2f} ms. "
        "Pins are the default because on real images the image is twice as far off."
    )
