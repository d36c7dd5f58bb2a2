"""Files for codes that Python cannot reach: the law as C, for a pair of materials."""

from contactlaw.export.c_header import header
from contactlaw.export.liggghts_wall import liggghts

__all__ = ["header", "liggghts"]
