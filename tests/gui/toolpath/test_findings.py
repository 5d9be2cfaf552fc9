"""What a check finds, as problems."""

from dataclasses import replace

from gcode.check import Judgement
from gcode.moves import Finding
from gcode.piece import piece_program
from gcode.printer import Nozzle, load_printer
from gui.state.selection import Target
from gui.toolpath.findings import SOURCE, problems_of
from skinfab.material import load_material


def test_a_good_program_is_one_note(printed):
    program = piece_program(printed, "P1", printer=load_printer(), material=load_material())
    (note,) = problems_of(program, program.judge())
    assert (note.kind, note.source) == ("note", SOURCE) and "G-code of P1: no fault found on Creality" in note.text


def test_faults_of_one_kind_are_one_line_that_shows_its_sensor(printed):
    thick = replace(load_printer(), nozzle=Nozzle(outer_radius=11.0, clearance=0.2))
    program = piece_program(printed, "P1", printer=thick, material=load_material())
    judgement = program.judge()
    found = [p for p in problems_of(program, judgement) if p.kind == "error"]
    assert len(found) == len({f.kind for f in judgement.findings}) < len(judgement.findings)
    assert found[0].target.piece == "P1" and found[0].target.sensor in ("C1", "C2") and "more line" in found[0].text


def test_a_line_that_cannot_be_read_and_notes_are_said(printed):
    program = piece_program(printed, "P1", printer=load_printer(), material=load_material())
    told = problems_of(program, Judgement((Finding(0, "it lays no ink", "add some"),), ("a note",), "line 4: cannot read 'x'"))
    assert [(p.kind, p.text) for p in told] == [
        ("error", "G-code of P1, file: it lays no ink; add some"),
        ("error", "G-code of P1: line 4: cannot read 'x'"),
        ("note", "G-code of P1: a note"),
    ]
    assert told[0].target == Target(piece="P1")
