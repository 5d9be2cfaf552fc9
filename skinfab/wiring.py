"""The wiring table: which wire comes from which pad and goes to which input of which multiplexer board.

The readout of "Soft Sensing Skins for Arbitrary Objects", section II.C: bridges, then analog multiplexers with 16
inputs each. A sensor's channel is kept in the skin document, so the same document gives the same table.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from pathlib import Path

from skinfab.electrical import resistance
from skinfab.errors import InputError
from skinfab.files import atomic_write
from skinfab.material import Material
from skinfab.skin import Skin

#: Inputs of one multiplexer board, counted from 0 as they are printed on it (C0 to C15); boards are counted from 1.
BOARD_INPUTS = 16

#: A table larger than this is none of ours.
TABLE_MAX_BYTES = 4_000_000

_LEADS = {1: "signal", 2: "return"}


@dataclass(frozen=True)
class Wire:
    """One wire, a row of the table.

    Parameters
    ----------
    wire : str
        What its label says: sensor and terminal.
    sensor, kind, piece : str
    terminal : 1 or 2
        Where the conductor starts, or where it ends.
    lead : "signal" or "return"
        To the bridge of this channel, or to what all bridges share.
    x_mm, y_mm : float
        The terminal in the piece frame.
    channel : int
        Counted from 0 over the whole skin: the column of the readout's frames.
    board, board_input : int
        Multiplexer board from 1, and its input from 0.
    unit : str
        Of what the channel measures.
    low, median, high : float
        Its predicted resistance at rest, see `skinfab.electrical.Resistance`.

    Examples
    --------
    >>> Wire("C1-1", "C1", "contact-spiral", "P1", 1, "signal", 2.0, 3.0, 17, 2, 1, "kohm", 49.0, 154.0, 487.0).board
    2
    """

    wire: str
    sensor: str
    kind: str
    piece: str
    terminal: int
    lead: str
    x_mm: float
    y_mm: float
    channel: int
    board: int
    board_input: int
    unit: str
    low: float
    median: float
    high: float


def board_of(channel: int) -> tuple[int, int]:
    """Board, from 1, and its input, from 0, of a channel counted from 0.

    Examples
    --------
    >>> board_of(0), board_of(15), board_of(16)
    ((1, 0), (1, 15), (2, 0))
    """
    return channel // BOARD_INPUTS + 1, channel % BOARD_INPUTS


def wiring(skin: Skin, material: Material) -> tuple[Wire, ...]:
    """The table of a skin, by channel and terminal.

    Raises
    ------
    InputError
        Two sensors have the same channel.
    """
    wires = []
    for sensor in sorted(skin.sensors, key=lambda s: s.channel):
        r = resistance(sensor.path.length, material.ink)
        low, median, high = (round(each, 3) for each in (r.low, r.median, r.high))
        for terminal, (x, y) in ((1, sensor.path.start), (2, sensor.path.end)):
            name, at = f"{sensor.id}-{terminal}", (round(float(x), 3) + 0.0, round(float(y), 3) + 0.0)
            where = (sensor.channel, *board_of(sensor.channel))
            kind = sensor.pattern.kind
            wires.append(Wire(name, sensor.id, kind, sensor.piece, terminal, _LEADS[terminal], *at, *where, "kohm", low, median, high))
    _require_sound(wires, "this skin's wiring")
    return tuple(wires)


def write_wiring(wires: Iterable[Wire], path: str | Path) -> None:
    """Write the table as CSV with a line of headings: the fields of `Wire`."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    names = [f.name for f in fields(Wire)]
    table.writerow(names)
    table.writerows([getattr(wire, name) for name in names] for wire in wires)
    atomic_write(path, text.getvalue())


def read_wiring(path: str | Path) -> tuple[Wire, ...]:
    """Read a table back, as a readout does that has to know which channel is which sensor.

    Columns may stand in another order, and others may be added; rows may be in any order.

    Raises
    ------
    InputError
        The file cannot be read or is no such table: a column is missing, a value is not what it must be, a wire is
        there twice, a terminal or a sensor's second wire is missing, two sensors share a channel, or a channel is not
        the one its board and input say.
    """
    path = Path(path)
    try:
        if path.stat().st_size > TABLE_MAX_BYTES:
            raise InputError(
                f"{path} has {path.stat().st_size / 1e6:.0f} MB; a wiring table is far smaller, so give the wiring.csv of a skin"
            )
        rows = list(csv.reader(path.read_text(encoding="utf-8-sig").splitlines(), strict=True))
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror or fault}; give the wiring.csv that skinfab make wrote") from fault
    except (UnicodeDecodeError, csv.Error) as fault:
        raise InputError(f"{path} is not a CSV file: {fault}; give the wiring.csv that skinfab make wrote") from fault
    head = [name.strip() for name in rows[0]] if rows else []
    if missing := [f.name for f in fields(Wire) if f.name not in head]:
        raise InputError(f"{path}: there is no column {missing[0]!r}; a wiring table begins with a line of headings")
    wires = [_row(head, row, f"{path}, line {number}") for number, row in enumerate(rows[1:], start=2) if row]
    wires.sort(key=lambda wire: (wire.channel, wire.terminal))
    _require_sound(wires, str(path))
    return tuple(wires)


def _row(head: Sequence[str], row: Sequence[str], where: str) -> Wire:
    if len(row) != len(head):
        raise InputError(f"{where}: {len(row)} values under {len(head)} headings; mend the line")
    cells = dict(zip(head, row, strict=True))
    values: dict[str, str | int | float] = {}
    for field in fields(Wire):
        text = cells[field.name].strip()
        try:
            value: str | int | float = {"str": str, "int": int, "float": float}[str(field.type)](text)
        except ValueError:
            value = math.nan
        if value == "" or (isinstance(value, float) and not math.isfinite(value)):
            wanted = {"str": "a name", "int": "a whole number", "float": "a number"}[str(field.type)]
            raise InputError(f"{where}: {field.name} is {text!r}; it must be {wanted}")
        values[field.name] = value
    return Wire(**values)  # type: ignore[arg-type]  # each has its field's type, by the loop


def _require_sound(wires: Sequence[Wire], where: str) -> None:
    """Each channel has one sensor with its two wires, and is where board and input say."""
    by_channel: dict[int, list[Wire]] = {}
    for wire in wires:
        if wire.channel < 0 or board_of(wire.channel) != (wire.board, wire.board_input):
            raise InputError(
                f"{where}: wire {wire.wire} has channel {wire.channel}, but board {wire.board} input {wire.board_input} "
                f"is channel {(wire.board - 1) * BOARD_INPUTS + wire.board_input}; mend one of them"
            )
        by_channel.setdefault(wire.channel, []).append(wire)
    for channel, pair in by_channel.items():
        if len({wire.sensor for wire in pair}) > 1:
            names = " and ".join(sorted({wire.sensor for wire in pair}))
            raise InputError(f"{where}: channel {channel} is given to {names}; give each sensor a channel of its own")
        if sorted(wire.terminal for wire in pair) != [1, 2]:
            has = ", ".join(str(wire.terminal) for wire in pair)
            raise InputError(f"{where}: sensor {pair[0].sensor} has a wire at terminal {has}; it needs one at 1 and one at 2")
    if len({wire.sensor for wire in wires}) < len(by_channel):
        raise InputError(f"{where}: a sensor has more than one channel; each has one")
