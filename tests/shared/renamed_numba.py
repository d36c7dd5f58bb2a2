"""A numba that lacks one of its private names; for `python -m pytest -p renamed_numba`.

What its public names compile lies in a folder of its own.
"""

from pathlib import Path

import numba
from numba.core import codegen

numba.config.CACHE_DIR = str(Path(__file__).parents[2] / ".pytest_cache/public-names")
del codegen.JITCodeLibrary
