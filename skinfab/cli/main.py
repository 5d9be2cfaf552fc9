"""The `skinfab` command: finds the sub-command, runs it, and turns every fault into one line and an exit status.

Nothing heavy is imported here, and of the sub-commands only the one that was asked for: `skinfab --help` answers at once.
"""

from __future__ import annotations

import argparse
import importlib
import os
import signal
import sys
import traceback
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import Any

from skinfab import __version__
from skinfab.errors import SkinfabError

#: Sub-command and what it is for; `skinfab/cli/NAME.py` holds it.
COMMANDS = {
    "make": "mesh in, everything out: seams, flat pieces, sensors, G-code, moulds, report",
    "inspect": "what is in a mesh and what repair would do to it",
    "segment": "cut a mesh into pieces that flatten well",
    "flatten": "flatten a mesh and say how good it is",
    "place": "put sensors on the flat pieces",
    "mould": "casting moulds for the flat pieces",
    "gcode": "G-code for the sensors, or check a G-code file",
    "strips": "calibration strips for the ink: print them, then fit what was measured",
    "record": "record the frames of a port",
    "calibrate": "fit a strain sensor to joint angles",
    "angle": "a joint's angle from the markers of a motion capture",
    "replay": "a recorded log through the same code as live data",
    "control": "a robot's joint follows a human's, both read by strain sensors",
    "contact": "find contacts in the readings of a skin",
    "nail": "what a bare fingertip touches, by shaking its nail",
    "force": "a six-axis force/torque fingertip: contacts, textures, centre of gravity, shapes",
    "array": "a capacitive array round a fingertip: places, forces, lines, slips",
    "optical": "a camera in a soft fingertip: edges, and following them all round",
    "batch": "make for many meshes times many settings, on all cores or a cluster",
    "gui": "see the object, its flat skin and the sensors, and move them",
    "bench": "measure the project beside its peers: time against distortion",
}

INTERRUPTED = 130  # what a shell reports for a command that Ctrl-C ended
AGAIN_S = 2.0  # after so many seconds an interrupt that did not get through is repeated
AT_ONCE_S = 0.02  # and one that is known not to have got through
BROKEN_PIPE = 141  # and for one whose reader went away


def main(argv: Sequence[str] | None = None) -> int:
    """Run `skinfab` with these arguments and return its exit status.

    Parameters
    ----------
    argv : sequence of str, optional
        Without the program's name; taken from ``sys.argv`` when left out.

    Returns
    -------
    int
        0 done, 1 the input cannot be used, 2 wrong usage, 3 a result was refused, 130 interrupted.

    Examples
    --------
    >>> main(["--version"])  # doctest: +ELLIPSIS
    skinfab ...
    0
    """
    arguments = list(sys.argv[1:] if argv is None else argv)
    # Two threads make the sparse factorisations slower; the libraries read this once, when numpy is first imported.
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    with _quiet_warnings(), _termination_as_interrupt() as interrupts:
        return _guarded(lambda: _dispatch(arguments), interrupts)


def build_parser(arguments: Sequence[str]) -> argparse.ArgumentParser:
    """The parser for these arguments: the sub-command they name is complete, the others are their one line of help."""
    description = "From a 3D model to a printed, calibrated soft sensor skin."
    parser = _Parser(prog="skinfab", description=description, formatter_class=_CommandsInOneColumn)
    parser.add_argument("--version", action="version", version=f"skinfab {__version__}")
    subparsers = parser.add_subparsers(metavar="COMMAND", required=True, title="commands")
    wanted = next((a for a in arguments if not a.startswith("-")), None)
    for name, summary in COMMANDS.items():
        if name == wanted:
            importlib.import_module(f"skinfab.cli.{name}").add_parser(subparsers)
            subparsers.choices[name].set_defaults(parser=subparsers.choices[name])
        else:
            subparsers.add_parser(name, help=summary)
    return parser


