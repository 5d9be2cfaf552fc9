"""The figure: a curve that can be seen to fit, labelled with its units, simulated logs called so."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from calibration.strain.calibrate import calibrate
from calibration.strain.figure import draw_calibration
from calibration.strain.models import Samples
from calibration.strain.prepare import prepare
from skinfab.readout.table import Table


@pytest.mark.parametrize(("suffix", "begins"), [(".png", b"\x89PNG"), (".pdf", b"%PDF")])
def test_it_is_written_and_is_the_same_again(suffix: str, begins: bytes, log: Callable[..., Samples], tmp_path: Path) -> None:
    run = log(width=4.0, noise=0.002)
    made = prepare(Table("a.csv", "", run.time, {"U": 1 + run.signal, "a": run.angle}, {}), signal="U", angle="a", limits=(10, 80))
    found = calibrate(made)
    for simulated, name in ((False, "one"), (False, "two"), (True, "three")):
        draw_calibration(made, found, tmp_path / (name + suffix), title="$a_b", names=("U", "a"), simulated=simulated)
    one, two, three = ((tmp_path / (name + suffix)).read_bytes() for name in ("one", "two", "three"))
    assert one.startswith(begins) and one != three
    if suffix == ".png":
        assert one == two
        from matplotlib.image import imread

        colours = np.rint(255 * imread(tmp_path / "one.png").reshape(-1, 4)[:, :3])
        for branch in ((0, 114, 178), (230, 159, 0)):
            assert (colours == branch).all(axis=1).any()
