"""Pictures that take one another's place on a canvas."""

import tkinter as tk

import numpy as np
import pytest

import gui.view3d.plate as module
from gui.view3d.plate import Plate


def picture(rows: int, columns: int, seed: int) -> np.ndarray:
    """Noise, whose fourth byte is to be passed over."""
    return np.random.default_rng(seed).integers(0, 255, (rows, columns, 4), dtype=np.uint8)


def read(photo: tk.PhotoImage, x: int, y: int) -> list[int]:
    return list(photo.get(x, y))


@pytest.mark.parametrize("times", [1, 2])
def test_it_shows_what_it_was_given_last(root, times, monkeypatch):
    parts, put = [], module.put
    monkeypatch.setattr(module, "put", lambda photo, pixels, **part: (parts.append(part), put(photo, pixels, **part)))
    plate, one = Plate(root, times=times), picture(20, 30, 1)
    photo = plate.show(one)
    assert (photo.width(), photo.height()) == (30 * times, 20 * times)
    two = one.copy()
    two[5:8, 11:20, :3] ^= 255
    assert plate.show(two) is photo and plate.show(two) is photo
    for x, y in ((0, 0), (11, 5), (19, 7), (20, 7), (29, 19)):
        for corner in (0, times - 1):
            assert read(photo, times * x + corner, times * y + corner) == two[y, x, :3].tolist()
    assert parts[1:] == [{"rows": (5, 8), "columns": (11, 20)}, {"rows": (0, 0), "columns": (0, 0)}], "only what differs"
    two[:] = 0  # the next picture is made in the same place
    plate.show(two)
    assert read(photo, 0, 0) == [0, 0, 0]
    larger = plate.show(picture(21, 30, 2))
    assert larger.height() == 21 * times
