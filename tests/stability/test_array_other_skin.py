"""An array that is learned as if its skin were another: what is learned looks whole, and what says that it is not."""

from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.judge import held_out, poor
from skinfab.fingertip.array.learn import learn
from skinfab.fingertip.array.logs import of_recording
from skinfab.fingertip.array.protocols import presses
from skinfab.fingertip.array.simulator import Device


def test_a_skin_of_half_a_millimetre_for_one_of_four() -> None:
    """It is better than that drawing by far, so that it is kept; and worse than the published way, which knows no skin."""
    logs = [of_recording(presses(Device(seed=3), 10, seed=k), name=str(k)) for k in (1, 2)]
    thin = Geometry(skin=0.5)
    errors = held_out(logs, thin)
    by = {(each.way, each.quantity): each.rms for each in errors}
    assert by["learned", "axial"] < 0.5 * by["drawn", "axial"]
    assert by["learned", "axial"] > by["published", "axial"]
    said = poor(errors, "learned")
    assert said[0].startswith("axial errs by ") and said[-1].startswith("force errs by ")
    learned = learn(logs, thin)
    assert any("0.90 mm is the most that is searched for" in note for note in learned.notes)
    good = Geometry()
    assert not poor(held_out(logs, good), "learned") and not learn(logs, good).notes
