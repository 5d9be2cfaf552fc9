"""Bytes that parsers do not expect: what searches have found to hurt one, tried on all, and whole files hit at random."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

_DEEP = 20_000
_DIGITS = b"9" * 5000  # Python converts no more than 4300

#: Of no kind at all.
ANYWHERE = (
    *(b"", b"\0", b"\xff" * 1000, b"\n" * _DEEP, b"\r" * 100, b" " * _DEEP, b"9" * _DEEP, b"-" * _DEEP, b"1," * _DEEP, b'"'),
    *(b"a" * (1 << 20), b"\xef\xbb\xbf", b"\xff\xfea", b"\xed\xa0\x80"),
)

#: By the suffix of the files that a parser reads.
NESTED = {
    ".toml": (
        *(b"a = " + b"[" * _DEEP, b"a = " + b"[" * _DEEP + b"]" * _DEEP, b"a = " + b"{a=" * _DEEP, b"a = " + _DIGITS),
        *(b".".join([b"a"] * 2000) + b" = 1", b"[" + b".".join([b"a"] * 2000) + b"]", b"a = 2026-99-99", b"\xff\xfe"),
        *(
            name + b" = 1\n"
            for name in (b"extends", b"name", b"ink", b"layers", b"mould", b"bed", b"sensor", b"auto", b"meshes", b"settings")
        ),
        *(name + b" = [1]\n" for name in (b"layers", b"sensor", b"meshes", b"bed")),
        *(b'extends = "' + name + b'"' for name in (b"a\\u0000b.toml", b"x" * 5000 + b".toml", b"..", b"", b"a\\u0000")),
        *(b'meshes = ["' + name + b'"]' for name in (b"a\\u0000", b"x" * 5000, b"..", b"", b"**", b"/", b"[")),
    ),
    ".json": (b"[" * _DEEP, b'{"a":' * _DEEP, b'{"schema": ' + _DIGITS + b"}", b"null", b"[]", b"{}", b'{"schema": 1e999}', b'"\\ud800"'),
}

_NUMBERS = (_DIGITS, b"9" * 400, b"1e400", b"-1", b"nan", b"inf", b"0", b"1e308", b"1e-320", b"9223372036854775808", b"1_0", b"x", b"")
_VALUES = (*_NUMBERS[:-2], b"true", b'"x"', b"[]", b"{}", b"null")
_STRINGS = (b'"\\u0000"', b'"\\ud800"', b"1", b"[]", b"{}", b"null", b'"a\\nb"', b'""', b'"' + b"x" * 5000 + b'"', b'"../x"')


def hostile(seeds: list[bytes], suffix: str) -> Iterator[bytes]:
    """What is never right, and whole files with one number or text replaced."""
    yield from ANYWHERE
    yield from NESTED.get(suffix, ())
    structured = suffix in NESTED
    for seed in seeds:
        places = [(m, _VALUES if structured else _NUMBERS) for m in re.finditer(rb"-?\d+\.?\d*(?:e-?\d+)?", seed)]
        places += [(m, _STRINGS) for m in re.finditer(rb'"[^"\n]*"', seed)] * structured
        for match, instead in places:
            for each in instead:
                yield seed[: match.start()] + each + seed[match.end() :]


def mutants(seed: bytes, rng: np.random.Generator, count: int) -> Iterator[bytes]:
    """A whole file with a few places hit: bytes changed, taken out, doubled, or the rest cut off."""
    for _ in range(count):
        broken = bytearray(seed)
        for _ in range(int(rng.integers(1, 4))):
            at, length = int(rng.integers(0, len(broken) + 1)), int(rng.integers(1, 9))
            match int(rng.integers(0, 5)):
                case 0:
                    broken[at : at + length] = rng.bytes(length)
                case 1:
                    del broken[at : at + length]
                case 2:
                    broken[at:at] = broken[at : at + length] * int(rng.integers(1, 50))
                case 3:
                    broken[at : at + 1] = b"\xff" if at % 2 else b"\0"
                case _:
                    del broken[at:]
        yield bytes(broken)
