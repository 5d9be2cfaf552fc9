"""ROS 2 bags: a folder of MCAP or SQLite files beside a metadata.yaml, or one such file alone.

The files are read themselves, not what metadata.yaml says of them: a bag whose recorder was killed has none.
"""

from __future__ import annotations

import re
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from secrets import token_hex
from urllib.parse import quote

from skinfab.errors import InputError
from skinfab.files import explain_os_error
from skinfab.readout.frame import Recording
from skinfab.readout.logs.mcap_log import mcap_messages
from skinfab.readout.logs.message import Message, write_bag
from skinfab.readout.logs.unpack import Budget, DamagedError

SQLITE = b"SQLite format 3\0"

#: No message of a log is longer; a column that is computed could be.
_MAX_MESSAGE = 10_000_000
_MAX_METADATA = 10_000_000
#: What else a folder may hold that is a log by itself.
_LOGS = (".csv", ".bag", ".frames")


def write_bag2(recording: Recording, path: str | Path) -> None:
    """Write a recording as a folder.

    Raises
    ------
    InputError
        The folder is there already, or cannot be written.
    """
    from rosbags.rosbag2 import StoragePlugin, Writer

    path = Path(path)
    if path.exists():
        raise InputError(f"{path} is there already, and a bag is never overwritten; choose another name")
    partial = path.with_name(f".{path.name}.{token_hex(4)}") / path.name  # the files inside are called as their folder
    try:
        partial.parent.mkdir()
        with Writer(partial, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
            write_bag(writer, recording, "cdr")
        partial.rename(path)
    except OSError as fault:
        raise InputError(explain_os_error(fault, path)) from fault
    except sqlite3.Error as fault:
        raise InputError(f"cannot write {path}: {fault}; is the disk full?") from fault
    finally:
        shutil.rmtree(partial.parent, ignore_errors=True)


def bag_files(folder: Path) -> list[Path]:
    """The files of a bag, in their order.

    Raises
    ------
    InputError
        There is none, they are packed as a whole, or they are not of one bag.
    """
    files = sorted(
        (p for p in folder.iterdir() if p.suffix in (".mcap", ".db3") and p.is_file()),
        key=lambda p: [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", p.name)],
    )
    metadata = folder / "metadata.yaml"
    if metadata.is_file() and metadata.stat().st_size <= _MAX_METADATA:
        mode = re.search(rb"^\s*compression_mode:\s*['\"]?(\w+)", metadata.read_bytes(), re.MULTILINE)
        if mode and mode[1].lower() in (b"file", b"message"):
            raise InputError(f"{folder} is a bag packed by {mode[1].decode().lower()}; unpack it with ros2 bag convert")
    if not files:
        one = next((p for p in sorted(folder.iterdir()) if p.suffix.lower() in _LOGS and p.is_file()), None)
        such = f", such as {one}" if one else ""
        raise InputError(f"{folder} is a folder and no ROS 2 bag, as it has no .mcap or .db3 file in it; give one log{such}")
    if not metadata.is_file() and len({re.sub(r"_\d+$", "", p.stem) for p in files}) > 1:
        raise InputError(
            f"{folder} has {len(files)} logs in it, {files[0].name} and {files[1].name} among them, which are not the parts of one bag "
            f"(there is no metadata.yaml, and their names differ); give one of them, such as {files[0]}"
        )
    return files


def bag2_messages(folder: Path, budget: Budget) -> Iterator[Message]:
    """Every message of all files, in their order.

    Raises
    ------
    DamagedError
        From here on a file is cut off or damaged.
    InputError
        There is no file, or one is a bomb.
    """
    for file in bag_files(folder):
        with file.open("rb") as head:
            sqlite = head.read(len(SQLITE)) == SQLITE
        yield from sqlite_messages(file, budget) if sqlite else mcap_messages(file, budget)


def sqlite_messages(path: Path, budget: Budget) -> Iterator[Message]:
    """Every message in the order of a ``.db3`` file, which is opened for reading alone.

    Raises
    ------
    DamagedError
        From here on the file is cut off or damaged.
    InputError
        It is a database of something else.
    """
    with closing(sqlite3.connect(f"file:{quote(str(path.resolve()))}?mode=ro&immutable=1", uri=True)) as base:
        base.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, _MAX_MESSAGE)
        base.text_factory = bytes
        try:
            # Without this a file that was cut off is refused as a whole; with it, up to the first page that is not there.
            base.execute("PRAGMA writable_schema=ON")
            base.execute("PRAGMA trusted_schema=OFF")
            # Views and computed columns can be endless: only plain tables are read.
            tables = {name.decode() for name, kind in base.execute("SELECT name, type FROM sqlite_master") if kind == b"table"}
            if missing := {"topics", "messages"} - tables:
                raise InputError(f"{path} is an SQLite file without the table {min(missing)!r}; a ROS 2 bag has one")
            topics = {
                number: (_text(name), _text(kind), _text(coding))
                for number, name, kind, coding in base.execute("SELECT id, name, type, serialization_format FROM topics")
            }
            for topic, time, data in base.execute("SELECT topic_id, timestamp, data FROM messages ORDER BY id"):
                if topic not in topics or not isinstance(data, bytes) or not isinstance(time, int):
                    raise DamagedError("a message has no topic, no time or no data")
                budget.take(len(data))
                name, kind, coding = topics[topic]
                yield Message(name, kind, coding, time, data)
        except (sqlite3.Error, UnicodeDecodeError) as fault:
            raise DamagedError(str(fault)) from fault


def _text(value: object) -> str:
    if not isinstance(value, bytes):
        raise DamagedError(f"{value!r} stands where a name should")
    return value.decode()
