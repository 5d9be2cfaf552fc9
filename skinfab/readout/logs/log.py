"""Any log as a recording, known by its content; any recording as a log; and a log as the table that a calibration wants."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from skinfab.errors import InputError
from skinfab.readout.frame import Channel, Recording, Stream
from skinfab.readout.logs import bag1, bag2, csv_log, mcap_log
from skinfab.readout.logs.message import FRAME_TOPIC, STREAM_TOPIC, Message, recording_of
from skinfab.readout.logs.standard import STANDARD, Gathered, readable
from skinfab.readout.logs.unpack import MAX_BYTES, Budget, DamagedError
from skinfab.readout.recording_file import MAGIC as RECORDED
from skinfab.readout.recording_file import SUFFIX, read_recording_counted, write_recording
from skinfab.readout.table import Table, read_table

#: What `write_log` writes, by the file's suffix; a bag of ROS 2 is a folder, and its name has none.
WRITERS: dict[str, Callable[[Recording, Path], None]] = {
    ".csv": csv_log.write_csv,
    ".mcap": mcap_log.write_mcap,
    ".bag": bag1.write_bag1,
    "": bag2.write_bag2,
    SUFFIX: lambda recording, path: write_recording(path, recording.stream, recording),
}

#: A recording's text says so in its first line, whatever its version.
_OWN_CSV = csv_log.MARK.partition(":")[0].encode()


@dataclass(frozen=True, eq=False)
class Log:
    """A log that was read.

    Parameters
    ----------
    file : str
        Its name.
    kind : str
        What it is: ``CSV``, ``MCAP``, ``ROS 1 bag``, ``ROS 2 bag``, ``recording``.
    sha256 : str
        Of its bytes; of a folder's files in their order.
    recording : Recording
    notes : tuple of str
        What was cut off, passed over or taken for granted, a sentence each.
    rate_of_times : bool, optional
        Nobody declared the stream's rate: it is made of a table's times, and says nothing that these do not.
    """

    file: str
    kind: str
    sha256: str
    recording: Recording
    notes: tuple[str, ...]
    rate_of_times: bool = False


def read_log(path: str | Path) -> Log:
    """Read a log; its kind is known by what is in it, whatever it is called.

    A file that was cut off gives what is whole, and a note says so. Files that others wrote become a stream whose channels
    are the columns of a CSV file (as `skinfab.readout.table.read_table` reads it), or the numbers of standard ROS messages.

    Raises
    ------
    InputError
        It cannot be read, is of no known kind, is a bomb, or nothing in it is whole; what and where is said.

    Examples
    --------
    >>> import tempfile
    >>> from skinfab.readout.frame import Channel
    >>> made = Recording.of_values(Stream("one", (Channel("U", "V"),), 100.0), np.ones((3, 1)), device_time=np.arange(3) / 100)
    >>> path = Path(tempfile.mkdtemp()) / "a.mcap"
    >>> write_log(made, path)
    >>> log = read_log(path)
    >>> log.kind, len(log.recording), log.recording.stream == made.stream
    ('MCAP', 3, True)
    """
    path = Path(path)
    try:
        kind, read = _kind(path)
        recording, notes = read(path)
        return Log(path.name, kind, _sha256(path), recording, tuple(notes), read is _foreign_csv)
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror or fault}; give a log") from fault
    except InputError as fault:
        raise fault if str(path) in str(fault) else InputError(f"{path}: {fault}") from fault


def write_log(recording: Recording, path: str | Path) -> None:
    """Write a log, of the kind that the suffix says: .csv, .mcap, .bag (ROS 1), .frames, or none for a ROS 2 bag's folder.

    Raises
    ------
    InputError
        The suffix is another one, or the file cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() not in WRITERS:
        raise InputError(f"cannot write {path}: {path.suffix} is no log; call it .csv, .mcap, .bag or {SUFFIX}, or a folder for ROS 2")
    WRITERS[path.suffix.lower()](recording, path)


def read_log_table(path: str | Path) -> tuple[Table, tuple[str, ...]]:
    """Read a log as a table, as `calibration.strain.prepare` wants it, and what is to be said of it.

    A CSV file that another program wrote is read by `read_table` as it is; all else by `read_log` and `table_of`.

    Raises
    ------
    InputError
        As `read_log`.
    """
    path = Path(path)
    try:
        foreign = _kind(path)[1] is _foreign_csv
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror or fault}; give a log") from fault
    if foreign:
        table = read_table(path)
        return replace(table, units=_said(dict(zip(table.columns, map(_unit, table.columns), strict=True)))), ()
    log = read_log(path)
    return table_of(log), log.notes


def table_of(log: Log) -> Table:
    """A recording as a table: NaN where a reading is not valid or saturated, which is none; angles in rad as degrees.

    Frames without a time are left out; the time is the device's, from the first frame on.

    Raises
    ------
    InputError
        There is no frame with a time.
    """
    made = log.recording
    timed = np.isfinite(made.device_time)
    if not timed.any():
        raise InputError(f"{log.file} has no frame with a time; record something first")
    columns = {}
    for k, channel in enumerate(made.stream.channels):
        readings = np.where(made.valid[:, k] & ~made.saturated[:, k], made.values[:, k], np.nan)[timed]
        with np.errstate(over="ignore"):  # of a damaged file; infinite is no number to a calibration either
            columns[channel.name] = np.degrees(readings) if channel.unit == "rad" else readings
    time = made.device_time[timed]
    units = _said({channel.name: "deg" if channel.unit == "rad" else channel.unit for channel in made.stream.channels})
    remarks = {"simulated": "true"} if made.stream.simulated else {}
    return Table(log.file, log.sha256, time - time[0], columns, remarks, units=units)


