"""The paper's sensors lie on the seven objects without anyone's help, and the guide's table of their resistances is what the code gives."""

from __future__ import annotations

import importlib.util
import math
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

from skinfab.cli.main import main
from skinfab.document import load_skin
from skinfab.material import load_material
from skinfab.placement.check import find_faults

ROOT = Path(__file__).resolve().parents[2]


def tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("seed_resistance", ROOT / "tools/seed_resistance.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


SEED = tool()


@pytest.mark.parametrize("name", [*SEED.TABLE_II, *SEED.STRAIN])
def test_the_papers_sensors_fit_on_our_object(name: str, cut_once: Callable[[str, Path], Path], tmp_path: Path) -> None:
    document, wanted = cut_once(name, tmp_path / "a.skin"), tmp_path / "sensors.toml"
    wanted.write_text(SEED.sensors_toml(name))
    assert main(["place", str(document), "--sensors", str(wanted)]) == 0
    skin = load_skin(document)
    assert [sensor.pattern for sensor in skin.sensors] == SEED.patterns(name)
    for sensor in skin.sensors:
        others = [other for other in skin.sensors_on(sensor.piece) if other is not sensor]
        assert find_faults(skin.piece(sensor.piece), sensor, others, material=load_material()) == []


def test_the_papers_own_sizes() -> None:
    robot, human = (SEED.patterns(name)[0] for name in ("robot_finger", "human_finger"))
    assert (robot.l1, robot.l2, robot.b) == (60, 54, 6) and (human.l1, human.l2, human.b) == (53, 43, 6)
    assert robot.path().length == pytest.approx(231.42, abs=0.005)
    spirals = [pattern for name in SEED.TABLE_II for pattern in SEED.patterns(name)]
    assert {spiral.s for spiral in spirals} == {15, 20, 22, 32, 38, 45}
    for spiral in spirals:  # the ranges of section II.B
        assert 3 <= spiral.n <= 6 and 1.7 <= spiral.x <= 3.2 and 1.5 <= spiral.b <= 8 and 3 <= spiral.l <= 8


def test_predictions_by_hand() -> None:
    # 63 ohm cm, 0.484 mm^2, twice 5 kohm; nine in ten of a log-normal of sigma 0.7.
    rows = [line for line in SEED.table().splitlines() if line.startswith("| robot_finger | | strain")]
    median = 0.63 * 231.42 / 0.484 + 10
    low, high = median / math.exp(1.645 * 0.7), median * math.exp(1.645 * 0.7)
    assert f"{median:.0f} ({low:.0f} to {high:.0f})" in rows[0]


def test_the_guide_has_the_table_as_it_is_made_today() -> None:
    guide = (ROOT / "docs/resistance.md").read_text(encoding="utf-8")
    assert SEED.table() in guide, "run tools/seed_resistance.py and put its table into docs/resistance.md"
