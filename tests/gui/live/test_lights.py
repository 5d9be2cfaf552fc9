from types import SimpleNamespace

import numpy as np
import pytest

from gui.live.lights import STEPS, Light, Lights, lights_of
from gui.state.derived import Derived
from gui.theme import DARK, LIGHT


def test_brightness_follows_the_change_and_a_sensor_is_lit_once():
    names, sensors = ("a", "b", "c"), ("C1", "C1", "C2")
    assert lights_of({}, names, sensors) == {}
    found = lights_of({"a": 0.01, "b": -3.0, "c": 0.2}, names, sensors)
    assert found == {"C1": Light(STEPS, rises=False), "C2": Light(2, rises=True)}
    assert found["C1"].strength == 1.0 and 0 < Light(1, rises=True).strength < found["C2"].strength < 1.0
    assert lights_of({"gone": 1.0}, names, sensors) == {}


class View:
    """What lights ask of a view, written down."""

    def __init__(self, root):
        from tkinter import ttk

        self.frame, self.on, self.calls = ttk.Frame(root), {}, 0

    def __getattr__(self, name):
        return getattr(self.frame, name)

    def glow(self, name, points, colour, *, radius, strength):
        self.on[name] = SimpleNamespace(points=np.asarray(points), colour=colour, radius=radius, strength=strength)
        self.calls += 1

    def show(self, name, lines, colour, width, *, words):
        self.on[name] = SimpleNamespace(lines=lines, colour=colour, width=width, words=words)
        self.calls += 1

    def hide(self, name):
        self.on.pop(name, None)


@pytest.fixture
def made(root, session):
    from gui.view2d.view import View2D
    from gui.view3d.view import View3D

    derived = Derived()
    views = View3D(root, session, derived, LIGHT), View2D(root, session, derived, LIGHT)
    spies = View(root), View(root)
    lights = Lights(session, derived, LIGHT, *views)
    lights._view3d, lights._view2d = spies
    return SimpleNamespace(lights=lights, solid=spies[0], flat=spies[1], session=session)


def test_only_what_changes_is_drawn(made):
    one = {"C1": Light(1, rises=True)}
    made.lights.show(one)
    made.lights.show(one)
    assert made.solid.calls == made.flat.calls == 1 and set(made.solid.on) == {"live C1"}
    made.lights.show({"C1": Light(3, rises=True), "C2": Light(1, rises=False)})
    assert made.solid.calls == 3 and made.solid.on["live C1"].colour != made.solid.on["live C2"].colour
    made.lights.show({})
    assert made.solid.on == made.flat.on == {}


def test_it_glows_where_the_sensor_sits(made):
    made.lights.show({"C1": Light(2, rises=True)})
    glow = made.solid.on["live C1"]
    # A spiral of 20 mm, 50 mm from the left and 30 from the front.
    assert (
        np.allclose(glow.points.mean(axis=0), (60, 30, 0), atol=12) and (np.abs(glow.points[:, 2]) < 1e-9).all() and 3 <= glow.radius <= 14
    )
    ((piece, line),) = made.flat.on["live C1"].lines
    assert made.flat.on["live C1"].words == "C1" and piece == "P1" and line.shape[1] == 2


def test_another_document_or_theme_is_lit_anew_and_sensors_that_are_gone_are_not(made):
    from dataclasses import replace

    made.lights.show({"C1": Light(2, rises=True)})
    skin = made.session.skin
    made.session.do("move", replace(skin, sensors=(replace(skin.sensors[0], x=70.0), skin.sensors[1])))
    before = made.solid.on["live C1"].points
    made.lights.show({"C1": Light(2, rises=True)})
    assert np.allclose(made.solid.on["live C1"].points - before, (20, 0, 0))
    made.lights.restyle(DARK)
    assert made.solid.on["live C1"].colour == DARK.select
    made.session.do("drop", replace(skin, sensors=()))
    made.lights.show({"C1": Light(2, rises=True)})
    assert made.solid.on == {} and made.lights.lit == {}
