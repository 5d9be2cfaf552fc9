"""Pixels in a picture of Tk's."""

import tkinter as tk

import numpy as np

from gui.pixels import put


def test_a_part_of_a_picture_whatever_its_fourth_byte(root):
    photo = tk.PhotoImage(width=7, height=5, master=root)
    pixels = np.random.default_rng(0).integers(0, 255, (5, 7, 4), dtype=np.uint8)
    pixels[..., 3] = 0
    put(photo, pixels)
    assert [[list(photo.get(x, y)) for x in range(7)] for y in range(5)] == pixels[..., :3].tolist()
    after = np.zeros_like(pixels)
    put(photo, after, rows=(1, 3), columns=(2, 6))
    expected = pixels[..., :3].copy()
    expected[1:3, 2:6] = 0
    assert [[list(photo.get(x, y)) for x in range(7)] for y in range(5)] == expected.tolist()
    put(photo, pixels, rows=(2, 2), columns=(0, 7))
    assert list(photo.get(3, 2)) == [0, 0, 0]
