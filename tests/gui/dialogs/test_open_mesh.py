"""What a mesh file holds is shown, and how to read it is asked."""

from dataclasses import replace

import pytest

from gui.dialogs.open_mesh import ask_how_to_open
from gui.jobs.tasks import MeshFacts, look_at_mesh
from gui.theme import DARK, apply
from skinfab.progress import silent


@pytest.fixture
def facts(tmp_path):
    """Of a real file: a cube of 4 units with a hole."""
    from person import MESHES

    text = (MESHES / "cube.obj").read_text().replace("40", "4")
    (tmp_path / "box.obj").write_text("\n".join(text.splitlines()[:-1]) + "\n")
    return look_at_mesh(path=tmp_path / "box.obj", progress=silent)


def words(widget):
    own = [str(widget.cget("text"))] if "text" in (widget.keys() or ()) else []
    return own + [w for child in widget.winfo_children() for w in words(child)]


def asked(root, facts: MeshFacts, act):
    seen = []

    def look():
        window = root.nametowidget("open_mesh")
        seen.extend(words(window))
        assert window.winfo_height() < 760 and window.winfo_width() < 1200
        act(window)

    apply(root, DARK)
    root.update()
    root.after(80, look)
    choice = ask_how_to_open(root, facts)
    assert root.grab_current() is None
    return choice, " ".join(seen)


def test_a_unit_is_chosen_and_a_hole_mended(root, facts):
    def act(window):
        window.nametowidget("body.units.cm").invoke()
        window.nametowidget("body.repair").invoke()
        window.nametowidget("body.buttons.open").invoke()

    choice, said = asked(root, facts, act)
    assert choice.units == "cm" and choice.repair is True
    assert "11 triangles, with 1 open border" in said and "cm: 40 mm long" in said and "mm: 4 mm long" in said


def test_enter_takes_what_is_suggested_and_escape_nothing(root, facts):
    def key(name):
        def act(window):
            window.focus_force()
            window.update()
            window.event_generate(name)

        return act

    choice, _ = asked(root, facts, key("<Return>"))
    assert choice.units == facts.units and choice.repair is False, "what can be used as it is, is not changed unasked"
    assert asked(root, facts, key("<Escape>"))[0] is None


def test_a_mesh_that_cannot_be_used_as_it_is_is_repaired_by_default(root, facts):
    broken = replace(facts, usable=False)
    choice, _ = asked(root, broken, lambda w: w.nametowidget("body.buttons.open").invoke())
    assert choice.repair is True


def test_a_long_list_is_cut_short_in_words(root, facts):
    many = replace(facts, found=tuple(f"fault number {k}" for k in range(40)))
    _, said = asked(root, many, lambda w: w.destroy())
    assert "fault number 7" in said and "fault number 8" not in said and "and 32 more" in said


def test_lengths_are_said_as_people_say_them(root, facts):
    _, said = asked(root, replace(facts, extent=90.0), lambda w: w.destroy())
    assert "mm: 90 mm long" in said and " m: 90 m long" in said and "e+" not in said
