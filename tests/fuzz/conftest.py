"""Lets the tests import the table of parsers (`import parsers`), as the search does."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
