"""``python -m dem_demo``: the command line."""

import sys

from dem_demo.cli import main

if __name__ == "__main__":
    sys.exit(main())
