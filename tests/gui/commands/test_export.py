"""The Export menu over the real worker process: the command line's bytes, questions before, nothing half-written, sentences after."""

import subprocess
import sys
import time
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest

from gcode import export
from gcode.used import limits_for, load_used, with_room_for_nozzle
from gui.commands.export import ExportCommands
from gui.desk import Desk
from gui.jobs import tasks
from gui.jobs.runner import Runner
from gui.state.derived import Derived
from gui.state.profiles import ProfileShelf
from gui.state.session import Session
from gui.toolpath.choice import ArcsChoice
from skinfab.document import save_skin
from skinfab.mesh.door import load_usable
from skinfab.placement.place import place_sensors
from skinfab.seams.partial import auto_cut
from skinfab.skin import Skin, Source

MESHES = Path(__file__).parents[3] / "meshes"


@dataclass
class Answers:
    """Answers as a person would; what was asked is kept."""

    path: Path | None = None
    answer: str = ""
    asked: list[str] = field(default_factory=list)

    def ask(self, title, text, answers, *, cancel=""):
        self.asked.append(text)
        return self.answer or cancel

    def folder(self, title):
        self.asked.append(title)
        return self.path

    def save_path(self, title, suffix, name):
        self.asked.append(name)
        return self.path


class Window:
    """What the commands need of one."""

    def __init__(self, root, skin):
        self.root, self.answers, self.said = root, Answers(), []
        self.session, self.arcs = Session(), ArcsChoice()
        self.runner = Runner(root, changed=lambda step: None, log=pytest.fail)
        self.desk = Desk(root, self.session, Derived(), ProfileShelf(), self.runner, self.answers, self.said.append, Path("unused"))
        self.session.open(skin, None)
        self.actions = {action.id: action for action in ExportCommands(self.desk, self.arcs).actions()}

    def do(self, id, path, answer=""):
        """Choose from the menu, and wait until all is done."""
        self.answers.path, self.answers.answer = path, answer
        assert self.actions[id].enabled()
        self.actions[id].run()
        self.wait(lambda: self.runner.job is None)

    def wait(self, until, seconds=60.0):
        end = time.monotonic() + seconds
        while not until():
            assert time.monotonic() < end
            self.root.update()
            time.sleep(0.005)

    def problems(self, kind):
        return [p.text for p in self.session.problems if p.kind == kind]


pytestmark = pytest.mark.usefixtures("quick_workers")


@pytest.fixture
def window(root, skin):
    made = Window(root, skin)
    yield made
    made.runner.close()


@pytest.fixture(scope="module")
def finger():
    """The robot finger with the sensors that place themselves."""
    loaded = load_usable(MESHES / "robot_finger.obj", units="mm")
    source = Source(loaded.file, loaded.sha256, loaded.units, loaded.scale)
    skin = Skin(loaded.mesh, source, np.zeros((0, 2), dtype=np.int64), ())
    used = load_used()
    cut = auto_cut(skin, limits_for(used, skin.max_distortion), neck=used.material.neck, material=used.material).skin
    roomy, _ = with_room_for_nozzle(used.material, used.printer)
    return replace(cut, sensors=tuple(place_sensors(cut, roomy, None)[0]))


