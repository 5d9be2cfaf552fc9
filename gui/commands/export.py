"""Files for the printer, the cutter and the reader: what the command line writes of the same document."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gcode import export
from gcode.emit import Arcs
from gcode.export import Drawing, Exported, Folder
from gcode.used import used_by
from gui.actions import Action
from gui.desk import Desk
from gui.jobs.runner import Job
from gui.state.problem import Problem
from gui.toolpath.choice import ARCS, ArcsChoice
from skinfab.placement.check import validate
from skinfab.skin import Skin

#: How often it is looked whether an export was cancelled, ms.
_LOOK_MS = 200

#: So many files that are there already are named.
_NAMED = 6

#: Answers to closing the window during an export.
_WAIT, _STOP = "Wait", "Stop it and close"

_DRAWINGS: dict[Drawing, str] = {"svg": "SVG", "dxf": "DXF", "pdf": "PDF 1:1", "obj": "flat OBJ"}


@dataclass
class _Running:
    """An export that goes on, until it has ended in one way or another."""

    label: str
    job: Job | None = None
    ended: bool = False


class ExportCommands:
    """The Export menu.

    Parameters
    ----------
    desk : Desk
    arcs : ArcsChoice
        Of the G-code.
    """

    def __init__(self, desk: Desk, arcs: ArcsChoice) -> None:
        self._desk, self._arcs = desk, arcs
        self._running: _Running | None = None

    def actions(self) -> list[Action]:
        """For the table."""
        pieces, sensors = self._desk.has_pieces, self._desk.has_sensors

        def drawing(kind: Drawing) -> Action:
            return Action(f"export_{kind}", f"{_DRAWINGS[kind]} …", "Export", lambda: self.drawing(kind), enabled=pieces)

        def arcs(which: Arcs | None) -> Action:
            label = f"G-code arcs: {ARCS[which]}"
            return Action(
                f"arcs_{which or 'profile'}", label, "Export", lambda: self._arcs.choose(which), checked=lambda: self._arcs.arcs == which
            )

        tip = "Everything that skinfab make writes: G-code, tool paths, moulds, drawings, wiring, report."
        return [
            Action("export_gcode", "G-code …", "Export", self.gcode, "Control-e", sensors, "One checked file a piece with sensors.", True),
            *(arcs(which) for which in ARCS),
            Action("export_moulds", "Moulds …", "Export", self.moulds, "", pieces, "A casting mould for each piece, STL in mm."),
            Action("export_everything", "Everything …", "Export", self.everything, "Control-Shift-E", pieces, tip),
            *(drawing(kind) for kind in _DRAWINGS),
            Action("export_report", "Report …", "Export", self.report, "", pieces, "One page: what to print, weigh and pour."),
        ]

    def may_leave(self) -> bool:
        """Whether the window may be closed: while an export goes on that is asked, for its files would not be written."""
        running = self._running
        if running is None or running.ended or running.job is not self._desk.runner.job:
            return True
        text = f"{running.label[:1].upper()}{running.label[1:]} is still going on. If it is stopped, nothing of it is written."
        answer = self._desk.dialogs.ask("An export is running", text, (_WAIT, _STOP), cancel=_WAIT)
        return answer == _STOP

    def gcode(self) -> None:
        """``PIECE.gcode`` for each piece with sensors."""
        self._into_folder("gcode", "Folder for the G-code", "exporting G-code", export.export_gcode, arcs=self._arcs.arcs)

    def moulds(self) -> None:
        """``PIECE.stl`` for each piece."""
        self._into_folder("moulds", "Folder for the moulds", "exporting moulds", export.export_moulds)

    def everything(self) -> None:
        """What `skinfab make` writes."""
        self._into_folder("everything", "Folder for all results", "exporting everything", export.export_everything)

    def drawing(self, kind: Drawing) -> None:
        """The flat skin as one file."""
        self._into_file(f".{kind}", f"Export {_DRAWINGS[kind]}", "_flat", export.export_drawing, kind=kind)

    def report(self) -> None:
        """One page."""
        if self._ready() and self._may_be_printed():
            self._into_file(".html", "Export the report", "_report", export.export_report)

    def _into_folder(self, what: Folder, title: str, label: str, function: Callable[..., Exported], **arguments: Any) -> None:
        if not (self._ready() and (what == "moulds" or self._may_be_printed())):
            return
        folder = self._desk.dialogs.folder(title)
        if folder is None:
            return
        skin = self._desk.skin
        names: list[str] = []
        if not self._desk.guarded("export", lambda: names.extend(export.files_of(what, skin))):
            return
        there = [name for name in names if (folder / name).exists()]
        if there and not self._may_overwrite(folder, there, all_of_them=what == "everything"):
            return
        self._start(label, function, skin=skin, folder=folder, **arguments)

    def _into_file(self, suffix: str, title: str, tail: str, function: Callable[..., Exported], **arguments: Any) -> None:
        if not self._ready():
            return
        source = self._desk.session.path or Path(self._desk.skin.source.file)
        path = self._desk.dialogs.save_path(title, suffix, f"{source.stem}{tail}{suffix}")
        if path is None:
            return
        if path.suffix.lower() != suffix:
            path = path.with_name(path.name + suffix)
            if path.exists() and not self._may_overwrite(path.parent, [path.name], all_of_them=False):
                return  # the dialog has asked about the name without its suffix
        self._start(f"exporting {path.name}", function, skin=self._desk.skin, path=path, **arguments)

    def _ready(self) -> bool:
        """Whether the document stands still: what is not flattened yet must not reach a printer, nor be given up for this."""
        job = self._desk.runner.job
        if job is not None:
            self._desk.complain("export", f"{job.label} is still going on; export once it is done, or cancel it first")
        return job is None

    def _may_be_printed(self) -> bool:
        """Whether all sensors fit: nobody is asked for a place for files that cannot be written."""
        skin = self._desk.skin
        return self._desk.guarded("export", lambda: validate(skin, used_by(skin).material))

    def _may_overwrite(self, folder: Path, there: Sequence[str], *, all_of_them: bool) -> bool:
        listed = ", ".join(there[:_NAMED]) + (f" and {len(there) - _NAMED} more" if len(there) > _NAMED else "")
        text = f"{folder} holds {listed} already."
        if all_of_them:
            text += " Files that an earlier run made and this one does not are removed too."
        return self._desk.dialogs.ask("Overwrite?", text, ("Overwrite", "Cancel"), cancel="Cancel") == "Overwrite"

    def _start(self, label: str, function: Callable[..., Exported], *, skin: Skin, **arguments: Any) -> None:
        running = self._running = _Running(label)

        def done(exported: Exported) -> None:
            running.ended = True
            self._tell(exported, skin)

        def failed() -> None:
            running.ended = True

        self._desk.session.report("export", [])
        self._desk.work(label, function, done, source="export", failed=failed, skin=skin, **arguments)
        running.job = job = self._desk.runner.job

        def look() -> None:
            if running.ended:
                return
            if self._desk.runner.job is job:
                self._desk.root.after(_LOOK_MS, look)
            else:
                self._desk.complain("export", f"{label} was stopped before it was done; nothing was written")

        self._desk.root.after(_LOOK_MS, look)

    def _tell(self, exported: Exported, skin: Skin) -> None:
        files = exported.files
        where = str(files[0]) if len(files) == 1 else f"{len(files)} files into {_folder_of(files)}"
        if self._desk.session.skin is not skin:
            where += ", of the skin as it was when the export began: it was changed meanwhile"
        self._desk.say(f"Wrote {where}.")
        notes = [Problem(f"wrote {where}", "export", kind="note")]
        notes += [Problem(note, "export", kind="warning") for note in exported.notes]
        self._desk.session.report("export", notes)


def _folder_of(files: Sequence[Path]) -> Path:
    """The folder that holds all of them.

    Examples
    --------
    >>> _folder_of([Path("out/gcode/P1.gcode"), Path("out/flat.svg")]).as_posix()
    'out'
    """
    return min((path.parent for path in files), key=lambda folder: len(folder.parts))
