"""Files for codes that Python cannot reach: the law as C, for a pair of materials."""

from contactlaw.export.c_header import header

__all__ = ["header"]
