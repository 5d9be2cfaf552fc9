"""What goes wrong on a wire, on purpose: bytes flipped or lost, garbage between packets, packets twice or in the wrong order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

#: The longest burst of garbage.
_BURST = 200


@dataclass(frozen=True)
class Faults:
    """How often each thing goes wrong; nothing does by default.

    Parameters
    ----------
    flipped, lost : float
        Chance of a byte to have one bit turned, or to be left out.
    garbage : float
        Chance of a burst of random bytes before a packet.
    twice, swapped : float
        Chance of a packet to be sent a second time, or after the next one.
    unplugged : mapping of int to float
        Before which frame (from 0) the port goes, and for how many seconds.
    seed : int
    """

    flipped: float = 0.0
    lost: float = 0.0
    garbage: float = 0.0
    twice: float = 0.0
    swapped: float = 0.0
    unplugged: Mapping[int, float] = field(default_factory=dict)
    seed: int = 0


class Wire:
    """Packets go in, what arrives comes out.

    Examples
    --------
    >>> Wire(Faults()).carry(b"ab\\0"), Wire(Faults(twice=1.0)).carry(b"ab\\0")
    (b'ab\\x00', b'ab\\x00ab\\x00')
    >>> wire = Wire(Faults(swapped=1.0))
    >>> wire.carry(b"1\\0"), wire.carry(b"2\\0")
    (b'', b'2\\x001\\x00')
    """

    def __init__(self, faults: Faults) -> None:
        self._faults = faults
        self._rng = np.random.default_rng(faults.seed)
        self._held = b""

    def carry(self, packet: bytes) -> bytes:
        """What arrives of a packet, and of what was held back before."""
        f, rng = self._faults, self._rng
        out = packet
        if f.twice and rng.random() < f.twice:
            out += packet
        if self._held:
            out, self._held = out + self._held, b""
        elif f.swapped and rng.random() < f.swapped:
            self._held = out
            return b""
        if f.garbage and rng.random() < f.garbage:
            out = rng.bytes(int(rng.integers(1, _BURST))) + out
        return self.hurt(out)

    def hurt(self, data: bytes) -> bytes:
        """The bytes with some flipped and some lost."""
        f, rng = self._faults, self._rng
        if not (f.flipped or f.lost):
            return data
        each = np.frombuffer(data, np.uint8)
        turned = np.where(rng.random(len(each)) < f.flipped, np.uint8(1) << rng.integers(0, 8, len(each), dtype=np.uint8), np.uint8(0))
        return (each ^ turned)[rng.random(len(each)) >= f.lost].tobytes()
