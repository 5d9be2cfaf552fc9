"""What is drawn reaches the screen, however far apart it lies."""

import numpy as np

from gui.theme import rgb
from gui.view2d.surface import Surface


def test_what_moved_is_shown_in_all_its_places_and_where_it_was(root):
    root.geometry("500x400")
    places = [[(20.0, 20.0), (60.0, 20.0)], [(440.0, 380.0), (480.0, 380.0)]]
    surface = Surface(
        root,
        still=lambda pen: pen.box((0, 0, pen.width, pen.height), "#ffffff"),
        moving=lambda pen: [pen.line(np.array(ends) + shift, "#cc0000", 5.0) for ends in places],
    )
    shift = np.zeros(2)
    surface.widget.pack(fill="both", expand=True)
    root.update()

    def shown(x: float, y: float) -> tuple[int, ...]:
        return tuple(surface._tkphoto.tk.call(str(surface._tkphoto), "get", round(x), round(surface.size[1] - y)))

    def middles() -> list[tuple[float, float]]:
        return [tuple(np.mean(ends, axis=0) + shift) for ends in places]

    before = middles()
    assert {shown(*at) for at in before} == {rgb("#cc0000")}
    for step in ((0.0, -12.0), (-30.0, 9.0)):
        shift[:] = step
        surface.refresh()
        surface.refresh_now()  # as two events in a row do, the second before the first was all shown
        shift[0] -= 4.0
        surface.refresh_now()
        root.update()
        assert {shown(*at) for at in middles()} == {rgb("#cc0000")}
        assert {shown(*at) for at in before} == {rgb("#ffffff")}
    surface.refresh_now()
    surface.widget.destroy()
    root.update()


def test_closing_between_two_parts_that_are_shown_is_no_fault(root):
    surface = Surface(
        root,
        still=lambda pen: pen.box((0, 0, pen.width, pen.height), "#ffffff"),
        moving=lambda pen: [pen.disk(at, 4.0, "#00aa00", "#000000") for at in ((20, 20), (150, 150))],
    )
    surface.widget.pack(fill="both", expand=True)
    root.update()
    surface.refresh_now()
    assert surface._showing is not None
    surface.widget.destroy()
    root.update()
