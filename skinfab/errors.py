"""The two ways a command can fail; each message says what, where and what to do."""

from __future__ import annotations

#: A longer sentence quotes what no one reads; its middle is left out.
LONGEST = 1500


class SkinfabError(Exception):
    """Base of every error a user is meant to read: one line, no traceback.

    What it quotes of a file may be anything: lines are joined, what steers a terminal and halves of characters are shown as
    escapes, and of thousands of characters the first and the last.

    Examples
    --------
    >>> str(InputError("no column 'a\\nb\\x1b[2J'")), len(str(InputError("9" * 5000)))
    ("no column 'a b\\\\x1b[2J'", 1500)
    """

    exit_status = 1

    def __str__(self) -> str:
        text = " ".join(line.strip() for line in super().__str__().splitlines())
        if not text.isprintable():
            text = "".join(each if each.isprintable() else repr(each)[1:-1] for each in text)
        if len(text) > LONGEST:
            text = f"{text[: LONGEST // 2 - 5]} ... {text[-LONGEST // 2 :]}"
        return text


class InputError(SkinfabError, ValueError):
    """The input cannot be used (exit status 1)."""


class RefusedError(SkinfabError):
    """A result failed its own checks and was not written (exit status 3)."""

    exit_status = 3
