"""The two ways a command can fail; each message says what, where and what to do."""

from __future__ import annotations


class SkinfabError(Exception):
    """Base of every error a user is meant to read: one line, no traceback."""

    exit_status = 1


class InputError(SkinfabError, ValueError):
    """The input cannot be used (exit status 1)."""


class RefusedError(SkinfabError):
    """A result failed its own checks and was not written (exit status 3)."""

    exit_status = 3
