"""Ways of writing that one firmware reads and another does not: round brackets, lower case, checksums."""

from __future__ import annotations

import re
from collections.abc import Iterator

from gcode.check_commands import WORDS
from gcode.moves import Finding, Trace
from gcode.words import READ, Command, lines_of

_BRACKET = re.compile(r"\(([^()]*)\)")
#: As Marlin's parser.cpp goes through a line: capitals, each with a number or without one.
_CAPITAL = re.compile(r"([A-Z]) *([-+]?\.?\d)?")
_LINE_NUMBER = re.compile(r"\s*[Nn]\s*\d+\s*")
#: Of the commands that are read, these take no words at all.
_BARE = frozenset({"G20", "G21", "G90", "G91", "M82", "M83"})
#: All of their line is words; other commands may have a name or a message, in any letters.
_SPELLED = READ - {"M486"}
#: Flags that do more than their command without them, or elsewhere.
_FLAGS = {"G28": "XYZO", "M18": "XYZ", "M84": "XYZ", "M425": "XYZ", "M486": "CP"}


def dialect_findings(text: str, judged: Trace, *, spindle: bool) -> Iterator[Finding]:
    """What the printer's firmware reads otherwise than it is meant.

    Marlin passes over what is in round brackets, and obeys lower case, only where it is built so (its PAREN_COMMENTS and
    GCODE_CASE_INSENSITIVE, both off in Configuration_adv.h); GRBL knows both, but no checksum: an asterisk is no letter of a
    word, its error 1 (gnea/grbl, gcode.c).

    Examples
    --------
    >>> from gcode.trace import trace
    >>> text = "M83\\nG1 X118 E2.9 (X500)"
    >>> print(*dialect_findings(text, trace(text), spindle=False))
    line 2: Marlin obeys X500 in the brackets, unless it was built with PAREN_COMMENTS; begin the comment with ;
    """
    if spindle:
        yield from _summed(text)
        return
    yield from _bracketed(text, judged)
    yield from _lower(text, judged)


def _summed(text: str) -> Iterator[Finding]:
    """All lines of a file have one, as a rule: the first is told."""
    if "*" not in text:
        return
    summed = [line for line, raw in enumerate(lines_of(text), 1) if "*" in re.sub(r"\([^)]*\)?|;.*", "", raw)]
    if summed:
        yield Finding(
            summed[0],
            f"GRBL knows no checksums and halts at an asterisk{_more(len(summed))}",
            "take the asterisks out, with what follows on their lines",
        )


def _bracketed(text: str, judged: Trace) -> Iterator[Finding]:
    if "(" not in text:
        return
    commands = {command.line: command for command in judged.commands if command.code}
    for line, raw in enumerate(lines_of(text), 1):
        body = raw.partition(";")[0] if "(" in raw else ""
        if not body or (command := commands.get(line)) is None:
            continue
        if _LINE_NUMBER.sub("", body, count=1).lstrip().startswith("("):
            yield Finding(
                line,
                f"Marlin takes the line for an unknown command and does nothing at {command.code}, for it begins with a bracket",
                "put the comment behind the command, after a ;",
            )
        elif obeyed := _obeyed(command, " ".join(_BRACKET.findall(body))):
            yield Finding(
                line,
                f"Marlin obeys {obeyed} in the brackets, unless it was built with PAREN_COMMENTS",
                "begin the comment with ;",
            )


def _obeyed(command: Command, comment: str) -> str:
    """The words of a comment that would change the command: with a number, or taking one back that stands before, or flags."""
    code = command.code
    if code not in READ or code in _BARE:
        return ""
    known = WORDS.get(code)
    found = []
    for word in _CAPITAL.finditer(comment):
        letter, number = word[1], word[2]
        if known is not None and letter not in known:
            continue
        if number:
            value = re.match(r"[-+.\d]+", comment[word.start(2) :])
            found.append(letter + (value[0] if value else ""))
        elif letter in command.words or letter in _FLAGS.get(code, ""):
            found.append(letter)
    return " ".join(found)


def _lower(text: str, judged: Trace) -> Iterator[Finding]:
    """A writer of lower case writes all of it so: the first is told, and how many."""
    codes = {command.line: command.code for command in judged.commands if command.code}
    lost = []
    for line, raw in enumerate(lines_of(text), 1):
        body = raw.partition(";")[0]
        if body == body.upper() or line not in codes:
            continue
        body = _BRACKET.sub(" ", body).partition("*")[0].strip()
        part = body if codes[line] in _SPELLED else body[: 1 + len(_number_of(body))]
        if part != part.upper():
            lost.append(line)
    if lost:
        yield Finding(
            lost[0],
            f"Marlin passes over lower case, unless it was built with GCODE_CASE_INSENSITIVE{_more(len(lost))}",
            "write commands and words in capitals",
        )


def _number_of(body: str) -> str:
    found = _LINE_NUMBER.match(body)
    return found[0] if found else ""


def _more(count: int) -> str:
    return f", in {count} lines from here on" if count > 1 else ""
