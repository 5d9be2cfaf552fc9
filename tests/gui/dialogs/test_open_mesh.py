"""What a mesh file holds is shown, and how to read it is asked."""

from dataclasses import replace

import numpy as np
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


def test_it_tells_of_what_will_be_opened(root, tmp_path):
    """A cube cut open along all its edges in the file: reading joins them."""
    from person import MESHES

    lines = (MESHES / "cube.obj").read_text().splitlines()
    points = [line for line in lines if line.startswith("v ")]
    faces = [[int(word.split("/")[0]) for word in line.split()[1:]] for line in lines if line.startswith("f ")]
    apart = [points[corner - 1] for face in faces for corner in face]
    named = [f"f {3 * k + 1} {3 * k + 2} {3 * k + 3}" for k in range(len(faces))]
    (tmp_path / "apart.obj").write_text("\n".join([*apart, *named]) + "\n")
    facts = look_at_mesh(path=tmp_path / "apart.obj", progress=silent)
    assert facts.headline == f"apart.obj: {len(faces)} triangles, closed"
    assert not any("open" in sentence for sentence in facts.found) and not facts.repair_does
    assert any("joined" in sentence for sentence in facts.cleaning_does)
    _, said = asked(root, facts, lambda window: window.destroy())
    assert "What reading it mends" in said and "joined" in said and "border" not in said


def test_a_hole_that_is_too_large_for_repair_is_not_said_to_be_closed_by_it(tmp_path):
    """A tube of 40 edges round: repair closes holes of up to 30."""
    turn = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    points = [f"v {10 * np.cos(a):.4f} {10 * np.sin(a):.4f} {z}" for z in (0, 20) for a in turn]
    faces = [f"f {k + 1} {(k + 1) % 40 + 1} {k + 41}\nf {(k + 1) % 40 + 1} {(k + 1) % 40 + 41} {k + 41}" for k in range(40)]
    (tmp_path / "tube.obj").write_text("\n".join([*points, *faces]) + "\n")
    facts = look_at_mesh(path=tmp_path / "tube.obj", progress=silent)
    (said,) = (sentence for sentence in facts.found if "open edge" in sentence)
    assert facts.repair_does == () and said.endswith("kept as a border; too large for Repair, which closes holes of up to 30 edges")


def test_a_hole_that_repair_closes_is_said_to_be(facts):
    (said,) = (sentence for sentence in facts.found if "open edge" in sentence)
    assert any("closed holes" in does for does in facts.repair_does) and said.endswith("Repair, when it is opened, closes small holes")
