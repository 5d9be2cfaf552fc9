"""The raster against exact distances."""

from collections.abc import Callable

import numpy as np
import shapely

from skinfab.placement.raster import Raster


def boundary(piece: object) -> np.ndarray:
    return piece.UV[piece.topology.E[piece.topology.is_boundary]]


def test_clearance_is_right_to_about_a_step(sheet: Callable) -> None:
    def hole(c: np.ndarray) -> np.ndarray:
        return (np.abs(c - [20, 30]) < 6).all(axis=1)

    _, piece = sheet(60, 60, without=hole, step=2)
    edges = boundary(piece)
    raster = Raster(edges, np.zeros((0, 2, 2)))
    walls = shapely.MultiLineString(list(edges))
    points = np.random.default_rng(0).uniform(0, 60, (500, 2))
    inside = ~hole(points)
    exact = np.where(inside, shapely.distance(shapely.points(points), walls), 0.0)
    assert np.abs(raster.clearance_at(points) - exact).max() < 1.6 * raster.step
    assert (raster.clearance_at(np.array([[-5.0, 3.0], [1e6, 0.0], [20.0, 30.0]])) == 0).all()


def test_a_closed_slit_is_a_wall_and_creases_divide(sheet: Callable) -> None:
    _, piece = sheet(60, 60, slit=True)
    raster = Raster(boundary(piece), np.zeros((0, 2, 2)))
    assert raster.clearance_at(np.array([[30.0, 10.0]])) < raster.step and raster.clearance_at(np.array([[30.0, 45.0]])) > 14
    assert raster.regions()[0] == 1
    divided = Raster(boundary(piece), np.array([[[0.0, 30.0], [60.0, 30.0]]]))
    assert divided.regions()[0] == 3  # the slit parts the lower half
    divided.block_polygon(np.array([[0.0, 31], [60, 31], [60, 60], [0, 60]]))
    assert divided.clearance_at(np.array([[30.0, 45.0]])) == 0


def test_large_pieces_get_coarser_cells(sheet: Callable) -> None:
    _, piece = sheet(400, 400, step=20)
    raster = Raster(boundary(piece), np.zeros((0, 2, 2)))
    assert raster.free.size < 400_000 and 0.5 < raster.step < 0.8


def test_blocking_later_is_as_blocking_at_once(sheet: Callable) -> None:
    _, piece = sheet(90, 60)
    edges = boundary(piece)
    polygons = [
        np.array([[10.0, 10], [30, 12], [20, 33]]),
        np.array([[70.0, 5], [85, 5], [85, 50], [60, 40]]),
        np.array([[40.0, 40], [41, 70], [30, 50]]),
    ]
    later, at_once = Raster(edges, np.zeros((0, 2, 2))), Raster(edges, np.zeros((0, 2, 2)))
    twin = later.copy()
    untouched = later.clearance.copy()
    for polygon in polygons:
        assert later.clearance.max() > 0  # known before, so that it is brought up to date
        later.block_polygon(polygon)
        at_once.block_polygon(polygon)
    np.testing.assert_array_equal(later.free, at_once.free)
    np.testing.assert_allclose(later.clearance, at_once.clearance, atol=1e-12)
    np.testing.assert_array_equal(twin.clearance, untouched)


def test_clearance_round_a_shape_is_the_least_at_its_points(sheet: Callable) -> None:
    _, piece = sheet(60, 60, without=lambda c: (np.abs(c - [20, 30]) < 6).all(axis=1), step=2)
    raster = Raster(boundary(piece), np.zeros((0, 2, 2)))
    rng = np.random.default_rng(3)
    row, column = np.nonzero(raster.free)
    some = rng.choice(len(row), 400, replace=False)
    cells = row[some], column[some]
    shapes = rng.uniform(-15, 15, (5, 40, 2))
    slow = raster.clearance_at(raster.centres_of(cells)[None, :, None] + shapes[:, None]).min(axis=2)
    np.testing.assert_allclose(raster.clearance_round(cells, shapes, least=-1.0), slow, atol=1e-12)
    given_up = raster.clearance_round(cells, shapes, least=2.0)
    assert ((given_up == slow) | ((slow <= given_up) & (given_up <= 2.0))).all() and (slow > 2.0).any()
