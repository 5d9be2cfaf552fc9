"""Touches at known places: a crooked sensor is straightened on places it has not seen, and a straight one left alone."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinfab.errors import InputError, RefusedError
from skinfab.fingertip.force.contact import Hemisphere, locate
from skinfab.fingertip.force.contact_mesh import TipMesh
from skinfab.fingertip.force.motion_simulator import grasp_log
from skinfab.fingertip.force.tare import tared
from skinfab.fingertip.force.touch_model import Trained, learn_touches, load_touches, named, read_places, save_touches
from skinfab.fingertip.force.touch_simulator import TouchScene, defects, read_crooked, simulate_touches
from skinfab.fingertip.force.wrench import SensorNoise
from skinfab.fingertip.saved import save_model
from skinfab.mesh.model import Mesh

DOME = Hemisphere()
MADE = [{"file": "a.csv", "simulated": True}]


@pytest.fixture(scope="module")
def trained() -> Trained:
    return learn_touches(*simulate_touches(10, seed=3), DOME)


def test_a_crooked_sensor_finds_places_that_it_was_not_taught(trained: Trained) -> None:
    assert trained.before_mm > 1.0 > 0.75 > trained.after_mm and trained.helps
    other, true = simulate_touches(30, seed=3)  # the same sensor, other marks
    late = [tared(log, seconds=0.5) for log in other]
    for log, bound, model in ((late, 0.8, trained.model), (late, None, None)):
        off = []
        for each in log:
            used = model.corrected(each) if model else each
            found = locate(used.force[400:], used.moment[400:])
            off.append(np.median(np.linalg.norm(found.point - true[each.name], axis=1)))
        assert np.median(off) < bound if bound else np.median(off) > 1.0


def test_a_grasp_can_be_read_by_the_sensor_that_was_touched(trained: Trained) -> None:
    straight, _ = grasp_log(seed=3, episodes=1)
    crooked = tared(read_crooked(straight, seed=3), seconds=0.9)
    mended = trained.model.corrected(crooked)
    as_read, learned = (locate(log.force, log.moment, noise=trained.model.noise) for log in (crooked, mended))
    assert as_read.twisted.sum() > 20 > 5 > learned.twisted.sum()


def test_what_is_stated_of_a_point_holds_the_matrixs_own_error() -> None:
    inside, by_noise = [], []
    for seed in range(6):
        model = learn_touches(*simulate_touches(10, seed=seed), DOME).model
        exact = TouchScene(place_mm=0.0)
        logs, places = simulate_touches(25, seed=seed, scene=exact)
        for log in logs:
            used = model.corrected(tared(log, seconds=0.5))
            found = locate(used.force[600:], used.moment[600:], noise=model.noise)  # at about 3 N, where noise is little
            off = np.linalg.norm(found.point - places[log.name], axis=1)
            part = replace(used, time=used.time[600:], force=used.force[600:], moment=used.moment[600:])
            by_noise.append((off < 2 * found.sd_mm).mean())
            inside.append((off < 2 * np.hypot(found.sd_mm, model.own_error(part, DOME))).mean())
    assert np.mean(by_noise) < 0.9 < 0.93 < np.mean(inside)


def test_without_noise_and_with_exact_marks_it_is_the_sensors_own_inverse() -> None:
    scene = TouchScene(place_mm=0.0, noise=SensorNoise(1e-5, 1e-4), crosstalk=0.01, turn_deg=1.0)
    trained = learn_touches(*simulate_touches(10, seed=5, scene=scene), DOME)
    assert trained.after_mm < 0.05 < 10 * trained.after_mm < trained.before_mm
    # All but the common scale, which no touch tells.
    straight = trained.model.matrix @ defects(scene, np.random.default_rng(5))
    scale = np.array([1.0] * 3 + [20.0] * 3)
    straight = straight / np.outer(scale, 1 / scale) / np.trace(straight) * 6
    assert np.abs(straight[3:] - np.eye(6)[3:]).max() < 0.02


def test_a_straight_sensor_is_left_alone() -> None:
    straight = TouchScene(mount_mm=0.0, turn_deg=0.0, crosstalk=0.0)
    trained = learn_touches(*simulate_touches(8, seed=1, scene=straight), DOME)
    assert not trained.helps and np.array_equal(trained.model.matrix, np.eye(6))
    assert trained.model.noise.force_n == pytest.approx(0.02, rel=0.1) and trained.model.noise.moment_nmm == pytest.approx(0.2, rel=0.1)


def test_another_fingertip_is_refused(trained: Trained) -> None:
    trained.model.require_surface(Hemisphere(20.0))
    with pytest.raises(InputError, match="a dome of 20 mm, and this one is a dome of 18 mm"):
        trained.model.require_surface(Hemisphere(18.0))
    V = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0], [0, 0, 15.0]])
    pyramid = TipMesh(Mesh(V, np.array([[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]), "pyramid"))
    assert named(pyramid) == "a mesh of 6 triangles, 18.00 x 18.00 x 15.00 mm"
    logs, places = simulate_touches(6, seed=1)
    with pytest.raises(InputError, match=r"touch-1.csv lies \d.*off a mesh of 6"):
        learn_touches(logs, places, pyramid)


def test_touches_that_cannot_be_learned_from() -> None:
    logs, places = simulate_touches(8, seed=2)
    with pytest.raises(InputError, match=r"no row for touch-1\.csv"):
        learn_touches(logs, {}, DOME)
    with pytest.raises(InputError, match="fewer than 6 different places"):
        learn_touches(logs[:5], places, DOME)
    with pytest.raises(InputError, match=r"touch-1.csv lies 20\.0 mm off"):
        learn_touches(logs, places | {"touch-1.csv": np.zeros(3)}, DOME)
    weak = replace(logs[0], force=0.01 * logs[0].force, moment=0.01 * logs[0].moment)
    with pytest.raises(InputError, match=r"nothing pushes with 0\.3 N"):
        learn_touches([weak, *logs[1:]], places, DOME)
    turned = [replace(log, force=-log.force) for log in logs]
    with pytest.raises(RefusedError, match="is the force's sign"):
        learn_touches(turned, places, DOME)
    shuffled = dict(zip(places, list(places.values())[::-1], strict=True))
    with pytest.raises(RefusedError, match="one does not belong to the other"):
        learn_touches(logs, shuffled, DOME)


def test_a_table_of_places(tmp_path: Path) -> None:
    table = tmp_path / "p.csv"
    table.write_text("log;x_mm;y_mm;z_mm\na.csv;0;0;20\n")
    assert read_places(table)["a.csv"].tolist() == [0, 0, 20]
    for text, says in (("log,x\na,1\n", "is no table of places"), ("log,x_mm,y_mm,z_mm\na,1,2,\n", "row 1: 'a' has no place")):
        table.write_text(text)
        with pytest.raises(InputError, match=says):
            read_places(table)


def test_a_model_comes_back_as_it_was_and_others_are_refused(trained: Trained, tmp_path: Path) -> None:
    save_touches(trained, tmp_path / "a.npz", made_from=MADE)
    back, simulated = load_touches(tmp_path / "a.npz")
    assert simulated and back.surface == "a dome of 20 mm" and back.noise == trained.model.noise
    np.testing.assert_array_equal(back.matrix, trained.model.matrix)
    np.testing.assert_array_equal(back.spread, trained.model.spread)
    save_model(tmp_path / "b.npz", kind="force contact", facts={}, arrays={"matrix": np.eye(6), "spread": np.eye(36), "noise": np.ones(2)})
    with pytest.raises(InputError, match="missing or wrong"):
        load_touches(tmp_path / "b.npz")
    facts = {"surface": "a dome of 20 mm", "simulated": False}
    save_model(
        tmp_path / "c.npz", kind="force contact", facts=facts, arrays={"matrix": -np.eye(6)[:5], "spread": np.eye(36), "noise": np.ones(2)}
    )
    with pytest.raises(InputError, match="its matrix is none"):
        load_touches(tmp_path / "c.npz")
    save_model(tmp_path / "d.npz", kind="force hand", facts={}, arrays={})
    with pytest.raises(InputError, match="another kind"):
        load_touches(tmp_path / "d.npz")
