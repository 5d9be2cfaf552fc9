"""How many trials of a log are right that the model did not learn from."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinfab.cli.nail_errors import mean_errors

if TYPE_CHECKING:
    from skinfab.fingertip.nail.labels import Label
    from skinfab.fingertip.nail.live import Told
    from skinfab.fingertip.nail.pace import Pace
    from skinfab.fingertip.nail.reader import Decision
    from skinfab.readout.logs.log import Log


def judged(path: Path, log: Log, told: Sequence[Told], samples: int, content: Any, pace: Pace) -> tuple[dict[str, Any], list[str]]:
    """How many of the trials are right by what most of the windows in each say, and what is to be said of the table.

    Raises
    ------
    InputError
        The table cannot be read, or has no row of this log.
    """
    import numpy as np

    from skinfab.fingertip.confusion import grouped_accuracy
    from skinfab.fingertip.nail.touches import touches_of

    fresh, facts, notes = _fresh(path, log, content, pace)
    labels = [each for each, _ in fresh]
    unknown = sorted({each.label for each in labels} - set(content.model.names))
    if unknown:
        of = sum(each.label in unknown for each in labels)
        notes.append(f"the model knows no {', '.join(unknown)}: {of} of the {len(fresh)} trials can never be right")
    published = hasattr(content.model, "samples")
    right, groups, off = [], [], []
    for (each, values), name in zip(fresh, touches_of(labels)[0], strict=True):
        if published:
            said = _by_histograms(content.model, values)
        else:
            # Of the last reading: half a reading to spare, so that a window that just fits does.
            first, last = each.start_s + (samples - 1.5) / pace.rate_hz, each.end_s - 0.5 / pace.rate_hz
            inside = [one.decision for one in told if one.decision and first <= one.time_s <= last]
            said = Counter(one.label for one in inside).most_common(1)[0][0] if inside else None
            off.append(_off(inside, each))
        if said is not None:
            right.append(said == each.label)
            groups.append(name)
    if without := len(fresh) - len(right):
        what = f"{without} of the {len(fresh)} trials have no" if right else "no trial has"
        need, do = (
            (f"{samples} readings of all six channels, which the published method needs", "record longer ones")
            if published
            else (f"{'' if right else 'a '}window of {samples} readings that could be decided", "see --window")
        )
        notes.append(f"{what} {need}, and {'count' if right else 'counts'} nowhere; {do}")
    rate = grouped_accuracy(np.array(right), groups) if right else None
    accuracy = {"value": rate.value, "low": rate.low, "high": rate.high} if rate else {"value": None, "low": None, "high": None}
    counts = {"file": path.name, "trials": len(right), "right": sum(right), **facts, "accuracy": accuracy}
    return {"labels": {**counts, **mean_errors(np.array(off).reshape(-1, 3))}}, notes


def _by_histograms(model: Any, values: Any) -> str | None:
    """What the published method says of a trial, by windows that begin with it."""
    from skinfab.fingertip.nail.held_out import by_histograms
    from skinfab.fingertip.nail.train import whole

    return str(model.names[by_histograms(model, values)]) if len(whole(values)) >= model.samples else None


def _off(inside: Sequence[Decision], label: Label) -> tuple[float, float, float]:
    """How far the contacts among a trial's decisions are off what was aimed at, in the mean: degrees, mm, part of the force."""
    import numpy as np

    from skinfab.fingertip.nail.regress import off_by, target_of, targets_of

    of = targets_of([label])[0]
    each = np.array([off_by(target_of(one.continuous), of) for one in inside if one.contact]).reshape(-1, 3)
    angle, place, force = (float(column.mean()) if len(column) else float("nan") for column in each.T)
    return angle, place, force


def participants_of(content: Any) -> list[str]:
    """Whose finger was learned, as far as somebody said."""
    return [str(each) for each in content.made_from.get("participants") or [] if each]


def _fresh(path: Path, log: Log, content: Any, pace: Pace) -> tuple[list[tuple[Label, Any]], dict[str, int], list[str]]:
    """The rows of this log that the model did not learn from, with their readings, how many there are of others, and what is to be said."""
    from skinfab.errors import InputError
    from skinfab.fingertip.nail.doubles import without_doubles
    from skinfab.fingertip.nail.labels import evenly, read_labels, rows_of, to_the_end
    from skinfab.fingertip.nail.prints import known

    own = [each for each in read_labels(path)[0] if each.log == log.file]
    if not own:
        raise InputError(f"{path} has no row of {log.file}; give the table that goes with the log")
    time, values, _ = evenly(log.recording, pace)
    own = [to_the_end(each, time, pace.rate_hz) for each in own]
    rows, notes = without_doubles(own, [each.log for each in own], path)
    own = [own[k] for k in rows]
    at = [rows_of(each, time, pace) for each in own]
    if beyond := sum(each is None for each in at):
        notes.append(
            f"{beyond} of the {len(own)} rows of {path.name} end after the log does, at {time[-1]:.3f} s, and count nowhere; is it whole?"
        )
    learned, kept = content.made_from.get("learned"), content.made_from.get("readings")
    spans = (learned or {}).get(log.sha256, [])
    if learned is None and kept is None:
        notes.append("the model does not say which trials it learned from; where they are among these, more is right than of new ones")
    fresh = [
        (each, values[of])
        for each, of in zip(own, at, strict=True)
        if of is not None
        and not any(each.start_s < end and start < each.end_s for start, end in spans)
        and not known(values[of], kept or [])
    ]
    strangers = {each.participant for each in own if each.participant} - set(whose := participants_of(content))
    if strangers and whose:
        notes.append(
            f"the trials are of {', '.join(sorted(strangers))} and the model learned from {', '.join(whose)}: fingers differ, and "
            "another's is often told wrong; train a model for each person"
        )
    if left_out := len(own) - beyond - len(fresh):
        notes.append(f"the model learned from {left_out} of the {len(own)} trials, which are not counted")
    return fresh, {"learned_from": left_out, "beyond": beyond}, notes