def tree(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@pytest.mark.parametrize("arcs", [None, "lines"])
def test_gcode_of_the_finger_is_the_command_lines(root, finger, tmp_path, arcs):
    window = Window(root, finger)
    window.arcs.choose(arcs)
    window.do("export_gcode", tmp_path / "gui")
    window.runner.close()
    save_skin(finger, tmp_path / "finger.skin")
    options = ["--arcs", arcs] if arcs else []
    command = [sys.executable, "-m", "skinfab", "gcode", str(tmp_path / "finger.skin"), "-o", str(tmp_path / "cli"), *options]
    subprocess.run(command, check=True, capture_output=True)
    assert tree(tmp_path / "gui") == tree(tmp_path / "cli") != {}
    assert window.said[-1] == f"Wrote {tmp_path / 'gui' / 'P1.gcode'}."
    assert f"wrote {tmp_path / 'gui' / 'P1.gcode'}" in window.problems("note")


@pytest.mark.parametrize(("id", "suffix"), [("export_svg", "svg"), ("export_dxf", "dxf"), ("export_pdf", "pdf"), ("export_obj", "obj")])
def test_drawings(window, tmp_path, id, suffix):
    window.do(id, tmp_path / "flat")  # without its ending
    made = tmp_path / f"flat.{suffix}"
    assert tree(tmp_path).keys() == {made.name} and window.said[-1] == f"Wrote {made}."
    assert window.answers.asked == [f"plate_flat.{suffix}"]
    export.export_drawing(skin=window.session.skin, kind=suffix, path=tmp_path / f"again.{suffix}")
    assert made.read_bytes() == (tmp_path / f"again.{suffix}").read_bytes()


@pytest.mark.parametrize("undone", [False, True])
def test_an_export_says_when_the_skin_was_changed_meanwhile(window, tmp_path, undone):
    window.answers.path = made = tmp_path / "flat.svg"
    window.actions["export_svg"].run()
    window.session.do("another seed", replace(window.session.skin, seed=77))
    if undone:
        window.session.undo()
    window.wait(lambda: window.runner.job is None)
    said = f"Wrote {made}" + ("" if undone else ", of the skin as it was when the export began: it was changed meanwhile")
    assert window.said == [said + "."] and window.problems("note") == ["w" + said[1:]]


def test_an_ending_added_to_the_name_overwrites_nothing_unasked(window, tmp_path):
    (tmp_path / "flat.svg").write_text("mine")
    window.do("export_svg", tmp_path / "flat")
    assert "holds flat.svg already" in window.answers.asked[-1] and (tmp_path / "flat.svg").read_text() == "mine"
    window.do("export_svg", tmp_path / "flat", "Overwrite")
    assert (tmp_path / "flat.svg").read_text().startswith("<?xml")


def test_everything_and_the_report(window, tmp_path):
    window.do("export_everything", tmp_path / "all")
    assert set(tree(tmp_path / "all")) == set(export.files_of("everything", window.session.skin))
    assert window.said[-1] == f"Wrote {len(tree(tmp_path / 'all'))} files into {tmp_path / 'all'}."
    assert any(text.startswith("piece P2 has no sensor") for text in window.problems("warning"))
    window.do("export_report", tmp_path / "page.html")
    assert "data:image/png" in (tmp_path / "page.html").read_text()


def test_moulds_and_what_would_be_overwritten(window, tmp_path):
    window.do("export_moulds", tmp_path)
    assert set(tree(tmp_path)) == {"P1.stl", "P2.stl"}
    (tmp_path / "P1.stl").write_text("mine")
    window.do("export_moulds", tmp_path)
    assert window.answers.asked[-1] == f"{tmp_path} holds P1.stl, P2.stl already."
    assert (tmp_path / "P1.stl").read_text() == "mine"
    window.do("export_moulds", tmp_path, "Overwrite")
    assert (tmp_path / "P1.stl").read_bytes().startswith(b"skinfab mould")


def test_no_folder_no_export(window, tmp_path):
    for id, action in window.actions.items():
        if id.startswith("export_"):
            window.do(id, None)
            assert action.menu == "Export"
    assert window.said == [] and window.session.problems == () and list(tmp_path.iterdir()) == []


def test_a_refused_check_is_a_sentence(window, skin, tmp_path):
    window.session.do("move C1", replace(skin, sensors=(replace(skin.sensors[0], x=2.0), *skin.sensors[1:])))
    for id in ("export_gcode", "export_everything", "export_report"):
        window.do(id, tmp_path / "out")
        (sentence,) = window.problems("error")
        assert "C1" in sentence and window.said[-1] == sentence
    assert window.answers.asked == [], "nobody is asked where to write what cannot be written"
    assert list(tmp_path.iterdir()) == []
    # It goes once all is well.
    window.session.undo()
    window.do("export_gcode", tmp_path / "out")
    assert window.problems("error") == []


def test_a_folder_that_cannot_be_written_is_a_sentence(window, tmp_path):
    (tmp_path / "file").write_text("x")
    window.do("export_gcode", tmp_path / "file")
    assert "in the way" in window.problems("error")[0]
    window.do("export_svg", tmp_path / "gone" / "a.svg")
    assert "gone" in window.problems("error")[0]


def test_a_printer_that_is_gone_is_a_sentence(window, skin, tmp_path):
    window.session.do("other printer", replace(skin, printer="no-such-printer"))
    window.do("export_moulds", tmp_path)
    assert "no-such-printer" in window.problems("error")[0] and list(tmp_path.iterdir()) == []


def test_cancelled_it_leaves_nothing_and_says_so(root, finger, tmp_path):
    window = Window(root, finger)
    window.answers.path = tmp_path / "out"
    window.actions["export_everything"].run()
    window.wait(lambda: (tmp_path / "out").exists())
    begun = time.monotonic()
    window.runner.cancel()
    assert time.monotonic() - begun < 0.5
    window.wait(lambda: window.problems("error"))
    assert window.problems("error") == ["exporting everything was stopped before it was done; nothing was written"]
    window.wait(lambda: not (tmp_path / "out").exists(), seconds=10)
    window.runner.close()


def test_it_waits_for_what_goes_on(window, skin, tmp_path):
    window.desk.work("flattening", tasks.auto_cut, lambda result: None, source="flatten", skin=skin)
    job = window.runner.job
    window.answers.path = tmp_path / "out"
    window.actions["export_gcode"].run()
    assert window.runner.job is job and window.answers.asked == []
    assert window.problems("error") == ["flattening is still going on; export once it is done, or cancel it first"]


def test_what_can_be_exported_depends_on_what_there_is(window, skin):
    def enabled():
        return {id for id, action in window.actions.items() if action.enabled() and id.startswith("export_")}

    assert enabled() == {id for id in window.actions if id.startswith("export_")}
    window.session.do("clear", replace(skin, sensors=()))
    assert "export_gcode" not in enabled() and {"export_moulds", "export_everything", "export_svg"} <= enabled()
    window.session.do("uncut", replace(skin, sensors=(), pieces=()))
    assert enabled() == set()


def test_arcs_are_ticked_in_the_menu(window):
    ticks = {id: action.checked for id, action in window.actions.items() if action.checked}
    assert [id for id, on in ticks.items() if on()] == ["arcs_profile"]
    window.actions["arcs_lines"].run()
    assert window.arcs.arcs == "lines" and [id for id, on in ticks.items() if on()] == ["arcs_lines"]
