"""Profiles by name, read once."""

from dataclasses import replace

import pytest

from gcode.check_wall import nozzle_margin
from gcode.printer import load_printer
from gui.state.profiles import ProfileShelf
from skinfab.errors import InputError
from skinfab.material import load_material


def test_what_a_document_names_is_read_once(skin):
    shelf = ProfileShelf()
    used = shelf.of(skin)
    assert used.printer == load_printer(skin.printer) and used.material == load_material(skin.material)
    assert shelf.get(skin.printer, skin.material) is used


def test_there_is_room_for_the_nozzle_beside_the_wall(skin):
    used = ProfileShelf().of(skin)
    assert used.roomy.margin == max(used.material.margin, nozzle_margin(used.printer, used.material)) >= used.material.margin
    assert replace(used.roomy, margin=used.material.margin) == used.material


@pytest.mark.parametrize(("field", "text"), [("printer", "no-such-printer"), ("material", "no-such-ink")])
def test_a_missing_one_is_a_sentence_each_time(skin, field, text):
    shelf = ProfileShelf()
    for _ in range(2):
        with pytest.raises(InputError, match=text):
            shelf.of(replace(skin, **{field: text}))
    assert shelf.of(skin).printer.name
