"""Source files for codes that do not run Python: the law of a pair of materials in C."""

from contactlaw.export.c_header import header
from contactlaw.export.liggghts_wall import liggghts

__all__ = ["header", "liggghts"]
