"""What there is to choose from: every pattern with its parameters, in words that are those of its class."""

from __future__ import annotations

import inspect
import re
import textwrap
from collections.abc import Mapping
from dataclasses import MISSING, asdict, dataclass, fields
from typing import Any

from skinfab.patterns.base import Pattern
from skinfab.patterns.registry import PATTERNS, make_pattern

#: What a parameter is measured in, by the type of its field.
_UNITS = {"float": "mm", "int": "count", "bool": "switch"}


@dataclass(frozen=True)
class Parameter:
    """A pattern's parameter in words.

    Parameters
    ----------
    name : str
    unit : str
        "mm", "count" or "switch".
    required : bool
    default : float, int, bool or str or None
        What it is unless given: a value, or how it follows from the others; None where it is required.
    meaning : str
    bounds : str
    """

    name: str
    unit: str
    required: bool
    default: float | str | None
    meaning: str
    bounds: str


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
    parameters : tuple of Parameter
        Its own; `common` has those that all have.
    example : dict of str to number
        Parameters of the picture, as a sensors file takes them.
    least : dict of str to number
        Of these the ones that cannot be left out.
    """

    kind: str
    senses: str
    summary: str
    parameters: tuple[Parameter, ...]
    example: dict[str, float]
    least: dict[str, float]


def catalogue() -> tuple[Entry, ...]:
    """All patterns, by kind.

    Examples
    --------
    >>> [entry.kind for entry in catalogue()][:2]
    ['contact-spiral', 'strain-lines']
    """
    return tuple(_entry(cls) for cls in PATTERNS.values())


def common() -> tuple[Parameter, ...]:
    """The parameters that every pattern has; the values are those of the bundled material.

    Examples
    --------
    >>> [(p.name, p.unit, p.default) for p in common()]
    [('bead', 'mm', 0.785), ('gap', 'mm', 0.6), ('pad', 'mm', 3.0)]
    """
    described = _described(inspect.getdoc(Pattern) or "")
    return tuple(_parameter(field, described, required=False) for field in fields(Pattern))


def as_json() -> dict[str, Any]:
    """The catalogue for scripts."""
    return {"patterns": [asdict(entry) for entry in catalogue()], "common": [asdict(parameter) for parameter in common()]}


def as_text() -> str:
    """The catalogue for a terminal."""
    blocks = []
    for entry in catalogue():
        lines = [f"{entry.kind} ({entry.senses}): {entry.summary}", *_rows(entry.parameters)]
        lines += [f"  the least to give:  params = {_toml(entry.least)}", f"  all of it, e.g.:    params = {_toml(entry.example)}\n"]
        blocks.append("\n".join(lines))
    return "\n".join([*blocks, "all of them, from the material unless given:", *_rows(common()), ""])


def as_markdown(*, pictures: str) -> str:
    """The catalogue for the docs, a picture with each; `pictures` is their folder as seen from the page."""
    blocks = []
    for entry in catalogue():
        rows = "\n".join(
            "| " + " | ".join(_cell(text) for text in (f"`{p.name}`", p.unit, p.meaning, p.bounds, _default(p))) + " |"
            for p in entry.parameters
        )
        blocks.append(
            f"### `{entry.kind}`\n\n{entry.summary} Senses {entry.senses}.\n\n"
            f"![{entry.kind} with its parameters]({pictures}/pattern-{entry.kind}.svg)\n\n"
            f"| parameter | unit | meaning | bounds | unless given |\n|---|---|---|---|---|\n{rows}\n\n"
            f"The least to give: `params = {_toml(entry.least)}`. The picture: `params = {_toml(entry.example)}`.\n"
        )
    return "\n".join(blocks)


def _entry(cls: type[Pattern]) -> Entry:
    summary = " ".join((inspect.getdoc(cls) or "").split("\n\n")[0].split())
    described = _described(inspect.getdoc(cls) or "")
    shared = {f.name for f in fields(Pattern)}
    own = tuple(_parameter(field, described, required=field.name in cls.required()) for field in fields(cls) if field.name not in shared)
    shown = make_pattern(cls.kind, cls.example)
    example = {name: getattr(shown, name) for name in cls.example}
    return Entry(cls.kind, cls.senses, summary, own, example, {name: getattr(shown, name) for name in cls.required()})


def _parameter(field: Any, described: Mapping[str, str], *, required: bool) -> Parameter:
    """A field with what its class says of it: "Meaning; bounds. Unless given: what then."."""
    text, _, follows = described.get(field.name, field.name).partition(" Unless given: ")
    meaning, _, bounds = text.removesuffix(".").partition("; ")
    default = field.default if field.default is not MISSING else None if required else follows.removesuffix(".")
    return Parameter(field.name, _UNITS[field.type], required, default, meaning, bounds)


def _rows(parameters: tuple[Parameter, ...]) -> list[str]:
    lines = []
    for p in parameters:
        text = f"{p.meaning}; {p.bounds}. " + ("Must be given." if p.required else f"Unless given: {_default(p)}.")
        lines += textwrap.wrap(text, 110, initial_indent=f"  {p.name:<6}{p.unit:<8}", subsequent_indent=" " * 16)
    return lines


def _default(parameter: Parameter) -> str:
    default = parameter.default
    if isinstance(default, str):
        return default
    return "must be given" if default is None else str(default).lower() if isinstance(default, bool) else f"{default:g}"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _toml(values: Mapping[str, float]) -> str:
    return "{ " + ", ".join(f"{name} = {value:g}" for name, value in values.items()) + " }"


def _described(docstring: str) -> dict[str, str]:
    """The parameters section of a numpydoc docstring, a sentence or two by name."""
    section = re.search(r"^Parameters\n-+\n(.*?)(?=\n\n\S|\Z)", docstring, re.S | re.M)
    entries = re.findall(r"^(\S+) : [^\n]*\n((?:    [^\n]*\n?)+)", section[1] if section else "", re.M)
    return {name: " ".join(text.split()) for name, text in entries}
