"""The figure: it is one, and it changes with what was found."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from calibration.contact.detector import Detection, detect
from calibration.contact.figure import Panel, draw_contacts
from calibration.contact.simulator import simulate


@pytest.mark.parametrize("suffix", [".png", ".pdf"])
def test_it_is_written(suffix: str, tmp_path: Path) -> None:
    trials = [simulate(name) for name in ("cube", "grip", "cup", "cylinder")]
    panels = [Panel(each.recording.stream.name, each.recording, detect(each.recording), each.truth) for each in trials]
    draw_contacts(panels, tmp_path / f"a{suffix}")
    draw_contacts(panels[:3], tmp_path / f"b{suffix}")
    assert (tmp_path / f"a{suffix}").stat().st_size > 10_000
    if suffix == ".png":
        assert (imread(tmp_path / "a.png") == imread(tmp_path / "b.png")).all()  # the fourth does not fit


def test_contacts_are_seen(tmp_path: Path) -> None:
    trial = simulate("cube")
    found = detect(trial.recording)
    draw_contacts([Panel("cube", trial.recording, found)], tmp_path / "with.png")
    none = Detection((), found.channels, found.alarm, found.false_alarms)
    draw_contacts([Panel("cube", trial.recording, none)], tmp_path / "without.png")
    coloured = [(imread(tmp_path / f"{name}.png")[..., :3].std(axis=2) > 0.1).mean() for name in ("with", "without")]
    assert coloured[0] > coloured[1] + 0.02


def test_where_nothing_is_watched_is_hatched(tmp_path: Path) -> None:
    log = simulate("grip").recording
    found = detect(log)
    late = replace(found, channels=tuple(replace(each, ready=30.0) for each in found.channels))
    for name, each in (("soon", found), ("late", late)):
        draw_contacts([Panel("grip", log, replace(each, contacts=()))], tmp_path / f"{name}.png")
    hatched = [(np.abs(imread(tmp_path / f"{name}.png")[..., :3] - 0xEE / 255).max(axis=2) < 0.01).mean() for name in ("soon", "late")]
    assert 0 < 4 * hatched[0] < hatched[1]


def test_no_line_goes_across_a_hole(tmp_path: Path) -> None:
    log = simulate("grip").recording
    moved = replace(log, device_time=np.where(np.arange(len(log)) < 4000, log.device_time, log.device_time + 60))
    draw_contacts([Panel("grip", moved, detect(moved))], tmp_path / "hole.png")
    picture = imread(tmp_path / "hole.png")[..., :3]
    # In the middle of the hole, between the frames of the axes, nothing is black.
    left, right = (np.flatnonzero((picture.max(axis=2) < 0.2).mean(axis=0) > 0.5)[[0, -1]]).tolist()
    at = left + round((right - left) * 70 / float(moved.device_time[-1]))
    top, bottom = np.flatnonzero((picture.max(axis=2) < 0.2).mean(axis=1) > 0.5)[[0, -1]].tolist()
    assert picture[top + 4 : bottom - 4, at - 2 : at + 3].min() > 0.3
