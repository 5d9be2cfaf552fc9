"""Bytes from a port become frames, whatever it sends: packets with a checksum, or lines of numbers."""

from __future__ import annotations

from typing import Protocol

from skinfab.errors import InputError
from skinfab.readout.ascii_lines import LineDecoder
from skinfab.readout.frame import Frame, Stream
from skinfab.readout.framing import Splitter, unpacked
from skinfab.readout.packets import DESCRIPTION, Layout, kind_of


class Decoder(Protocol):
    """Bytes in, frames out. Their sequence numbers are as they were sent."""

    @property
    def checked(self) -> bool:
        """Has each frame a checksum?"""
        ...

    @property
    def stream(self) -> Stream | None:
        """What is sent; None until that is known."""
        ...

    @property
    def changed(self) -> Stream | None:
        """Another stream that the port has begun to send; no frame of it is given out."""
        ...

    @property
    def bad(self) -> int:
        """Pieces that were no packet."""
        ...

    @property
    def fault(self) -> str:
        """Why the last bad piece was none, a sentence; empty where that cannot be said."""
        ...

    @property
    def doubt(self) -> str:
        """Why what is read may mean something else, a sentence; else empty."""
        ...

    def reset(self) -> None:
        """The port was gone: what had begun will not be ended."""
        ...

    def feed(self, data: bytes, *, host_time: float) -> list[Frame]:
        """The frames that these bytes complete."""
        ...


class PacketDecoder:
    """Packets become frames, once the first description has told what the channels are.

    Examples
    --------
    >>> import numpy as np
    >>> from skinfab.readout.frame import Channel
    >>> layout = Layout(Stream("one", (Channel("U", "V"),), 100.0))
    >>> frame = layout.frame_packet(Frame(1.5, 0.0, 7, np.array([0.25]), np.array([True]), np.array([False])))
    >>> decoder = PacketDecoder()
    >>> [f.sequence for f in decoder.feed(frame + layout.description + b"garbage\\0" + frame, host_time=9.0)], decoder.bad
    ([7], 1)
    """

    checked = True
    #: Of a packet that is hurt nothing more can be said, and of one that is whole nothing is in doubt.
    fault = ""
    doubt = ""

    def __init__(self) -> None:
        self._splitter = Splitter()
        self._layout: Layout | None = None
        self._begun = False
        self._wrong = 0
        self.changed: Stream | None = None

    @property
    def stream(self) -> Stream | None:
        return None if self._layout is None else self._layout.stream

    @property
    def bad(self) -> int:
        return self._wrong + self._splitter.overlong

    def reset(self) -> None:
        self._splitter.reset()
        self._begun = False

    def feed(self, data: bytes, *, host_time: float) -> list[Frame]:
        out = []
        for piece in self._splitter.feed(data):
            body = unpacked(piece)
            kind = None if body is None else kind_of(body)
            if body is None or kind is None:
                # The first piece is most likely the end of a packet that had begun before: nothing was wrong with it.
                self._wrong += self._begun
            elif kind == DESCRIPTION:
                self._describe(body)
            elif self._layout is not None:
                frame = self._layout.frame(body, host_time=host_time)
                if frame is not None:
                    out.append(frame)
                else:
                    self._wrong += 1
            self._begun = True
        return out

    def _describe(self, body: bytes) -> None:
        try:
            layout = Layout.of_description(body)
        except InputError:
            self._wrong += 1
            return
        if self._layout is None or layout.stream == self._layout.stream:
            self._layout = layout
        else:
            self.changed = layout.stream


class AnyDecoder:
    """Packets or lines: whichever is the first to be understood."""

    def __init__(self) -> None:
        self._each: tuple[Decoder, ...] = (PacketDecoder(), LineDecoder())

    @property
    def checked(self) -> bool:
        return self._each[0].checked

    @property
    def stream(self) -> Stream | None:
        return self._each[0].stream

    @property
    def changed(self) -> Stream | None:
        return self._each[0].changed

    @property
    def bad(self) -> int:
        return self._each[0].bad

    @property
    def fault(self) -> str:
        return next((decoder.fault for decoder in self._each if decoder.fault), "")

    @property
    def doubt(self) -> str:
        return self._each[0].doubt

    def reset(self) -> None:
        for decoder in self._each:
            decoder.reset()

    def feed(self, data: bytes, *, host_time: float) -> list[Frame]:
        for decoder in self._each:
            frames = decoder.feed(data, host_time=host_time)
            if decoder.stream is not None:
                self._each = (decoder,)
                return frames
        return []
