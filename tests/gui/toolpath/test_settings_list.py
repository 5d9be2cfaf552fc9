"""The profile is listed and can be read to its end."""

from gcode.printer import load_printer
from gui.theme import LIGHT, apply
from gui.toolpath.settings import settings
from gui.toolpath.settings_list import SettingsList


def test_it_lists_the_profile_that_is_shown(root):
    apply(root, LIGHT)
    shown = SettingsList(root)
    for name in ("ender5plus-vipro", "generic-grbl"):
        shown.show(load_printer(name), name)
        rows = [row for group in shown.list.get_children() for row in shown.list.get_children(group)]
        assert [tuple(map(str, shown.list.item(row, "values"))) for row in rows] == [
            (s.value, s.unit) for s in settings(load_printer(name))
        ]
        assert shown.title.get().startswith(f"{name}.toml")
    assert shown.list.item("/spindle", "text").startswith("Spindle")
    shown.show(None)
    assert shown.list.get_children() == () and shown.title.get() == ""