class _Parser(argparse.ArgumentParser):
    """A parser that takes no shortened option: `--max` that works today would break a script when `--max-time` comes."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**{"allow_abbrev": False, **options})


class _CommandsInOneColumn(argparse.HelpFormatter):
    """argparse forgets the indent of sub-commands where it reckons the column of their help, and breaks the line of a long name."""

    def add_argument(self, action: argparse.Action) -> None:
        super().add_argument(action)
        names = list(action.choices or ()) if isinstance(action, argparse._SubParsersAction) else []
        self._action_max_length = max([self._action_max_length, *(len(name) + 4 for name in names)])


def _dispatch(arguments: list[str]) -> int:
    parser = build_parser(arguments)
    wanted = next((a for a in arguments if not a.startswith("-")), None)
    if wanted is not None and wanted not in COMMANDS:
        parser.error(f"there is no command {wanted!r}{_suggest(wanted, COMMANDS)}; skinfab --help lists them")
    args, unknown = parser.parse_known_args(arguments)
    if unknown:
        # Told by the sub-command's own parser: its usage line is the one that helps.
        options = [option for action in args.parser._actions for option in action.option_strings]
        args.parser.error(f"{unknown[0]!r} is not known here{_suggest(unknown[0].split('=')[0], options)}")
    return int(args.run(args))


def _suggest(word: str, known: Iterable[str]) -> str:
    import difflib

    near = difflib.get_close_matches(word, known, n=1)
    return f" (did you mean {near[0]}?)" if near else ""


def _guarded(work: Callable[[], int], interrupts: Sequence[int]) -> int:
    try:
        status = work()
        sys.stdout.flush()  # a full disk or a closed pipe must show here, not while Python shuts down
        return status
    except SystemExit as stop:  # argparse, after its own message
        return stop.code if isinstance(stop.code, int) else 0 if stop.code is None else 1
    except BaseException as fault:
        # An interrupt that a library turned into an error of its own is one all the same.
        if interrupts or isinstance(fault, KeyboardInterrupt):
            # Raised below a library's exec("..."), while it imports, Python 3.11 in the end dies of it (-2) although it was caught;
            # it forgets where another exec begins.
            exec("")
            return _complain("interrupted; nothing half-written was left", INTERRUPTED)
        return _explain(fault)


def _explain(fault: BaseException) -> int:
    """Say what went wrong in one line; the exit status that goes with it."""
    if isinstance(fault, BrokenPipeError):
        _drop_output()
        return BROKEN_PIPE
    if isinstance(fault, SkinfabError):
        return _complain(str(fault), fault.exit_status)
    if isinstance(fault, MemoryError):
        return _complain("not enough memory for this; close other programs, or give a mesh with fewer faces", 1)
    if isinstance(fault, OSError):
        where = f"{fault.filename}: " if fault.filename is not None else ""
        if fault.filename is None:
            _drop_output()  # most likely standard output itself
        return _complain(f"{where}{fault.strerror or fault}", 1)
    return _complain(
        f"unexpected {type(fault).__name__}: {fault}; SKINFAB_TRACEBACK=1 shows where (a fault of skinfab: please report it)", 1
    )


def _complain(message: str, status: int) -> int:
    if os.environ.get("SKINFAB_TRACEBACK") == "1":
        traceback.print_exc()
    print("skinfab:", " ".join(message.split()), file=sys.stderr)
    return status


def _drop_output() -> None:
    """Nobody reads standard output: let what is left in its buffer go nowhere, so that Python's own last flush is silent."""
    try:
        descriptor = sys.stdout.fileno()
    except (OSError, ValueError):  # not a real file (a test, a notebook): nothing to redirect
        return
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, descriptor)
    os.close(nowhere)


@contextmanager
def _quiet_warnings() -> Iterator[None]:
    """Keep library warnings off the user's terminal, unless Python was started with -W or PYTHONWARNINGS."""
    with warnings.catch_warnings():
        if not sys.warnoptions:
            warnings.simplefilter("ignore")
        yield


def _on_its_way_out() -> bool:
    """An interrupt is being handled: what is cleaned up on account of it, or said of it, must not be cut short by the next."""
    fault = sys.exception()
    while fault is not None and not isinstance(fault, KeyboardInterrupt):
        fault = fault.__context__
    return fault is not None


def _importing(frame: FrameType | None) -> bool:
    """A module is being loaded: a compiled one may abort the whole process when an interrupt meets its first lines."""
    while frame is not None and frame.f_code.co_filename != "<frozen importlib._bootstrap>":
        frame = frame.f_back
    return frame is not None


@contextmanager
def _termination_as_interrupt() -> Iterator[list[int]]:
    """Let SIGTERM and SIGHUP unwind like Ctrl-C, so that temporary files go, and see that each gets through."""

    seen: list[int] = []

    def interrupt(signum: int, frame: FrameType | None) -> None:
        # An interrupt inside a library's callback can be swallowed there: it comes again until it gets through.
        seen.append(signum)
        signal.setitimer(signal.ITIMER_REAL, AT_ONCE_S if _importing(frame) else AGAIN_S)
        if not (_importing(frame) or _on_its_way_out()):
            raise KeyboardInterrupt

    def swallowed(unraisable: sys.UnraisableHookArgs) -> None:
        # Raised inside a callback or a finaliser, where nothing can be raised: not told, as it comes again at once.
        if unraisable.exc_type is KeyboardInterrupt:
            signal.setitimer(signal.ITIMER_REAL, AT_ONCE_S)
        else:
            told(unraisable)

    told = sys.unraisablehook
    # Whatever was set to be ignored (nohup), or is handled by a host program, stays so.
    ours = {signal.SIGINT: signal.default_int_handler, **dict.fromkeys((signal.SIGTERM, signal.SIGHUP, signal.SIGALRM), signal.SIG_DFL)}
    caught = {s: before for s, before in ours.items() if signal.getsignal(s) == before}
    if signal.SIGALRM not in caught:
        caught = {}
    try:
        for s in caught:
            signal.signal(s, interrupt)
        if caught:
            sys.unraisablehook = swallowed
        yield seen
    finally:
        sys.unraisablehook = told
        if caught:
            signal.setitimer(signal.ITIMER_REAL, 0)
        for s, before in caught.items():
            signal.signal(s, before)
