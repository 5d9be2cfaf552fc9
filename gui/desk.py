"""What every command of the window needs at hand: the document, the work that goes on, dialogs, and where to say things."""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gui.dialogs.dialogs import Dialogs
from gui.jobs.runner import Runner
from gui.panels.field import focused
from gui.state.derived import Derived
from gui.state.problem import Problem
from gui.state.profiles import Profiles, ProfileShelf
from gui.state.session import Session
from gui.state.wording import in_window
from skinfab.errors import SkinfabError
from skinfab.skin import Skin


@dataclass(frozen=True)
class Desk:
    """Shared by all commands and tools.

    Parameters
    ----------
    root : Tk
    session : Session
    derived : Derived
    shelf : ProfileShelf
    runner : Runner
    dialogs : Dialogs
    say : callable
        Shows a sentence in the status bar.
    state : Path
        Folder of the window's own files.
    """

    root: tk.Tk
    session: Session
    derived: Derived
    shelf: ProfileShelf
    runner: Runner
    dialogs: Dialogs
    say: Callable[[str], None]
    state: Path

    @property
    def skin(self) -> Skin:
        """The open document; only where a command is enabled by `has_skin`."""
        skin = self.session.skin
        assert skin is not None
        return skin

    def has_skin(self) -> bool:
        """Something is open."""
        return self.session.skin is not None

    def has_pieces(self) -> bool:
        """Something lies flat."""
        return self.session.skin is not None and bool(self.session.skin.pieces)

    def has_sensors(self) -> bool:
        """There are sensors."""
        return self.session.skin is not None and bool(self.session.skin.sensors)

    def settle(self) -> bool:
        """Take the text of the field that is being typed in; whether nothing stands in the way of going on."""
        field, job = focused(self.root), self.runner.job
        if field is None or not field.pending:
            return True
        if not field.commit():
            return False
        begun = self.runner.job
        if begun is job or begun is None or begun.own:
            return True
        self.complain("busy", f"{begun.label} was begun, for the text that was typed; ask again once it is done")
        return False

    def work(
        self,
        label: str,
        function: Callable[..., Any],
        done: Callable[[Any], None],
        *,
        source: str,
        failed: Callable[[], None] | None = None,
        own: bool = False,
        wanted: Callable[[], bool] | None = None,
        **arguments: Any,
    ) -> bool:
        """Have long work done, unless other work goes on that was asked for; a failure becomes a line of `source` in the problems list.

        Parameters
        ----------
        label, function, **arguments
            See `Runner.start`.
        done : callable
            Called with the result; what `source` had said is gone by then.
        source : str
        failed : callable, optional
            Called after the failure was listed.
        own : bool
            Nobody asked for it, such as flattening after a cut: it gives way to what is asked for, and is not begun beside it.
        wanted : callable, optional
            Whether `done` could still use the result; where a change of the document makes that False, the work is stopped.

        Returns
        -------
        bool
            Whether it was begun; why it was not is said.
        """
        busy = self.runner.job
        if busy is not None and not busy.own:
            if not own:
                self.complain("busy", f"{busy.label} is still going on; ask for {label} once it is done, or press Cancel below first")
            return False
        if not own:
            self.session.report("busy", [])

        def succeeded(result: Any) -> None:
            if not own:
                self.session.report("busy", [])
            if wanted is not None and not wanted():
                self.in_vain(label)
                return
            self.session.report(source, [])
            self.guarded(source, lambda: done(result))

        def refused(sentence: str) -> None:
            if not own:
                self.session.report("busy", [])
            self.complain(source, sentence)
            if failed is not None:
                failed()

        self.runner.start(label, function, done=succeeded, failed=refused, own=own, wanted=wanted, **arguments)
        return True

    def guarded(self, source: str, work: Callable[[], object]) -> bool:
        """Do short work here; a fault of the user's becomes a line of `source`. Whether it went well."""
        try:
            work()
        except SkinfabError as fault:
            self.complain(source, str(fault))
            return False
        return True

    def complain(self, source: str, sentence: str) -> None:
        """List a failure, and show it in the status bar too."""
        sentence = in_window(sentence)
        self.session.report(source, [Problem(sentence, source)])
        self.say(sentence)

    def in_vain(self, label: str) -> None:
        """Say of long work that its result cannot be used."""
        self.dropped(f"{label} was stopped, as the skin it was asked for has changed; ask for it again")

    def dropped(self, sentence: str) -> None:
        """List why the result of long work is not taken; it stays until work is asked for again."""
        self.session.report("busy", [Problem(sentence, "busy", kind="warning")])
        self.say(sentence)

    def note(self, source: str, notes: Iterable[str], *, kind: str = "note") -> None:
        """List sentences that are no failures."""
        self.session.report(source, [Problem(in_window(text), source, kind=kind) for text in notes])

    def profiles(self) -> Profiles | None:
        """Printer and material of the document; None where one cannot be loaded, which is then listed."""
        found: list[Profiles] = []
        self.guarded("profiles", lambda: found.append(self.shelf.of(self.skin)))
        if found:
            self.session.report("profiles", [])
        return found[0] if found else None
