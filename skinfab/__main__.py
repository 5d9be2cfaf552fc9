"""`python -m skinfab` is the `skinfab` command."""

import sys

from skinfab.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
