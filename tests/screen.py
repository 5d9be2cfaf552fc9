"""A screen of its own with a window manager on it, hands that move the mouse and press keys, and someone who asks windows."""

from __future__ import annotations

import json
import os
import secrets
import shutil
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

#: Asks windows, in a process of its own: Tk ends the one it is in when its screen goes.
_ASKER = """
import json, sys, tkinter
root = tkinter.Tk(className="asker")
root.withdraw()
for line in sys.stdin:
    try:
        answer = True, str(root.tk.call(*json.loads(line)))
    except tkinter.TclError as fault:
        answer = False, str(fault)
    print(json.dumps(answer), flush=True)
"""

#: Programs that stand for the person and the desk: a screen, a window manager, hands.
NEEDS = ("Xvfb", "openbox", "xdotool")

#: Nothing that is waited for takes so long, s, unless it never comes.
PATIENCE = 40.0


def missing() -> list[str]:
    """Programs of `NEEDS` that are not installed."""
    return [program for program in NEEDS if shutil.which(program) is None]


def until(condition: Callable[[], Any], what: str, patience: float = PATIENCE) -> Any:
    """What `condition` gives, once it is true of it."""
    end = time.monotonic() + patience
    while True:
        if found := condition():
            return found
        assert time.monotonic() < end, f"waited {patience:g} s in vain for {what}"
        time.sleep(0.01)


class Screen:
    """1280 x 800 pixels with a window manager; ends with `close`.

    Tk answers ``send`` only where the X server admits by a secret, so the screen has one.
    """

    def __init__(self, folder: Path) -> None:
        key, family = secrets.token_bytes(16), struct.pack(">H", 0xFFFF)
        fields = (b"", b"", b"MIT-MAGIC-COOKIE-1", key)
        self.auth = folder / "screen.auth"
        self.auth.write_bytes(family + b"".join(struct.pack(">H", len(field)) + field for field in fields))
        read, write = os.pipe()
        # Without -noreset the server would begin anew, and drop the window manager, when a first short client leaves before it has come.
        command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten", "tcp", "-noreset", "-auth", str(self.auth)]
        self._server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            number = pipe.readline().strip()
        self.env = os.environ | {"DISPLAY": f":{number}", "XAUTHORITY": str(self.auth)}
        self._manager = subprocess.Popen(["openbox"], env=self.env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self._asker = subprocess.Popen(
            [sys.executable, "-c", _ASKER],
            env=self.env,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        try:
            # A window that comes before the window manager would not be fitted to the screen.
            until(
                lambda: subprocess.run(["xdotool", "get_desktop"], env=self.env, capture_output=True).returncode == 0, "the window manager"
            )
        except BaseException:
            self.close()
            raise

    def ask(self, *words: str) -> str:
        """What Tk gives for a command.

        Raises
        ------
        RuntimeError
            It gives an error.
        """
        stdin, stdout = self._asker.stdin, self._asker.stdout
        assert stdin is not None and stdout is not None
        stdin.write(json.dumps(words) + "\n")
        stdin.flush()
        good, said = json.loads(stdout.readline())
        if not good:
            raise RuntimeError(said)
        return str(said)

    def xdo(self, *words: object) -> str:
        """Let hands do something: words of xdotool."""
        return subprocess.run(["xdotool", *map(str, words)], env=self.env, check=True, capture_output=True, text=True).stdout

    def picture(self, path: Path) -> None:
        """What is on the screen, as a PNG."""
        from PIL import ImageGrab

        before = os.environ.get("XAUTHORITY")
        os.environ["XAUTHORITY"] = str(self.auth)
        try:
            ImageGrab.grab(xdisplay=self.env["DISPLAY"]).save(path, optimize=True)
        finally:
            if before is None:
                del os.environ["XAUTHORITY"]
            else:
                os.environ["XAUTHORITY"] = before

    def close(self) -> None:
        """Take all away."""
        for process in (self._asker, self._manager, self._server):
            process.terminate()
            process.wait(timeout=10)
        for pipe in (self._asker.stdin, self._asker.stdout):
            if pipe is not None:
                pipe.close()
