"""Lets every test import the shared shapes (`import shapes`), and what tests start be interrupted."""

import signal
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

# A shell that starts the tests in the background (and nohup) has signals ignored, and what the tests start would inherit that.
# A handler that does nothing is as deaf here, but is not inherited.
for number in (signal.SIGINT, signal.SIGHUP):
    if signal.getsignal(number) == signal.SIG_IGN:
        signal.signal(number, lambda *_: None)
