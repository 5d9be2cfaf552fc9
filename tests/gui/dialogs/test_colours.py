"""Tk's file dialogs have the window's colours, whatever they were shown with before."""

from gui.dialogs.colours import colour_dialogs
from gui.dialogs.dialogs import Dialogs
from gui.theme import DARK, LIGHT, apply

LIST = "contents.icons.cHull.canvas"


def shown(root, ask, name, look):
    """What `look` says of a dialog's list of files while that is open."""
    seen, waits = [], [100]

    def act():
        canvas = f"{name}.{LIST}"
        if not int(root.tk.call("winfo", "exists", canvas)) or not int(root.tk.call("winfo", "ismapped", canvas)):
            waits.append(root.after(20, act))
            assert len(waits) < 500, f"no {canvas}"
            return
        root.update()
        seen.append(look(canvas))
        root.tk.call(f"{name}.contents.f2.cancel", "invoke")

    root.after(50, act)
    ask()
    return seen[0]


def test_the_list_of_files_is_in_the_themes_colours(root, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("a.obj", "b.obj"):
        (tmp_path / name).write_text("v 0 0 0\n")

    def colours(canvas):
        def of(item):
            return str(root.tk.call(canvas, "itemcget", item, "-fill"))

        items = root.tk.splitlist(root.tk.call(canvas, "find", "withtag", "text"))
        before = [of(item) for item in items]
        for item in items:  # the first is chosen, and then the second in its place
            x, y, *_ = (int(float(v)) for v in root.tk.splitlist(root.tk.call(canvas, "bbox", item)))
            for event in ("<Button-1>", "<ButtonRelease-1>"):
                root.tk.call("event", "generate", canvas, event, "-x", x + 3, "-y", y + 3)
            root.update()
        return str(root.tk.call(canvas, "cget", "-background")), before, of(items[0])

    for theme in (DARK, LIGHT, DARK):  # Tk keeps the dialog for the next time
        apply(root, theme)
        colour_dialogs(root, theme)
        ground, words, left_again = shown(root, Dialogs(root).open_path, ".__tk_filedialog", colours)
        assert ground == theme.field and words == [theme.text] * 2 and left_again == theme.text


def test_so_is_the_list_of_folders(root):
    apply(root, DARK)
    colour_dialogs(root, DARK)
    ground = shown(root, lambda: Dialogs(root).folder("Where to"), ".__tk_choosedir", lambda c: str(root.tk.call(c, "cget", "-background")))
    assert ground == DARK.field
