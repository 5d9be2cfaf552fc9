"""Decimal text of whole arrays: bytes to numbers and numbers to bytes, with a few passes over all of them instead of a call for each."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_SPACE, _DOT, _MINUS, _ZERO, _NINE = 32, 46, 45, 48, 57

#: Significant digits written of the largest number of an array; the others have as many decimals. Fewer than the 15.95 that a double holds.
SIGNIFICANT = 15

# Up to these a double holds the digits and the power of ten exactly, so that one division rounds right (Clinger 1990).
_EXACT, _EXACT_POWER = 2**53, 22
_POWERS = 10.0 ** np.arange(_EXACT_POWER + 1)

# One number in so many may have an exponent before all are read with a scanner that knows them.
_FEW = 32

# An int64 holds this many digits.
_MOST_DIGITS = 18


def words(text: Bytes) -> tuple[IntArray, IntArray]:
    """Where the words of a text start and end (after their last byte); it begins and ends with white space.

    Examples
    --------
    >>> [at.tolist() for at in words(np.frombuffer(b" 1 -2.5\\n", np.uint8))]
    [[1, 3], [2, 7]]
    """
    space = text <= _SPACE
    edges = np.flatnonzero(space[1:] != space[:-1]) + 1
    return edges[0::2], edges[1::2]


def read_ints(text: Bytes, starts: IntArray, ends: IntArray) -> IntArray | None:
    """The whole numbers of a text, (k,), for words as in `read_floats`; None where a word is no whole number."""
    return _scanned(text, np.int64, len(starts)) if _is_digit(text[ends - 1]).all() else None


def read_floats(text: Bytes, starts: IntArray, ends: IntArray) -> FloatArray | None:
    """The numbers of a text, (k,), each the double nearest to what is written.

    Parameters
    ----------
    text : (b,) uint8
        Numbers and white space, with white space first and last.
    starts, ends : (k,) int64
        Its words, as `words` gives them.

    Returns
    -------
    (k,) float64 or None
        None where a word is no number.

    Examples
    --------
    >>> text = np.frombuffer(b" 0.1 -2.5e3 nan\\n", np.uint8)
    >>> read_floats(text, *words(text)).tolist()
    [0.1, -2500.0, nan]
    """
    last = text[ends - 1]
    # The scanner takes a lone sign or dot for a zero.
    if not (_is_digit(last) | ((last == _DOT) & _is_digit(text[ends - 2])) | (last > _NINE)).all():
        return None
    found = _read_fixed(text, starts, ends)
    return _scanned(text, np.float64, len(starts)) if found is None else found


def _is_digit(letters: Bytes) -> NDArray[np.bool_]:
    return (letters >= _ZERO) & (letters <= _NINE)


def _read_fixed(text: Bytes, starts: IntArray, ends: IntArray) -> FloatArray | None:
    """Digits as whole numbers, over powers of ten; the few numbers with an exponent one by one."""
    letters = np.flatnonzero(text > _NINE)
    odd = np.searchsorted(starts, letters, side="right") - 1
    odd = odd[np.diff(odd, prepend=-1) > 0]
    if len(odd) > len(starts) // _FEW:
        return None
    if len(odd):
        inside = np.concatenate([np.arange(starts[k], ends[k]) for k in odd])
        spelt = [text[starts[k] : ends[k]].tobytes() for k in odd]
        text = text.copy()
        text[inside], text[starts[odd]] = _SPACE, _ZERO
    dot = text == _DOT
    at = np.flatnonzero(dot)
    word = np.arange(len(at)) if len(at) == len(starts) else np.searchsorted(starts, at, side="right") - 1
    if ((at < starts[word]) | (at >= ends[word])).any() or (word[1:] == word[:-1]).any():
        return None  # two dots in one word, as a rule
    decimals = np.zeros(len(starts), dtype=np.int64)
    decimals[word] = ends[word] - at - 1
    digits = _scanned(text[~dot], np.int64, len(starts))
    if digits is None or not len(digits) or max(digits.max(), -digits.min()) > _EXACT or decimals.max() > _EXACT_POWER:
        return None
    values: FloatArray = digits / _POWERS[decimals]
    if len(odd):
        found = _scanned(np.frombuffer(b" ".join([*spelt, b""]), np.uint8), np.float64, len(odd))
        if found is None:
            return None
        values[odd] = found
    return values


def _scanned(text: Bytes, kind: type, count: int) -> NDArray[Any] | None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        try:
            values: NDArray[Any] = np.fromstring(text.tobytes(), dtype=kind, sep=" ")
        except (DeprecationWarning, ValueError):
            return None
    return values if len(values) == count else None


def write_rows(head: bytes, rows: FloatArray) -> bytes:
    """One line a row, ``head a b c``, in plain decimals without trailing zeros.

    Parameters
    ----------
    head : bytes
        What each line begins with.
    rows : (n, k) float64
        Finite.

    Returns
    -------
    bytes
        All numbers have the same decimals before the zeros are dropped: as many as give the largest `SIGNIFICANT` digits.
        Exponents are written only where the numbers are too small or too large for that.

    Examples
    --------
    >>> write_rows(b"v", np.array([[1.5, -0.25], [100.0, 1e-9]]))
    b'v 1.5 -0.25\\nv 100 0.000000001\\n'
    """
    largest = float(np.abs(rows).max(initial=0.0))
    decimals = SIGNIFICANT - 1 - int(np.floor(np.log10(largest))) if largest > 0 else 1
    if not 1 <= decimals < _MOST_DIGITS:
        form = head + b" %.15g" * rows.shape[1] + b"\n"
        return (form * len(rows)) % tuple(rows.ravel().tolist())
    value = np.rint(rows.T * _POWERS[decimals]).astype(np.int64)
    whole = max(1, len(str(int(np.abs(value).max(initial=0)))) - decimals)
    return _lines(head, [_fixed(column, whole, decimals) for column in value])


def _fixed(value: IntArray, whole: int, decimals: int) -> Bytes:
    """(n, w) letters of value / 10**decimals, unused places zero."""
    digits = _digits(np.abs(value), whole + decimals)
    out = np.zeros((len(value), 2 + whole + decimals), dtype=np.uint8)
    out[value < 0, 0] = _MINUS
    out[:, 1 : 1 + whole] = digits[:, :whole]
    out[:, 1 + whole] = _DOT
    out[:, 2 + whole :] = digits[:, whole:]
    _drop_leading_zeros(out[:, 1:whole])
    # From the right, as long as some row still has nothing but zeros there.
    blank = np.ones(len(value), dtype=bool)
    for column in range(out.shape[1] - 1, whole + 1, -1):
        blank &= out[:, column] == _ZERO
        if not blank.any():
            return out
        out[:, column] *= ~blank
    out[:, 1 + whole] *= ~blank
    return out


def counts(value: IntArray) -> Bytes:
    """(n, w) letters of whole numbers from 0 on, unused places zero.

    Examples
    --------
    >>> counts(np.array([7, 42])).tolist()
    [[0, 55], [52, 50]]
    """
    out = _digits(value, len(str(int(value.max(initial=0)))))
    _drop_leading_zeros(out[:, :-1])
    return out


def _drop_leading_zeros(digits: Bytes) -> None:
    blank = np.ones(len(digits), dtype=bool)
    for column in range(digits.shape[1]):
        blank &= digits[:, column] == _ZERO
        if not blank.any():
            return
        digits[:, column] *= ~blank


def _digits(value: IntArray, width: int) -> Bytes:
    """(n, width) letters of whole numbers, with leading zeros: four digits at a time from a table."""
    n = np.arange(10_000)
    table = (np.stack([n // 1000, n // 100 % 10, n // 10 % 10, n % 10], axis=1) + _ZERO).astype(np.uint8).view(np.uint32).ravel()
    groups = -(-width // 4)
    out = np.empty((len(value), groups), dtype=np.uint32)
    for k in range(groups - 1, -1, -1):
        value, low = np.divmod(value, 10_000)
        out[:, k] = table[low]
    return out.view(np.uint8)[:, 4 * groups - width :]


def _lines(head: bytes, columns: list[Bytes]) -> bytes:
    n = len(columns[0])
    parts = [np.broadcast_to(np.frombuffer(head, np.uint8), (n, len(head)))]
    for column in columns:
        parts += [np.full((n, 1), _SPACE, np.uint8), column]
    letters = np.hstack([*parts, np.full((n, 1), ord("\n"), np.uint8)]).ravel()
    return letters[letters != 0].tobytes()
