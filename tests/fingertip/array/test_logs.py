"""Simulated logs, what is read of them, what is learned from them, and what a watch says frame by frame."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.array.analyser import Analyser
from skinfab.fingertip.array.geometry import Geometry
from skinfab.fingertip.array.judge import held_out
from skinfab.fingertip.array.learn import learn, load_array, save_array
from skinfab.fingertip.array.logs import ArrayLog, of_recording, read_array_log
from skinfab.fingertip.array.matched import ArrayModel
from skinfab.fingertip.array.protocols import presses, rods, twirl
from skinfab.fingertip.array.simulator import Device, Rubber, Skin, contact_line, deflection
from skinfab.fingertip.array.watch import ArrayWatch, read_all
from skinfab.readout.frame import Recording
from skinfab.readout.logs.log import write_log

DEVICE = Device(seed=3)
SEED = DEVICE.geometry


@pytest.fixture(scope="module")
def logs() -> list[ArrayLog]:
    return [replace(of_recording(presses(DEVICE, 30, seed=k), name=f"presses {k}"), name=f"presses {k}") for k in range(3)]


def test_voltages_become_the_deflections_again() -> None:
    recording = presses(DEVICE, 4)
    log = of_recording(recording, name="a")
    k = log.touched()[0]
    axial, angle, force = (log.truth[name][k] for name in ("axial_mm", "angle_deg", "force_n"))
    true = DEVICE.skin.pressed(force, axial_mm=axial, angle_rad=math.radians(angle))
    assert np.abs(log.Z[k] - true).max() < 6 * DEVICE.errors.noise
    assert log.noise == pytest.approx(DEVICE.errors.noise, rel=0.15) and recording.stream.simulated and log.simulated
    np.testing.assert_allclose(log.rest_v, DEVICE.rest_v, rtol=1e-3)


@pytest.mark.parametrize("name", ["a.csv", "a.mcap", "a.frames"])
def test_logs_of_any_kind(name: str, tmp_path: Path) -> None:
    made = presses(DEVICE, 3)
    write_log(made, tmp_path / name)
    read = read_array_log(tmp_path / name)
    np.testing.assert_allclose(read.Z, of_recording(made, name="a").Z, atol=1e-5)
    assert read.simulated and len(read.touched()) == 9


def test_a_voltage_is_a_deflection() -> None:
    Z = np.array([[-0.1, 0.0, 0.3]])
    np.testing.assert_allclose(deflection(1.02 / (1 - Z), np.full((1, 3), 1.02)), Z, atol=1e-12)
    assert np.isnan(deflection(np.array([[0.0, np.nan]]), np.ones((1, 2)))).all()
    with pytest.raises(InputError, match="r0s1 reads 0 V at rest"):
        deflection(np.ones((1, 2)), np.array([[1.0, 0.0]]))


def test_rods_grow_longer_when_turned() -> None:
    lengths = [contact_line(2.0, math.radians(a), 12.7) for a in range(0, 91, 10)]
    assert lengths == sorted(lengths) and contact_line(1.0, 0.0, 12.7) < lengths[0] and contact_line(0.0, 1.0, 12.7) == 0
    assert {name for name in rods(DEVICE, 2).stream.names if not name.startswith("r")} == {"axial_mm", "angle_deg", "force_n", "line_deg"}


def test_what_is_learned_is_the_array(logs: list[ArrayLog]) -> None:
    model = learn(logs, SEED).model
    assert model.geometry.skin == pytest.approx(3.8, abs=0.05) and model.geometry.core_radius == pytest.approx(SEED.core_radius)
    assert model.rubber.young == pytest.approx(0.4, rel=0.03) and model.rubber.poisson > 0.45
    assert np.std(model.gains / DEVICE.skin.gains) < 0.6 * np.std(DEVICE.skin.gains)


def test_another_skin_is_learned_too() -> None:
    """One that is thicker than drawn and whose tactels read stress: what the array as drawn would get wrong."""
    true = Device(Geometry(skin=4.5, finger_radius=13.4), Rubber(young=0.8, poisson=0.0), seed=1)
    made = [of_recording(presses(true, 25, seed=k), name=str(k)) for k in range(2)]
    model = learn(made, SEED).model
    assert (model.geometry.skin, model.rubber.young) == pytest.approx((4.5, 0.8), rel=0.05) and model.rubber.poisson < 0.1
    by = {(each.way, each.quantity): each.rms for each in held_out(made, SEED)}
    assert by["learned", "axial"] < 0.5 * by["drawn", "axial"] and by["learned", "force"] < 0.2 * by["drawn", "force"]


def test_held_out_errors_are_told_with_intervals(logs: list[ArrayLog]) -> None:
    lines = replace(of_recording(rods(DEVICE, 6), name="rods"), name="rods")
    errors = held_out([*logs, lines], SEED)
    by = {(each.way, each.quantity): each for each in errors}
    assert len(by) == len(errors) == 11
    for each in errors:
        assert 0 < each.low <= each.rms * (1 + 1e-9) and each.high >= each.rms * (1 - 1e-9) and each.worst >= each.rms
    assert by["learned", "axial"].rms < 0.3 * by["published", "axial"].rms and by["learned", "axial"].frames == 270
    assert by["learned", "line"].rms < 0.5 * by["published", "line"].rms


def test_labels_of_another_log_are_refused(logs: list[ArrayLog]) -> None:
    wrong = [replace(log, truth=log.truth | {"axial_mm": log.truth["axial_mm"][::-1] * 0 + 3.0}) for log in logs]
    with pytest.raises(RefusedError, match=r"those of this array|more than half a tactel"):
        learn(wrong, SEED)


def test_what_cannot_be_learned_from(logs: list[ArrayLog]) -> None:
    with pytest.raises(InputError, match="not of 8 x 16"):
        learn(logs, Geometry.of_density("8x16"))
    few = [replace(logs[0], truth={name: values[:40] for name, values in logs[0].truth.items()})]
    with pytest.raises(InputError, match="hold 7 presses on points; give at least 8"):  # of three frames each
        learn(few, SEED)
    with pytest.raises(InputError, match="has no column force_n"):
        replace(logs[0], truth={"axial_mm": logs[0].truth["axial_mm"], "angle_deg": logs[0].truth["angle_deg"]}).touched()


def moved(logs: list[ArrayLog], **by: float) -> list[ArrayLog]:
    """The logs with labels that are shifted, or scaled (`force_n`)."""
    how = {name: (lambda v, b=value, n=name: v * b if n == "force_n" else v + b) for name, value in by.items()}
    return [replace(log, truth=log.truth | {name: change(log.truth[name]) for name, change in how.items()}) for log in logs]


def test_few_presses_make_it_no_worse() -> None:
    """Twelve presses of three frames a log: gains that count frames as presses doubled the error of the drawing."""
    few = [of_recording(presses(Device(seed=4), 12, seed=4000 + k), name=str(k)) for k in (1, 2)]
    by = {(each.way, each.quantity): each.rms for each in held_out(few, SEED)}
    for quantity in ("axial", "angle", "force"):
        assert by["learned", quantity] < 1.05 * by["drawn", quantity]


@pytest.mark.parametrize("shift", [{"axial_mm": 1.5}, {"angle_deg": 15.0}, {"axial_mm": -1.0, "angle_deg": -8.0}])
def test_labels_that_are_shifted_are_shifted_back(logs: list[ArrayLog], shift: dict[str, float]) -> None:
    made, straight = learn(moved(logs, **shift), SEED), learn(logs, SEED)
    assert made.shift == pytest.approx((shift.get("axial_mm", 0), math.radians(shift.get("angle_deg", 0))), abs=0.05) and made.notes
    assert straight.shift == (0, 0) and straight.notes == ()
    assert (made.model.geometry.skin, made.model.rubber.young) == pytest.approx((3.8, 0.4), rel=0.05)
    assert np.abs(made.model.gains / straight.model.gains - 1).max() < 0.05


def test_labels_a_tactel_off_or_in_grams(logs: list[ArrayLog]) -> None:
    for shift in ({"axial_mm": 3.7}, {"angle_deg": -45.0}):
        with pytest.raises(RefusedError, match="more than half a tactel"):
            learn(moved(logs, **shift), SEED)
    (note,) = learn(moved(logs, force_n=102.0), SEED).notes
    assert "no soft rubber's" in note and "in newtons" in note


def test_where_learning_does_not_pay() -> None:
    """An array that is as drawn: nothing is left to learn but noise, and that is not learned."""
    exact = Device(seed=6).without(gain_scatter=0.0)
    made = [of_recording(presses(exact, 12, seed=k), name=str(k)) for k in range(2)]
    learned = learn(made, SEED)
    assert np.std(learned.model.gains) < 0.01 and learned.drawn.rubber.young == pytest.approx(0.4, rel=0.02)
    by = {(each.way, each.quantity): each.rms for each in held_out(made, SEED)}
    assert by["learned", "axial"] < 1.1 * by["drawn", "axial"]


def test_one_log_cannot_be_judged(logs: list[ArrayLog]) -> None:
    with pytest.raises(InputError, match="there is 1 log of presses; give two or more"):
        held_out(logs[:1], SEED)


@pytest.mark.parametrize("gains", [np.zeros((8, 8)), -np.ones((8, 8))], ids=["zero", "negative"])
def test_gains_that_are_none(gains: np.ndarray, tmp_path: Path) -> None:
    save_array(tmp_path / "m.npz", ArrayModel(SEED, Rubber(), gains), {})
    with pytest.raises(InputError, match="are no array"):
        load_array(tmp_path / "m.npz")


def test_a_modulus_that_is_no_number(tmp_path: Path) -> None:
    save_array(tmp_path / "m.npz", ArrayModel(SEED, Rubber(young="x"), np.ones((8, 8))), {})  # type: ignore[arg-type]
    with pytest.raises(InputError, match="not a whole model"):
        load_array(tmp_path / "m.npz")


def test_a_model_is_kept(tmp_path: Path) -> None:
    model = ArrayModel(Geometry(skin=4.0), Rubber(0.5, 0.3), DEVICE.skin.gains)
    save_array(tmp_path / "m.npz", model, {"simulated": True})
    read, facts = load_array(tmp_path / "m.npz")
    assert (read.geometry, read.rubber, facts) == (model.geometry, model.rubber, {"simulated": True})
    np.testing.assert_array_equal(read.gains, model.gains)


def test_a_damaged_model_is_told(tmp_path: Path) -> None:
    save_array(tmp_path / "m.npz", ArrayModel(SEED, Rubber(), np.ones((4, 4))), {})
    with pytest.raises(InputError, match="are no array"):
        load_array(tmp_path / "m.npz")
    from skinfab.fingertip.saved import save_model

    save_model(tmp_path / "n.npz", kind="tactel array", facts={}, arrays={"gains": np.ones((8, 8))})
    with pytest.raises(InputError, match="not a whole model"):
        load_array(tmp_path / "n.npz")


def test_states_of_a_frame() -> None:
    read, skin = Analyser(ArrayModel.nominal(SEED), noise=2e-4), Skin(SEED)
    rest = read.frame(0.0, np.zeros(SEED.shape))
    assert rest.state == "none" and rest.line is None and rest.place.force_n == 0
    cases = {
        "point": skin.pressed(0.5, axial_mm=13.0, angle_rad=0.3),
        "line": skin.lined(2.0, axial_mm=13.0, angle_rad=0.3, line_rad=1.0),
        "several": skin.points([(0.5, 0, 0)] * 2, [(5.0, 0.3), (16.1, 0.3)]),
        "edge": skin.pressed(0.5, axial_mm=-1.0, angle_rad=0.3),
        "past": skin.pressed(2.0, axial_mm=-3.5, angle_rad=0.3),
        "wide": skin.plated(3.0, axial_mm=13.0, angle_rad=0.3, size_mm=16),
    }
    assert {name: read.frame(1.0, Z).state for name, Z in cases.items()} == {name: name for name in cases}


def test_frame_by_frame_is_the_whole_log() -> None:
    recording, truth = twirl(DEVICE, seed=1)
    readings, watch = read_all(recording, ArrayModel.nominal(SEED))
    found = [event for reading in readings for event in reading.events]
    assert [event.kind for event in found] == [event.kind for event in truth]
    assert len(readings) == len(recording) - 6 and watch.noise == pytest.approx(2e-4, rel=0.3)
    k = next(k for k, reading in enumerate(readings) if reading.state == "line")
    log = of_recording(recording, name="t")
    assert readings[k].place.axial_mm == pytest.approx(log.truth["axial_mm"][k + 6], abs=0.5)


def test_what_a_watch_refuses() -> None:
    recording = presses(DEVICE, 3)
    with pytest.raises(InputError, match="8 x 8 tactels, and the model"):
        ArrayWatch(recording.stream, ArrayModel.nominal(Geometry.of_density("8x16")))
    short = Recording.of_frames(recording.stream, list(recording)[:10])
    with pytest.raises(InputError, match="ends within its first 1 s"):
        read_all(short, ArrayModel.nominal(SEED))
    long = presses(DEVICE, 8)
    touched = Recording.of_values(long.stream, long.values[14:], device_time=long.device_time[14:])
    with pytest.raises(InputError, match="leave the array untouched"):
        read_all(touched, ArrayModel.nominal(SEED))
