"""Labels, cross of axes, scale and bar lie within the canvas and mean what they say."""

import tkinter as tk

import numpy as np
import pytest

from gui.theme import DARK, LIGHT
from gui.view3d.camera import Camera
from gui.view3d.furniture import Furniture, round_length
from gui.view3d.labels import Label

BOX = np.array([[0.0, 0, 0], [90, 40, 30]])


@pytest.fixture
def canvas(root):
    canvas = tk.Canvas(root, width=500, height=400, highlightthickness=0)
    canvas.pack()
    root.update()
    return canvas


def texts(canvas, tag):
    return [canvas.itemcget(item, "text") for item in canvas.find_withtag(tag) if canvas.type(item) == "text"]


@pytest.mark.parametrize("most", [0.011, 0.7, 1.0, 4.9, 100.0, 12345.0])
def test_lengths_are_round(most):
    length = round_length(most)
    assert 0.4 * most < length <= most * (1 + 1e-9)
    assert f"{length:e}"[0] in "125" and float(f"{length:.0e}") == pytest.approx(length)


def test_the_scale_is_as_long_as_it_says(canvas):
    camera = Camera.fitted(BOX, 500, 400)
    Furniture(canvas, dpi=1.0).scale(camera, LIGHT)
    (line,) = (item for item in canvas.find_withtag("scale") if canvas.type(item) == "line")
    x = canvas.coords(line)[::2]
    assert (max(x) - min(x)) / camera.scale == pytest.approx(float(texts(canvas, "scale")[0].split()[0]))


def test_the_cross_shows_where_the_axes_point(canvas):
    furniture = Furniture(canvas, dpi=1.0)
    furniture.axes(Camera.fitted(BOX, 500, 400).seen_from("front"), LIGHT)
    place = {canvas.itemcget(item, "text"): canvas.coords(item) for item in canvas.find_withtag("axes") if canvas.type(item) == "text"}
    assert place["x"][0] > place["y"][0] and place["z"][1] < place["y"][1]


def test_labels_are_moved_inside_and_kept_apart(canvas):
    furniture = Furniture(canvas, dpi=1.0)
    words = [Label("P1", 2, 2, "piece"), Label("C1", 498, 200, "sensor"), Label("7", 100, 100, "seam"), Label("8", 101, 101, "seam")]
    furniture.labels(words, LIGHT)
    assert sorted(texts(canvas, "label")) == ["7", "C1", "P1"]
    for item in canvas.find_withtag("label"):
        left, top, right, bottom = canvas.bbox(item)
        assert left >= 0 and top >= 0 and right <= 500 and bottom <= 400
    furniture.labels(words[2:], DARK)
    assert texts(canvas, "label") == ["7"]
    assert canvas.itemcget(canvas.find_withtag("seam")[0], "fill") == DARK.seam
    furniture.labels([], DARK)
    assert not canvas.find_withtag("label")


def test_labels_beside_the_canvas_are_left_out(canvas):
    Furniture(canvas, dpi=1.0).labels([Label("P1", -50, 30, "piece"), Label("P2", 30, 900, "piece")], LIGHT)
    assert not canvas.find_withtag("label")


@pytest.mark.parametrize(("shading", "says"), [("distortion", "4.2"), ("checker", "5 mm"), ("preferences", "avoided"), ("pieces", None)])
def test_colours_are_explained(canvas, shading, says):
    Furniture(canvas, dpi=1.0).legend(shading, LIGHT)
    words = texts(canvas, "legend")
    assert any(says in word for word in words) if says else not words
    for item in canvas.find_withtag("legend"):
        assert canvas.bbox(item)[2] <= 500 and canvas.bbox(item)[0] >= 0
