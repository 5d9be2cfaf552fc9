"""Recordings as CSV: remarks, a line of headings, and a line a frame, so that any spreadsheet opens them and nothing is lost.

Numbers are written in the shortest form that gives the same number back. The last column, ``state``, has a character for
each channel: ``.`` for a plain value, ``s`` saturated, ``x`` not valid, ``b`` both.
"""

from __future__ import annotations

import csv
import io
import math
import re
import struct
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinfab.errors import InputError
from skinfab.files import atomic_path
from skinfab.readout.description import stream_of_json, stream_to_json
from skinfab.readout.frame import Frame, Recording, Stream

#: How our own files begin.
MARK = "# skinfab recording: 1"
_BEFORE, _AFTER = ("device_time", "host_time", "sequence"), ("state",)
_STATES = ".sxb"


def write_csv(recording: Recording, path: str | Path) -> None:
    """Write a recording.

    Raises
    ------
    InputError
        The file cannot be written, or a channel's name is no text that a file can hold.
    """
    stream = recording.stream
    states = np.array(list(_STATES))[recording.saturated + 2 * ~recording.valid]
    try:
        head = csv_head(stream)
    except InputError as fault:
        raise InputError(f"{path}: {fault}") from fault
    with atomic_path(path) as partial, partial.open("w", encoding="utf-8", newline="") as file:
        file.write(head)
        rows = csv.writer(file, lineterminator="\n")
        columns = (recording.device_time.tolist(), recording.host_time.tolist(), recording.sequence.tolist(), recording.values.tolist())
        for device, host, sequence, values, state in zip(*columns, states.tolist(), strict=True):
            rows.writerow([*map(_cell, (device, host)), sequence, *map(_cell, values), "".join(state)])


def csv_head(stream: Stream) -> str:
    """The remarks and headings that a recording of this stream begins with.

    Raises
    ------
    InputError
        A channel's name is no text that a file can hold.
    """
    text = io.StringIO()
    text.write(f"{MARK}\n# simulated: {'true' if stream.simulated else 'false'}\n# stream: {stream_to_json(stream)}\n")
    # A bare carriage return is not quoted of itself, and would be read as the end of the line.
    all_quoted = any("\r" in name for name in stream.names)
    quoted = csv.writer(text, lineterminator="\n", quoting=csv.QUOTE_ALL if all_quoted else csv.QUOTE_MINIMAL)
    try:
        quoted.writerow([*_BEFORE, *stream.names, *_AFTER])
        text.getvalue().encode()
    except (UnicodeEncodeError, csv.Error) as fault:
        raise InputError(f"a channel's name cannot be written ({fault}); rename it") from fault
    return text.getvalue()


def csv_line(frame: Frame) -> str:
    """The line of one frame, as `write_csv` writes it.

    Examples
    --------
    >>> csv_line(Frame(0.01, 5.0, 7, np.array([0.5, np.nan]), np.array([True, False]), np.array([False, False])))
    '0.01,5.0,7,0.5,nan,.x\\n'
    """
    state = "".join(_STATES[s + 2 * (not v)] for s, v in zip(frame.saturated.tolist(), frame.valid.tolist(), strict=True))
    cells = [_cell(frame.device_time), _cell(frame.host_time), str(frame.sequence), *map(_cell, frame.values.tolist()), state]
    return ",".join(cells) + "\n"


def _cell(number: float) -> str:
    """The shortest form that gives the same number; a NaN that is not the usual one with all its bits, as C writes it.

    Examples
    --------
    >>> _cell(0.1), _cell(-0.0), _cell(float("nan")), _cell(-float("nan"))
    ('0.1', '-0.0', 'nan', 'nan(0xfff8000000000000)')
    """
    if number == number:
        return repr(number)
    bits = struct.unpack("<Q", struct.pack("<d", number))[0]
    return "nan" if bits == _USUAL_NAN else f"nan({bits:#x})"


_USUAL_NAN = struct.unpack("<Q", struct.pack("<d", math.nan))[0]
_ODD_NAN = re.compile(r"nan\((0x[0-9a-f]{1,16})\)")


def read_csv(path: Path) -> tuple[Recording, list[str]]:
    """A recording that `write_csv` wrote, and what is to be said of it.

    Raises
    ------
    InputError
        The head is cut off or damaged, or a line in the middle is; which one is said.
    """
    try:
        with path.open(encoding="utf-8", newline="") as file:
            stream = _head(file, path)
            rows = csv.reader(file, strict=True)
            if next(rows, None) != [*_BEFORE, *stream.names, *_AFTER]:
                raise InputError(f"{path}: the headings are not those of the stream that is described above them; mend them")
            return _body(rows, stream, path)
    except UnicodeDecodeError as fault:
        raise InputError(f"{path} is damaged: no text at byte {fault.start}; take another copy") from fault
    except csv.Error as fault:
        raise InputError(f"{path} is damaged: {fault}; take another copy") from fault


def _head(lines: Iterator[str], path: Path) -> Stream:
    next(lines)
    for line in lines:
        name, _, value = line.lstrip("# ").partition(": ")
        if name == "stream":
            return stream_of_json(value)
        if not line.startswith("#"):
            break
    raise InputError(f"{path} was cut off or changed before its stream was described; take another copy")


def _body(rows: Iterator[list[str]], stream: Stream, path: Path) -> tuple[Recording, list[str]]:
    width = len(stream.channels) + 4
    whole: list[list[str]] = []
    cut: list[str] | None = None
    for row in rows:
        if cut is not None:  # only the last line may have been cut off
            raise InputError(
                f"{path}, frame {len(whole) + 1}: {len(cut)} cells where there must be {width}, or no full state; mend the line"
            )
        if len(row) == width and len(row[-1]) == width - 4:
            whole.append(row)
        else:
            cut = row
    notes = [] if cut is None else [f"{path.name} was cut off within frame {len(whole) + 1}; the {len(whole):,} before it are whole"]
    numbers = np.empty((len(whole), width - 2))
    for k in (0, 1, *range(3, width - 1)):
        numbers[:, k - (k > 2)] = _column([row[k] for row in whole], f"{path}, column {[*_BEFORE, *stream.names][k]!r}")
    states = np.array([[_STATES.find(each) for each in row[-1]] for row in whole], dtype=int).reshape(len(whole), width - 4)
    if np.any(states < 0):
        raise InputError(
            f"{path}, frame {int(np.argmax((states < 0).any(axis=1))) + 1}: the state has a character other than {_STATES}; mend it"
        )
    try:
        sequence = np.array([int(row[2]) for row in whole], dtype=np.int64)
    except (ValueError, OverflowError) as fault:
        raise InputError(f"{path}: a sequence is no whole number ({fault}); mend it") from fault
    recording = Recording(
        stream, numbers[:, 0].copy(), numbers[:, 1].copy(), sequence, numbers[:, 2:].copy(), states < 2, (states & 1).astype(bool)
    )
    return recording, notes


def _column(cells: list[str], where: str) -> NDArray[np.float64]:
    try:
        return np.array(cells, dtype=float)
    except ValueError:
        pass
    out = np.empty(len(cells))
    for k, cell in enumerate(cells):
        if match := _ODD_NAN.fullmatch(cell):
            out[k : k + 1] = np.array([int(match[1], 16)], dtype=np.uint64).view(np.float64)
            continue
        try:
            out[k] = float(cell)
        except ValueError:
            raise InputError(f"{where}, frame {k + 1}: {cell!r} is no number; mend it") from None
    return out
