"""G-code text as commands with words: the tokens, nothing of their meaning."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from gcode.blocks import parted
from skinfab.errors import InputError

#: Heaters, which may name a tool by T.
HEATERS = frozenset({"M104", "M109", "M140", "M141", "M190", "M191"})

#: Settings of the firmware that a file may change; T is a tool there, too, or the travels' acceleration.
SETTINGS = frozenset({"M92", "M200", "M201", "M203", "M204", "M205", "M211"})

#: Commands that free the motors; like G28 they take axes as flags.
MOTORS_OFF = frozenset({"M18", "M84"})

#: Commands whose words are read; any other line (messages, fans) is passed over as it stands.
READ = HEATERS | SETTINGS | MOTORS_OFF | {"G0", "G1", "G2", "G3", "G4", "G5", "G20", "G21", "G28", "G90", "G91", "G92"}
READ |= {
    "M192",
    "M3",
    "M4",
    "M5",
    "M82",
    "M83",
    "M85",
    "M206",
    "M209",
    "M218",
    "M220",
    "M221",
    "M111",
    "M280",
    "M302",
    "M350",
    "M401",
    "M420",
    "M425",
    "M486",
    "M900",
    "M906",
}
#: Codes of lines without a G, M or T: one that goes on with the last motion, and one that sets F or S and moves nothing.
MODAL, SETTING = "X", "F"

_FLAGS = MOTORS_OFF | {"G28", "M420", "M425", "M486"}
_TAKE_T = HEATERS | SETTINGS | {"M206", "M218", "M221", "M420", "M486", "M900", "M906"}

#: A line beyond this is not G-code, and a file beyond that is not a skin's.
LINE_LIMIT, FILE_LIMIT = 4096, 256 * 2**20

_COMMAND = re.compile(r"(?:[Nn]\d{1,9}\s*)?([GMTO])\s*(\d{1,5})(\.\d{1,3})?(?![\d.])", re.IGNORECASE)
_BARE = re.compile(r"(?:N\d{1,9}\s*)?(?=[EFIJKRSXYZ]\s*[-+.\d])", re.IGNORECASE)
_WORD = re.compile(r"\s*([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))?", re.IGNORECASE)

#: No number on a printer is larger, in whatever unit; of far larger ones neither lengths nor angles could be computed.
LARGEST = 1e8

#: Words as nearly every line has them, so short that no number is too large.
_PLAIN = re.compile(r"(?:\s*[A-FH-LN-SU-Z]\s*[-+]?(?:\d{1,8}(?:\.\d{0,99})?|\.\d{1,99}))*\s*")
_PLAIN_WORD = re.compile(r"([A-Z])\s*([-+.\d]+)")
#: Of an object (M486): it comes last, as `A"name"` or `Aname`.
_NAME = re.compile(r"[Aa\"].*")
_BRACKETS = re.compile(r"\([^()]*\)")
#: What GRBL passes over (its protocol.c): a bracket up to the next closing one or the line's end, and all behind a semicolon.
_PASSED_OVER = re.compile(r"\([^)]*\)?|;(.*)")


@dataclass(frozen=True, slots=True)
class Command:
    """One command line: `line` counts from 1, `code` is normalised ("G2" for "G02"), `size` is what the firmware keeps of it.

    Marlin keeps the bytes before a comment, GRBL (`blocks`) what is no blank, no comment and no ``/`` (its protocol.c).
    """

    line: int
    code: str
    words: dict[str, float | None]
    comment: str
    size: int


def read_text(path: str | Path) -> str:
    """The text of a G-code file, or one sentence why it is none.

    Raises
    ------
    InputError
        The file is missing, a folder, unreadable, binary or far too large.
    """
    path = Path(path)
    if path.is_dir():
        raise InputError(f"{path} is a folder; give one G-code file{_example_in(path)}")
    try:
        if path.stat().st_size > FILE_LIMIT:
            raise InputError(f"{path} is larger than {FILE_LIMIT >> 20} MiB; that is not the G-code of a skin")
        data = path.read_bytes()
    except OSError as fault:
        raise InputError(f"cannot read {path}: {fault.strerror or fault}") from fault
    if b"\0" in data:
        raise InputError(f"{path} is a binary file, not G-code text")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")  # old slicers write their comments so


def lines_of(text: str) -> list[str]:
    """Its lines, whatever ends them: a file that went through Windows or an old Mac reads as it was.

    Examples
    --------
    >>> lines_of("G28\\r\\nG0 X1\\rG0 X2\\n")
    ['G28', 'G0 X1', 'G0 X2', '']
    """
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def _example_in(folder: Path) -> str:
    # A results folder keeps its files one level down.
    found = min([*folder.glob("*.gcode"), *folder.glob("*/*.gcode")], default=None)
    return f", such as {found}" if found else ", there is none in it"


def read_commands(text: str, *, blocks: bool = False) -> Iterator[Command]:
    """The commands and comments of a text, in order; a line of comment alone has the code "", one of words alone `MODAL` or `SETTING`.

    With `blocks` a line may have several codes, as RS-274 allows (`gcode.blocks`); each is a command of its own.

    Raises
    ------
    InputError
        A line that cannot be read, with its number.

    Examples
    --------
    >>> [(c.code, c.words) for c in read_commands("g01x1.5 Y-2 ; hello")]
    [('G1', {'X': 1.5, 'Y': -2.0})]
    """
    for line, raw in enumerate(lines_of(text), 1):
        body, mark, comment = _uncommented(raw) if blocks else raw.partition(";")
        if len(body) > LINE_LIMIT:
            raise InputError(f"line {line} is {len(body)} characters long; that is not a G-code command")
        if not blocks and "(" in body:
            body = _BRACKETS.sub(" ", body)
        body = body.partition("*")[0].strip()
        if not body or body == "%":
            if mark:
                yield Command(line, "", {}, comment.strip(), 0)
            continue
        if blocks:
            size = len("".join(body.split()).encode())
        else:
            kept = raw.partition(";")[0].rstrip()
            size = len(kept if kept.isascii() else kept.encode())
        for part in parted(body) if blocks else (body,):
            code, words = _command(part, line, blocks=blocks)
            yield Command(line, code, words, comment.strip(), size)


def _uncommented(raw: str) -> tuple[str, str, str]:
    """A line as GRBL keeps it but for its blanks, then as `str.partition` says it: the mark and text of its comment.

    GRBL has no block delete: it leaves each ``/`` out and obeys the line.
    """
    if "(" not in raw:
        body, mark, comment = raw.partition(";")
    else:
        comments = [found[1] for found in _PASSED_OVER.finditer(raw) if found[0][0] == ";"]
        body, mark, comment = _PASSED_OVER.sub(" ", raw), ";" * len(comments), "".join(comments)
    return body.replace("/", ""), mark, comment


def _command(body: str, line: int, *, blocks: bool) -> tuple[str, dict[str, float | None]]:
    found = _COMMAND.match(body)
    if found and (blocks or found[1] not in "Oo"):  # a program's number, which GRBL refuses: told as such
        code, rest = _code(*found.groups()), body[found.end() :]
        if code == "M486":
            rest = _NAME.sub("", rest)
        return code, _words(rest, line, code) if code in READ else {}
    if bare := _BARE.match(body):
        words = _words(body[bare.end() :], line, MODAL)
        return SETTING if words.keys() <= {"F", "S"} else MODAL, words
    known = "what begins with $ is told to GRBL before, not in a file" if body[0] == "$" else "a command begins with G, M or T and a number"
    raise InputError(f"line {line}: cannot read {_shown(body)}; {known}")


@lru_cache(maxsize=1024)
def _code(letter: str, number: str, sub: str | None) -> str:
    return f"{letter.upper()}{int(number)}{sub or ''}"


def _words(rest: str, line: int, code: str) -> dict[str, float | None]:
    if _PLAIN.fullmatch(rest):
        pairs = _PLAIN_WORD.findall(rest)
        plain: dict[str, float | None] = {letter: float(number) for letter, number in pairs}
        if len(plain) == len(pairs):
            return plain
    words: dict[str, float | None] = {}
    at = 0
    while at < len(rest):
        found = _WORD.match(rest, at)
        if not found:
            raise InputError(f"line {line}: cannot read {_shown(rest[at:])}; a word is one letter and one number")
        letter = found[1].upper()
        if found[2] is None and rest[found.end() : found.end() + 1].isalpha() and code not in _FLAGS:  # G28 XY
            raise InputError(f"line {line}: cannot read {_shown(rest[at:].strip())}; a word is one letter and one number")
        value = None if found[2] is None else float(found[2])
        if value is not None and not math.isfinite(value):
            raise InputError(f"line {line}: {letter} is not a finite number; write it out in millimetres")
        if value is not None and abs(value) > LARGEST:
            raise InputError(f"line {line}: {letter} is {value:.3g}, which is no number for a printer; write it anew in millimetres")
        if letter in words or letter in ("GM" if code in _TAKE_T else "GMT"):
            raise InputError(f"line {line}: a second {letter} on one line; give each command a line of its own")
        words[letter] = value
        at = found.end()
    return words


def _shown(text: str) -> str:
    return repr(text if len(text) <= 30 else text[:30] + "...")
