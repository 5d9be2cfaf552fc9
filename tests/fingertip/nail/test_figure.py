"""The picture of a run: drawn for every kind of decision, and labelled as simulated where it is."""

import math
from pathlib import Path

import matplotlib.figure
import pytest

from skinfab.fingertip.nail.figure import draw_run
from skinfab.fingertip.nail.live import Told
from skinfab.fingertip.nail.reader import Decision
from skinfab.fingertip.nail.regress import Continuous


def test_all_kinds_of_decisions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    titles: list[str] = []
    before = matplotlib.figure.Figure.suptitle
    monkeypatch.setattr(matplotlib.figure.Figure, "suptitle", lambda self, text, **how: titles.append(text) or before(self, text, **how))
    told = [
        Told(0.0, Decision("none", 1.0, False, False, Continuous()), 169.0, 0.0),
        Told(0.1, Decision("edge", 0.8, True, True, Continuous(90.0, 1.0, 2.0, math.nan)), 169.0, 0.0),
        Told(0.2, None, 169.0, 1.0),
        Told(0.3, Decision("edge", math.nan, True, False, Continuous()), math.nan, 0.0),
    ]
    draw_run(told, ["none", "edge"], tmp_path / "n.png", title="a log", simulated=True)
    draw_run(told[:1], ["none", "edge"], tmp_path / "m.png", title="a log", simulated=False)
    assert titles == ["a log (simulated)", "a log"]
    assert all(path.read_bytes()[:4] == b"\x89PNG" for path in tmp_path.iterdir())


@pytest.mark.parametrize(
    ("found", "panels"),
    [
        (Continuous(90.0, 1.0, 2.0, math.nan), ["confidence", "direction, deg", "foot or pin, mm"]),
        (Continuous(math.nan, 1.0, 2.0, 0.5, "low"), ["confidence", "foot or pin, mm", "force, N"]),
        (Continuous(), ["confidence"]),
        (None, []),
    ],
    ids=["edges", "pins with forces", "classes alone", "published"],
)
def test_what_is_not_known_has_no_panel(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, found: Continuous | None, panels: list[str]
) -> None:
    drawn: list[str] = []

    def looked_at(self: matplotlib.figure.Figure, path: Path) -> None:
        drawn.extend(axes.get_ylabel() for axes in self.axes)
        path.write_bytes(b"PNG")

    monkeypatch.setattr(matplotlib.figure.Figure, "savefig", looked_at)
    decision = Decision("pin", 0.9 if found else math.nan, True, False, found or Continuous())
    draw_run([Told(0.1 * k, decision, 169.0, 0.0) for k in range(3)], ["none", "pin"], tmp_path / "n.png", title="a", simulated=True)
    assert drawn == ["", *panels]
