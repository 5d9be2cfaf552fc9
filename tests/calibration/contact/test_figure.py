"""The figure: it is one, and it changes with what was found."""

from pathlib import Path

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
