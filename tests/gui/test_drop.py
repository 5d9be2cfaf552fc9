"""Files that are dragged in are opened."""

from pathlib import Path

from gui.drop import accept_files, first_path


def test_a_dropped_file_is_handed_on(root):
    heard = []
    assert accept_files(root, heard.append), "the library for this Tk is in the package"
    script = root.tk.call("bind", root, "<<Drop:DND_Files>>")
    assert root.tk.eval(script.replace("%D", "{{/tmp/my files/cup.obj} /tmp/b.obj}")) == "copy"
    root.update()
    assert heard == [Path("/tmp/my files/cup.obj")]


def test_nothing_is_no_file(root):
    assert first_path(root, "") is None
    assert first_path(root, "file:///tmp/a.skin") == Path("/tmp/a.skin")
