"""Warnings that follow from the figures: right piece, right place, right sense; none where all is well."""

import dataclasses

import numpy as np
import pytest

from skinfab.flatten.distortion import Distortion, measure
from skinfab.report.cautions import cautions, worst_place
from skinfab.skin import Skin


def strained(id: str, factor: float, worst: float) -> dict[str, object]:
    return {"id": id, "wrap_strain": {"max": worst, "resistance_factor": factor}}


def scaled(skin: Skin, factor: tuple[float, float], *, id: str = "P1") -> tuple[Skin, Distortion]:
    """The wall with its flat shape scaled, so that every strain is known."""
    piece = dataclasses.replace(skin.pieces[0], id=id, UV=skin.pieces[0].UV * factor)
    return dataclasses.replace(skin, pieces=(piece,), sensors=()), measure(piece.V(skin.mesh), piece.F, piece.UV)


def test_a_good_skin_is_not_warned_of(skin: Skin, distortions: list[Distortion]) -> None:
    assert cautions(skin, distortions, [strained("C1", 1.1, -0.0999)]) == []


@pytest.mark.parametrize(
    ("factor", "strain", "says"), [((4.0, 1.0), -0.75, "squeezed by about 75 %"), ((1.0, 0.25), 3.0, "stretched by about 300 %")]
)
def test_strain_at_the_worst_place(factor: tuple[float, float], strain: float, says: str, skin: Skin) -> None:
    skin, d = scaled(skin, factor)
    place, found = worst_place(skin, skin.pieces[0], d)
    assert found == pytest.approx(strain, rel=1e-9)
    np.testing.assert_allclose(place, skin.mesh.V[skin.mesh.F[np.argmax(d.d)]].mean(axis=0))
    (warning,) = cautions(skin, [d], [])
    x, y, z = place
    assert warning.startswith("piece P1: ") and says in warning and f"P1 up to {d.max:.1f} at ({x:.1f}, {y:.1f}, {z:.1f}) mm" in warning
    assert f"over {d.p99:.2f} on one hundredth of the area" in warning


def test_one_bad_triangle_is_found_and_named_by_its_place(skin: Skin, distortions: list[Distortion]) -> None:
    d = np.full(len(skin.mesh.F), 4.0)
    d[77] = 10.5
    one = dataclasses.replace(distortions[0], d=d, max=10.5)
    (warning,) = cautions(skin, [one], [])
    x, y, z = skin.mesh.V[skin.mesh.F[77]].mean(axis=0)
    assert f"({x:.1f}, {y:.1f}, {z:.1f}) mm" in warning and "hundredth" not in warning and "sound" in warning
    d[77] = 10.0  # the bound itself is allowed
    assert cautions(skin, [dataclasses.replace(one, max=10.0)], []) == []


def test_many_pieces_make_one_sentence_worst_first(skin: Skin) -> None:
    each = [scaled(skin, (1.0 / k, 1.0), id=f"P{k}") for k in range(1, 9)]
    many = dataclasses.replace(skin, pieces=tuple(one.pieces[0] for one, _ in each), sensors=())
    (warning,) = cautions(many, [d for _, d in each], [])
    assert warning.startswith("pieces P8, P7, P6, P5, P4, P3, P2: ")
    assert warning.count("up to") == 4 and "the other 3 less" in warning


def test_sensors_by_name_with_what_it_does_to_their_resistance(skin: Skin, distortions: list[Distortion]) -> None:
    (warning,) = cautions(skin, distortions, [strained("C1", 1.0, 0.02), strained("C6", 0.94, -0.2), strained("S1", 1.21, 0.5)])
    assert warning.startswith("sensors S1, C6: ") and "C1" not in warning and "(1 + e)^2" in warning
    assert "S1 is stretched by 50 % in one place (times 2.25 there, times 1.21 over its whole length)" in warning
    assert "C6 is squeezed by 20 % in one place (times 0.64 there, times 0.94 over its whole length)" in warning
    (alone,) = cautions(skin, distortions, [strained("C6", 0.94, -0.2)])
    assert alone.startswith("sensor C6: ")
