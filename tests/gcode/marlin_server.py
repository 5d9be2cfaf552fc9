"""A printer to stream to: Marlin's line protocol on a loopback port, no motion behind it."""

from __future__ import annotations

import functools
import operator
import re
import socket
import threading
from types import TracebackType

#: Nobody talks for so long in a test, s: then the server ends by itself.
SILENCE_S = 30.0

_NUMBERED = re.compile(r"N(-?\d+) (.*)\*(\d+)")


class MarlinServer:
    """Obeys numbered lines with right checksums, in order, and asks for any other again.

    Parameters
    ----------
    garble : set of int
        Of these lines, counted as they arrive, one bit is turned over on the way in.
    drop_at : int, optional
        When so many lines were obeyed, the connection is cut once, before the next line is obeyed.

    Attributes
    ----------
    obeyed : list of str
        Commands in the order they were obeyed, without numbers and checksums.
    resends : list of int
        The line numbers that were asked for again.
    connections : int
    unnumbered : list of str
        Commands that came without a number, such as a question for the temperature.
    log : list of str
        Every line as it came and its answer, for the person who looks for the fault.
    """

    def __init__(self, *, garble: frozenset[int] = frozenset(), drop_at: int | None = None) -> None:
        self.garble, self.drop_at = garble, drop_at
        self.obeyed: list[str] = []
        self.resends: list[int] = []
        self.unnumbered: list[str] = []
        self.log: list[str] = []
        self.connections = 0
        self._seen = 0
        self._last = 0
        self._socket = socket.create_server(("127.0.0.1", 0))
        self._socket.settimeout(SILENCE_S)
        self._stopped = False
        self._thread = threading.Thread(target=self._serve)

    @property
    def address(self) -> str:
        """Host and port, for printrun."""
        return "{}:{}".format(*self._socket.getsockname())

    def __enter__(self) -> MarlinServer:
        self._thread.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None) -> None:
        # A last visitor wakes the server from waiting for one.
        self._stopped = True
        with socket.create_connection(self._socket.getsockname()):
            pass
        self._thread.join(SILENCE_S)
        self._socket.close()
        assert not self._thread.is_alive(), "the server did not stop"

    def _serve(self) -> None:
        while True:
            try:
                connection, _ = self._socket.accept()
            except TimeoutError:
                return
            if self._stopped:
                connection.close()
                return
            self.connections += 1
            with connection:
                connection.settimeout(SILENCE_S)
                try:
                    self._talk(connection)
                except (TimeoutError, ConnectionError) as fault:
                    self.log.append(f"the connection ended: {fault!r}")

    def _talk(self, connection: socket.socket) -> None:
        connection.sendall(b"start\n")
        with connection.makefile("rb") as lines:
            for raw in lines:
                line = raw.decode("ascii").strip()
                answer = self._answer(line)
                self.log.append(f"{self._seen:4d} {line} -> {answer!r}")
                if answer is None:
                    return
                connection.sendall(answer.encode("ascii"))

    def _answer(self, line: str) -> str | None:
        """What Marlin says to one line; None where the cable comes off."""
        self._seen += 1
        if self._seen in self.garble:
            line = line[:3] + chr(ord(line[3]) ^ 1) + line[4:]
        if not line.startswith("N"):
            self.unnumbered.append(line)
            return "ok T:20.0 /0.0\n" if line.startswith("M105") else "ok\n"
        match = _NUMBERED.fullmatch(line)
        if not match or functools.reduce(operator.xor, f"N{match[1]} {match[2]}".encode()) != int(match[3]):
            return self._again("checksum mismatch")
        number, command = int(match[1]), match[2]
        if command.startswith("M110"):
            self._last = number
            return "ok\n"
        if number != self._last + 1:
            return self._again("Line Number is not Last Line Number+1")
        if self.drop_at is not None and len(self.obeyed) == self.drop_at:
            self.drop_at = None
            return None
        self._last = number
        self.obeyed.append(command)
        return "ok\n"

    def _again(self, why: str) -> str:
        self.resends.append(self._last + 1)
        return f"Error:{why}, Last Line: {self._last}\nResend: {self._last + 1}\nok\n"
