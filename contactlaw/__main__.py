"""``python -m contactlaw``: the command line."""

import sys

from contactlaw.cli import main

if __name__ == "__main__":
    sys.exit(main())