def _said(units: dict[str, str]) -> dict[str, str]:
    return {name: unit for name, unit in units.items() if unit}


Read = Callable[[Path], tuple[Recording, list[str]]]


def _kind(path: Path) -> tuple[str, Read]:
    """What a file is, and what reads it."""
    if path.is_dir():
        return "ROS 2 bag", lambda p: _of_messages(p, lambda budget: bag2.bag2_messages(p, budget), sum(_sizes(p)))
    if path.exists() and not path.is_file():
        raise InputError(f"{path} is a device or a pipe; give a log, or record it with skinfab record")
    with path.open("rb") as file:
        head = file.read(64)
    size = path.stat().st_size
    if size > MAX_BYTES:
        raise InputError(f"{path} has {size / 1e9:.1f} GB; cut it into logs of less than {MAX_BYTES / 1e9:g} GB")
    if head.startswith(mcap_log.MAGIC):
        return "MCAP", lambda p: _of_messages(p, lambda budget: mcap_log.mcap_messages(p, budget), size)
    if head.startswith(bag1.MAGIC):
        return "ROS 1 bag", lambda p: _of_messages(p, lambda budget: bag1.bag1_messages(p, budget), size)
    if head.startswith(bag2.SQLITE):
        return "ROS 2 bag", lambda p: _of_messages(p, lambda budget: bag2.sqlite_messages(p, budget), size)
    if head.startswith(RECORDED[:-2]):
        return "recording", _recorded
    if head.startswith(_OWN_CSV):
        if not head.startswith(csv_log.MARK.encode()):
            raise InputError(f"{path} was made by a later skinfab, or is damaged in its first line; update skinfab")
        return "CSV", csv_log.read_csv
    return "CSV", _foreign_csv


def _sizes(folder: Path) -> Iterator[int]:
    return (file.stat().st_size for file in bag2.bag_files(folder))


def _recorded(path: Path) -> tuple[Recording, list[str]]:
    recording, counts = read_recording_counted(path)
    with path.open("rb") as file:
        file.seek(-1, 2)
        cut = file.read(1) != b"\0"  # what ends every packet
    notes = []
    if counts.bad or cut:
        what = " and ".join([f"{counts.bad:,} packets in it are damaged"] * bool(counts.bad) + ["its last packet is cut off"] * cut)
        notes.append(f"{path.name}: {what}; the {len(recording):,} frames given are whole")
    return recording, notes


def _of_messages(path: Path, scan: Callable[[Budget], Iterator[Message]], size: int) -> tuple[Recording, list[str]]:
    """A recording from messages: our own where there is one, else all standard ones."""
    own: list[Message] = []
    gathered = Gathered()
    others: dict[str, str] = {}
    damage = ""
    try:
        for message in scan(Budget(size)):
            if message.topic in (STREAM_TOPIC, FRAME_TOPIC):
                own.append(message)
            elif readable(message):
                gathered.add(message)
            else:
                others[message.topic] = f"{message.topic} ({message.type})"
    except DamagedError as fault:
        damage = str(fault)
    notes: list[str] = []
    if any(message.topic == STREAM_TOPIC for message in own):
        recording = recording_of(own)
        others |= gathered.topics
    elif len(gathered):
        recording, notes = gathered.recording(path.stem)
    elif damage:
        raise InputError(f"{path} is cut off or damaged, and nothing in it is whole: {damage}; take another copy")
    else:
        known = ", ".join(sorted({name.split("/")[-1] for name in STANDARD}))
        raise InputError(f"{path} has no topic that can be read: {', '.join(others.values()) or 'none at all'}; these types can: {known}")
    if path.is_dir() and len(files := bag2.bag_files(path)) > 1 and not (path / "metadata.yaml").is_file():
        notes.append(f"{path.name} has no metadata.yaml: {', '.join(file.name for file in files)} were read as the parts of one bag")
    if others:
        notes.append(f"{path.name}: passed over {', '.join(others.values())}")
    if damage:
        notes.append(f"{path.name} is cut off or damaged: {damage}; the {len(recording):,} frames before that are whole")
    return recording, notes


def _foreign_csv(path: Path) -> tuple[Recording, list[str]]:
    table = read_table(path)
    step = float(np.median(np.diff(table.time))) if len(table.time) > 1 else 0.0
    channels = tuple(Channel(name or "column", _unit(name)) for name in table.columns)
    stream = Stream(path.stem, channels, round(1 / step, 3) if step > 0 else 0.0, table.simulated)
    return Recording.of_values(stream, np.column_stack(list(table.columns.values())), device_time=table.time), []


def _unit(heading: str) -> str:
    """The unit in a heading's brackets.

    Examples
    --------
    >>> _unit("Channel 0 (pF)"), _unit("angle [deg]"), _unit("S1")
    ('pF', 'deg', '')
    """
    match = re.search(r"[\[(]([^\])]*)[\])]\s*$", heading)
    return match[1].strip() if match else ""


def _sha256(path: Path) -> str:
    total = hashlib.sha256()
    for each in bag2.bag_files(path) if path.is_dir() else [path]:
        with each.open("rb") as file:
            while block := file.read(1 << 20):
                total.update(block)
    return total.hexdigest()
