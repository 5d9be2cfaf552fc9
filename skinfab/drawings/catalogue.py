"""What there is to choose from: every pattern with its parameters, in words that are those of its class."""

from __future__ import annotations

import inspect
import re
import textwrap
from dataclasses import MISSING, dataclass, fields

from skinfab.patterns.base import Pattern
from skinfab.patterns.registry import PATTERNS, make_pattern


@dataclass(frozen=True)
class Entry:
    """A pattern in words.

    Parameters
    ----------
    kind : str
    senses : str
        "contact" or "strain".
    summary : str
        The first sentence of the class.
    parameters : dict of str to str
        By name, with what a value that need not be given is else; `bead`, `gap` and `pad`, which all have, are left out.
    example : str
        As a sensors file takes it.
    """

    kind: str
    senses: str
    summary: str
    parameters: dict[str, str]
    example: str


def catalogue() -> tuple[Entry, ...]:
    """All patterns, by kind.

    Examples
    --------
    >>> [entry.kind for entry in catalogue()][:2]
    ['contact-spiral', 'strain-lines']
    """
    return tuple(_entry(cls) for cls in PATTERNS.values())


def as_text() -> str:
    """The catalogue for a terminal."""
    blocks = []
    for entry in catalogue():
        lines = [f"{entry.kind} ({entry.senses}): {entry.summary}"]
        for name, text in entry.parameters.items():
            lines += textwrap.wrap(text, 110, initial_indent=f"  {name:<6}", subsequent_indent=" " * 8)
        blocks.append("\n".join([*lines, f"  e.g.  {entry.example}\n"]))
    return "\n".join(blocks)


def as_markdown(*, pictures: str) -> str:
    """The catalogue for the docs, a picture with each; `pictures` is their folder as seen from the page."""
    blocks = []
    for entry in catalogue():
        rows = "\n".join(f"| `{name}` | {text.replace('|', chr(92) + '|')} |" for name, text in entry.parameters.items())
        blocks.append(
            f"### `{entry.kind}`\n\n{entry.summary} Senses {entry.senses}.\n\n"
            f"![{entry.kind} with its parameters]({pictures}/pattern-{entry.kind}.svg)\n\n"
            f"| parameter | meaning |\n|---|---|\n{rows}\n\nThe picture: `params = {entry.example}`.\n"
        )
    return "\n".join(blocks)


def _entry(cls: type[Pattern]) -> Entry:
    text = inspect.getdoc(cls) or ""
    summary = " ".join(text.split("\n\n")[0].split())
    described = _described(text)
    common = {f.name for f in fields(Pattern)}
    own = {}
    for field in fields(cls):
        if field.name not in common:
            default = "" if field.default is MISSING else f" Unless given: {str(field.default).lower()}."
            own[field.name] = f"{described.get(field.name, field.name)}{default}"
    shown = make_pattern(cls.kind, cls.example)
    example = ", ".join(f"{name} = {getattr(shown, name):g}" for name in cls.example)
    return Entry(cls.kind, cls.senses, summary, own, f"{{ {example} }}")


def _described(docstring: str) -> dict[str, str]:
    """The parameters section of a numpydoc docstring, a sentence or two by name."""
    section = re.search(r"^Parameters\n-+\n(.*?)(?=\n\n\S|\Z)", docstring, re.S | re.M)
    entries = re.findall(r"^(\S+) : [^\n]*\n((?:    [^\n]*\n?)+)", section[1] if section else "", re.M)
    return {name: " ".join(text.split()) for name, text in entries}
