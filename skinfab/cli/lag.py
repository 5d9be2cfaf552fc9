"""How long what is read of a port lags behind it."""

from __future__ import annotations


class Lag:
    """From a frame's arrival to what was read of it, without what had waited for the first to be read.

    A port holds what was sent before it was opened. It comes at once, and says nothing of how fast frames are read: what counts begins with
    the first frame that was waited for, or, where none ever was, with the first that came after reading began.

    Examples
    --------
    >>> lag = Lag()
    >>> for asked, arrived, read in ((1.0, 0.9, 1.4), (1.4, 0.9, 1.8), (1.8, 2.0, 2.002)):
    ...     lag.add(asked, arrived, read)
    >>> lag.live, round(lag.times_ms()["worst"], 6)
    (True, 2.0)
    """

    def __init__(self) -> None:
        self._each: list[float] = []
        self._began: float | None = None
        #: From which reading on frames came while they were read, and from which on they were waited for.
        self._after: int | None = None
        self._awaited: int | None = None

    def add(self, asked: float, arrived: float, read: float) -> None:
        """Take a frame: when it was asked for, when it had arrived, and when it was read, s."""
        if self._began is None:
            self._began = asked
        if self._after is None and arrived >= self._began:
            self._after = len(self._each)
        if self._awaited is None and arrived >= asked:
            self._awaited = len(self._each)
        self._each.append(1000 * (read - arrived))

    @property
    def live(self) -> bool:
        """Whether any frame came while frames were read."""
        return self._after is not None

    def times_ms(self) -> dict[str, float]:
        """The median and the worst, ms; of all frames where they had all come before the first was read."""
        first = self._awaited if self._awaited is not None else self._after
        of = sorted(self._each[first or 0 :])
        return {"median": of[len(of) // 2], "worst": of[-1]}
