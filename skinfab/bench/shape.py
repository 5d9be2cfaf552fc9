"""Features and confidence against how often a new object's shape is told right; reconstruction errors beside the paper's.

Each set learns from 15 grasps of each of six objects and is asked about three objects that are none of these, turned at will.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from skinfab.bench.flatten import REPEATS, read_csv, write_csv
from skinfab.bench.timing import one_processor, timed_twice
from skinfab.fingertip.confusion import Confusion, grouped_accuracy
from skinfab.fingertip.force.grasp import (
    CUBOID,
    LEARNED,
    NEW,
    OVER,
    PAPER,
    ROUND,
    SHAPES,
    STRANGE,
    HandScene,
    Solid,
    simulate_grasp,
    total_wrench,
    touches,
)
from skinfab.fingertip.force.gravity import centre_of_gravity, published_centre
from skinfab.fingertip.force.reconstruct import published, reconstruct
from skinfab.fingertip.force.shape import (
    CONFIDENCE,
    FEATURES,
    MOST_GRASPS,
    Decision,
    ShapeModel,
    decide,
    features_of,
    fit_shapes,
    is_strange,
    misfit_limits,
)
from skinfab.fingertip.force.shape_figure import View, draw_solids
from skinfab.fingertip.force.shape_study import Examples, HeldOut, examples, judged
from skinfab.progress import Progress, silent

SEEDS = (0, 1, 2, 3, 4, 5)
GRASPS, ASKED = 15, 20
CONFIDENCES = (0.0, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99)
#: How far objects are turned about the vertical, deg: at will, and as little as on a bench.
YAWS = (180.0, 20.0, 5.0)
#: Grasps that are reconstructed, of each solid, and what the paper found (text of 6.2), mm.
SOLVED = 60
PAPER_SIZES = {"sphere": (44.5,), "cylinder": (25.0,), "cuboid": (50.0, 73.0, 88.0)}


@dataclass(frozen=True)
class Row:
    """One kind of features at one confidence.

    Parameters
    ----------
    features : str
    yaw_deg : float, deg
        Objects are turned by up to this.
    confidence : float
        Less is not answered, nor what fits none of the shapes; 0: all are answered.
    answered : float
        Part of the grasps.
    right, low, high : float
        Part of those, with its 95 % interval (objects of sets drawn anew); NaN of none.
    ms_per_grasp : float
        Least processor time of features and network.
    """

    features: str
    yaw_deg: float
    confidence: float
    answered: float
    right: float
    low: float
    high: float
    ms_per_grasp: float


@dataclass(frozen=True)
class Sizes:
    """How well one way reconstructs one solid.

    Parameters
    ----------
    solid, way : str
    side : int
        Of a cuboid, the shortest first.
    true_mm, paper_mm : float, mm
    median_mm, error_median_mm, error_p90_mm : float, mm
        Found; how far off.
    unknown : float
        Part of the grasps in which no finger touched the sides that tell it.
    """

    solid: str
    way: str
    side: int
    true_mm: float
    paper_mm: float
    median_mm: float
    error_median_mm: float
    error_p90_mm: float
    unknown: float


def run(folder: Path, *, repeats: int = REPEATS, progress: Progress = silent) -> dict[str, Any]:
    """Measure, and write shape*.csv, shape.png, shape_confusion_*.png, shape_solids.png and shape.txt into `folder`.

    Returns
    -------
    dict
        "sentence", "notes" (what to know of the measurement), "rows", "sizes", "regrasp" and "strange".
    """
    from skinfab.bench.force_ablation import hands_without
    from skinfab.bench.shape_chart import draw
    from skinfab.files import atomic_write

    notes = [f"simulated: {len(SEEDS)} sets; the paper, on a real hand: 27 of 30 right, its objects' turns not told"]
    with one_processor() as alone:
        notes += [] if alone else ["this system cannot keep a process on one processor"]
        rows, held = measure(repeats=repeats, progress=lambda done, what: progress(0.6 * done, what))
    again = regrasps(progress=lambda done, what: progress(0.6 + 0.1 * done, what))
    sizes = reconstructions(progress=lambda done, what: progress(0.7 + 0.1 * done, what))
    without = hands_without(progress=lambda done, what: progress(0.8 + 0.2 * done, what))
    tables = (
        ("shape", rows),
        ("shape_regrasp", again),
        ("shape_sizes", sizes),
        ("shape_ablation", without),
        ("shape_strange", strangers()),
    )
    for name, content in tables:
        write_csv(content, folder / f"{name}.csv")
    table, regrasped, solved = (read_csv(folder / f"{name}.csv") for name in ("shape", "shape_regrasp", "shape_sizes"))
    for name, of in held.items():
        of.draw(folder / f"shape_confusion_{name}.png", title=f"new objects, {name}", simulated=True)
    draw_solids(example_views(), folder / "shape_solids.png")
    said = sentence(table, regrasped, solved)
    atomic_write(folder / "shape.txt", "\n".join([said, *notes]) + "\n")
    draw(table, solved, folder / "shape.png")
    strange = read_csv(folder / "shape_strange.csv")
    return {"sentence": said, "notes": notes, "rows": table, "regrasp": regrasped, "sizes": solved, "strange": strange}


def grasped(solids: Sequence[Solid], count: int, *, seed: int, scene: HandScene) -> Examples:
    """So many grasps of each."""
    rng = np.random.default_rng(seed)
    return examples([simulate_grasp(solid, seed=rng, number=k, scene=scene) for k, solid in enumerate(solids) for _ in range(count)])


def measure(
    *, seeds: Sequence[int] = SEEDS, asked: int = ASKED, yaws: Sequence[float] = YAWS, repeats: int = REPEATS, progress: Progress = silent
) -> tuple[list[Row], dict[str, Confusion]]:
    """A row for every kind of features, turn and confidence; and what was taken for what at free turns."""
    rows, confusions = [], {}
    for j, yaw in enumerate(yaws):
        scene = HandScene(yaw_deg=yaw, tilt_deg=min(yaw, HandScene.tilt_deg))
        sets = []
        for k, seed in enumerate(seeds):
            progress((j + k / len(seeds)) / len(yaws), f"turned by up to {yaw:g} degrees, set {k + 1} of {len(seeds)}")
            sets.append((grasped(LEARNED, GRASPS, seed=seed, scene=scene), grasped(NEW, asked, seed=1000 + seed, scene=scene)))
        for features in FEATURES:
            out = []
            for k, (learned, new) in enumerate(sets):
                network = fit_shapes(features_of(learned.found, features), learned.shape, features, seed=k)
                limits = misfit_limits(features_of(learned.found, "misfits"), learned.shape)
                out.append(judged(network, new, features, limits=limits))
            held = HeldOut(
                *(np.concatenate([getattr(each, name) for each in out]) for name in ("probability", "shape", "object", "strange"))
            )
            if yaw == yaws[0]:
                confusions[features] = held.confusion
            sure, right = held.probability.max(axis=1), held.probability.argmax(axis=1) == held.shape
            group = np.array([(k, o) for k, each in enumerate(out) for o in each.object])
            work = partial(judged, network, sets[-1][1], features)
            cost = 1e3 * min(timed_twice(work)[1] for _ in range(repeats)) / len(sets[-1][1].found)
            for least in CONFIDENCES:
                on = (sure >= least) & ~(held.strange & (least > 0))
                rate = grouped_accuracy(right[on], [tuple(each) for each in group[on].tolist()])
                rows.append(Row(features, yaw, least, float(on.mean()), rate.value, rate.low, rate.high, cost))
    return rows, confusions


@dataclass(frozen=True)
class Strange:
    """What is said of grasps that are of no shape that was learned, beside those that are: parts that are answered.

    Parameters
    ----------
    what : str
        ``new objects``, ``mixed up`` (fingers' turns of another grasp), or a solid that is none of the three.
    grasps : int
    confident : float
        By the confidence of 0.9 alone.
    any_shape : float
        And where the best of the three shapes fits as well as it fits 99 % of those learned from.
    answered : float
        And where the shape that is said does too, see `skinfab.fingertip.force.shape.misfit_limits`.
    """

    what: str
    grasps: int
    confident: float
    any_shape: float
    answered: float


def strangers(*, seeds: Sequence[int] = SEEDS, asked: int = ASKED) -> list[Strange]:
    """A row for new objects, for grasps that are mixed up, and for each solid that is none of the three."""
    said: dict[str, list[tuple[bool, bool, bool]]] = {}
    for seed in seeds:
        learned = grasped(LEARNED, GRASPS, seed=seed, scene=HandScene())
        X = features_of(learned.found, "misfits")
        network, limits = fit_shapes(X, learned.shape, "misfits", seed=seed), misfit_limits(X, learned.shape)
        rng = np.random.default_rng(4000 + seed)
        new = [simulate_grasp(solid, seed=rng) for solid in NEW for _ in range(asked)]
        sets = {"new objects": new, "mixed up": [replace(a, turn=b.turn) for a, b in zip(new, new[::-1], strict=True)]}
        sets |= {solid.shape: [simulate_grasp(solid, seed=rng) for _ in range(asked)] for solid in STRANGE}
        for what, grasps in sets.items():
            found = [each for each in map(touches, grasps) if not each.fault]
            misfits = features_of(found, "misfits")
            probability = network.probability(misfits)
            sure, likely = probability.max(axis=1) >= CONFIDENCE, probability.argmax(axis=1)
            loose = np.append(np.full(len(SHAPES), np.inf), limits[-1])
            gates = (sure, *(sure & ~is_strange(misfits, likely, each) for each in (loose, limits)))
            said.setdefault(what, []).extend(zip(*(each.tolist() for each in gates), strict=True))
    return [Strange(what, len(each), *np.mean(each, axis=0).tolist()) for what, each in said.items()]


@dataclass(frozen=True)
class Regrasp:
    """What grasping again is worth: objects asked, right at the first grasp, and after as many as it took."""

    features: str
    objects: int
    right_first: float
    right: float
    sure: float
    sure_and_right: float
    grasps: float


def regrasps(*, seeds: Sequence[int] = SEEDS, objects: int = 20, progress: Progress = silent) -> list[Regrasp]:
    """A row for every kind of features: the confidence gate of 0.9, up to `MOST_GRASPS` grasps of each object."""
    scene = HandScene()
    said: dict[str, list[tuple[str, Decision, Decision]]] = {}
    for k, seed in enumerate(seeds):
        progress(k / len(seeds), f"grasping again, set {k + 1} of {len(seeds)}")
        learned = grasped(LEARNED, GRASPS, seed=seed, scene=scene)
        rng = np.random.default_rng(2000 + seed)
        asked = [(solid.shape, [simulate_grasp(solid, seed=rng) for _ in range(MOST_GRASPS)]) for solid in NEW for _ in range(objects // 3)]
        for features in FEATURES:
            limits = misfit_limits(features_of(learned.found, "misfits"), learned.shape).tolist()
            network = fit_shapes(features_of(learned.found, features), learned.shape, features, seed=k)
            model = ShapeModel(features, network, {"misfit_limits": limits})
            said.setdefault(features, []).extend((shape, decide(model, of[:1]), decide(model, of)) for shape, of in asked)
    rows = []
    for features, each in said.items():
        sure = [(shape == last.shape) for shape, _, last in each if last.sure]
        first, right = (float(np.mean([shape == of[k].shape for shape, *of in each])) for k in (0, 1))
        count = float(np.mean([last.grasps for *_, last in each]))
        rows.append(Regrasp(features, len(each), first, right, len(sure) / len(each), float(np.mean(sure)) if sure else math.nan, count))
    return rows


def reconstructions(*, grasps: int = SOLVED, progress: Progress = silent) -> list[Sizes]:
    """A row for every side of the paper's three solids, as published and by the fit, on the same grasps."""
    rows = []
    for j, solid in enumerate(PAPER):
        found: dict[str, list[list[float]]] = {"published": [], "fit": []}
        for k in range(grasps):
            progress((j + k / grasps) / len(PAPER), f"reconstructing a {solid.shape}")
            grasp = simulate_grasp(solid, seed=3000 + k, poses=10, fingers=OVER if solid.shape == CUBOID else ROUND)
            contacts, wrench = touches(grasp), total_wrench(grasp)
            found["published"].append(sorted(published(contacts, solid.shape, published_centre(*wrench).point).size))
            centre = centre_of_gravity(*wrench).point if solid.shape == CUBOID else None
            found["fit"].append(sorted(reconstruct(contacts, solid.shape, centre).size))
        true = solid.size if solid.shape == CUBOID else solid.size[:1]
        for way, sizes in found.items():
            for side, (wanted, paper) in enumerate(zip(true, PAPER_SIZES[solid.shape], strict=True)):
                # A side that is not known sorts nowhere: such grasps are counted apart.
                known = np.array([each[side] for each in sizes if not any(map(math.isnan, each))])
                off = np.abs(known - wanted)
                rows.append(
                    Sizes(
                        solid.name,
                        way,
                        side,
                        wanted,
                        paper,
                        float(np.median(known)),
                        float(np.median(off)),
                        float(np.quantile(off, 0.9)),
                        1 - len(known) / grasps,
                    )
                )
    return rows


def example_views() -> list[View]:
    """The paper's three solids, each in one simulated grasp, as its fig. 16; published above, the fit below."""
    views = []
    for way in (published, reconstruct):
        for solid in PAPER:
            grasp = simulate_grasp(solid, seed=3000, poses=10, fingers=OVER if solid.shape == CUBOID else ROUND)
            contacts, wrench = touches(grasp), total_wrench(grasp)
            centre = (published_centre if way is published else centre_of_gravity)(*wrench).point
            solved = way(contacts, solid.shape, centre)
            told = " x ".join(f"{x:.1f}" for x in sorted(solved.size))
            title = f"{'published' if way is published else 'fit'}: {solid.shape} {told} mm"
            views.append(View(title, contacts, solved, centre, True))
    return views


def sentence(table: Sequence[Mapping[str, Any]], regrasped: Sequence[Mapping[str, Any]], solved: Sequence[Mapping[str, Any]]) -> str:
    """What the features and the gate are worth: every number in it comes from the tables."""
    by = {(row["features"], row["yaw_deg"], row["confidence"]): row for row in table}
    raw, free, here = (by[name, YAWS[0], 0.0]["right"] for name in ("published", "pose-free", "misfits"))
    gated = by["misfits", YAWS[0], CONFIDENCE]
    again = next(row for row in regrasped if row["features"] == "misfits")
    cuboid = {
        way: [row["error_median_mm"] for row in solved if row["solid"].startswith(CUBOID) and row["way"] == way]
        for way in ("published", "fit")
    }
    off = {way: " / ".join(f"{x:.1f}" for x in sides) for way, sides in cuboid.items()}
    return (
        f"Shapes of new objects at any turn, simulated: the published 24 numbers tell {raw:.0%}, pose-free ones {free:.0%}, the misfits "
        f"of three fits {here:.0%}; of the {gated['answered']:.0%} that are surer than {CONFIDENCE:g} and fit {gated['right']:.1%} are "
        f"right, and grasping again ({again['grasps']:.1f} grasps an object) gives {again['right']:.1%}. A cuboid's sides are off by "
        f"{off['fit']} mm (median) by the fit, as published by {off['published']}."
    )
