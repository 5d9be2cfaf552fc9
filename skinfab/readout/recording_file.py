"""A recording on disk: packets one behind the other, as over the wire, so that what was cut off anywhere costs one frame.

The file begins with a line that says what it is, then the stream's description, then a packet a frame with both times and
float64 values. Nothing is ever changed once it is written; a reader stops at the last whole packet. See docs/readout.md.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Protocol

import numpy as np

from skinfab.errors import InputError
from skinfab.files import atomic_path
from skinfab.readout.frame import Frame, Recording, Stream
from skinfab.readout.framing import LONGEST, Splitter, unpacked
from skinfab.readout.packets import DESCRIPTION, RECORDED, Layout, kind_of
from skinfab.readout.source import Counts

#: What a recording is called.
SUFFIX = ".frames"
#: The first bytes of the file; a later version of the format has another number.
MAGIC = b"skinfab recording 1\n"

_CHUNK = 1 << 20


class Writable(Protocol):
    """A file open for binary writing."""

    def write(self, data: bytes, /) -> object: ...


def write_header(file: Writable, stream: Stream) -> Layout:
    """Begin a recording; what comes back is what `append` needs.

    Raises
    ------
    InputError
        The stream's description is too long.
    """
    layout = Layout(stream)
    file.write(MAGIC + layout.description)
    return layout


def append(file: Writable, layout: Layout, frame: Frame) -> None:
    """Add a frame: one write, so that a file without a buffer is whole after each.

    Examples
    --------
    >>> import io, tempfile
    >>> from skinfab.readout.frame import Channel
    >>> file = io.BytesIO()
    >>> layout = write_header(file, Stream("one", (Channel("U", "V"),), 100.0))
    >>> append(file, layout, Frame(0.01, 5.0, 1, np.array([0.5]), np.array([True]), np.array([False])))
    >>> path = Path(tempfile.mkdtemp()) / "a.frames"
    >>> _ = path.write_bytes(file.getvalue())
    >>> read_recording(path).values.tolist()
    [[0.5]]
    """
    file.write(layout.recorded_packet(frame))


def write_recording(path: str | Path, stream: Stream, frames: Iterable[Frame]) -> None:
    """Write all at once, whole or not at all."""
    with atomic_path(path) as partial, partial.open("wb") as file:
        layout = write_header(file, stream)
        for frame in frames:
            append(file, layout, frame)


def read_recording(path: str | Path) -> Recording:
    """What is whole in a recording; a last frame that was cut off is left out.

    Raises
    ------
    InputError
        The file cannot be read, is no recording, or was cut off before its first frame's description was complete.
    """
    return read_recording_counted(path)[0]


def read_recording_counted(path: str | Path) -> tuple[Recording, Counts]:
    """As `read_recording`; with how many packets in it were damaged (``bad``) and how many frames are missing (``lost``)."""
    path = Path(path)
    layout: Layout | None = None
    rows, bad = bytearray(), 0
    splitter = Splitter(longest=LONGEST)
    try:
        with path.open("rb") as file:
            if (head := file.read(len(MAGIC))) != MAGIC:
                raise InputError(f"{path} {_what(head)}")
            while data := file.read(_CHUNK):
                for piece in splitter.feed(data):
                    body = unpacked(piece)
                    kind = None if body is None else kind_of(body)
                    if body is not None and kind == DESCRIPTION and layout is None:
                        layout = Layout.of_description(body)
                    elif body is not None and kind == RECORDED and layout is not None and len(body) == layout.size(RECORDED):
                        rows += body
                    else:
                        bad += 1
    except OSError as fault:
        raise InputError(f"{path}: {fault.strerror or fault}; give a recording made by skinfab record") from fault
    if layout is None:
        raise InputError(f"{path} was cut off before it said what its channels are; there is no frame in it")
    recording = _of_rows(layout, rows)
    steps = np.diff(recording.sequence)
    return recording, Counts(frames=len(recording), lost=int((steps[steps > 1] - 1).sum()), bad=bad + splitter.overlong)


def _what(head: bytes) -> str:
    if MAGIC.startswith(head):
        return "was cut off before it said what its channels are; there is no frame in it"
    if head.startswith(MAGIC[:-2]):
        return "is a recording of another version than this skinfab reads; update skinfab"
    return "is no recording made by skinfab record"


def _of_rows(layout: Layout, rows: bytearray) -> Recording:
    table = np.frombuffer(rows, layout.recorded_type())
    n = len(layout.stream.channels)

    def flags(name: str) -> np.ndarray:
        return np.unpackbits(table[name], axis=1, bitorder="little")[:, :n].astype(bool)

    return Recording(
        layout.stream,
        table["device_time"].astype(float),
        table["host_time"].astype(float),
        table["sequence"].astype(np.int64),
        table["values"].astype(float),
        flags("valid"),
        flags("saturated"),
    )
