"""Hardness as people write it, "62 HRC", "800 HV" or "200 HBW", in Pa.

Vickers and Brinell numbers are a force over an area in kgf/mm2 (ISO 6507-1, ISO 6506-1), and one
kgf/mm2 is 9.80665e6 Pa. Rockwell C is a depth, which ASTM E140-12, Table 1, relates to Vickers for
non-austenitic steels; austenitic ones are read from it, too, since they have no table of their own.
"""

import re

import numpy as np

from contactlaw._errors import ArgumentError

_KGF_PER_MM2 = 9.80665e6  # [Pa]
_UNITS = ("HV", "HB", "HBW", "HRC")
_LEAST, _MOST = 20, 68  # HRC, first and last row of the table
# Vickers numbers of 20, 21, ... 68 HRC: ASTM E140-12, Table 1
_VICKERS = """
238 243 248 254 260 266 272 279 286 294 302 310 318 327 336 345 354 363 372 382 392 402
412 423 434 446 458 471 484 498 513 528 544 560 577 595 613 633 653 674 697 720 746 772
800 832 865 900 940
""".split()
# The load of a test may follow the unit, as in 640 HV10 or 200 HBW 10/3000; it changes nothing.
_WRITTEN = re.compile(r"\s*(\d+\.?\d*)\s*([A-Za-z]+)\s*[\d./]*\s*")


def pascals(text: str) -> float:
    """Hardness [Pa] of a text.

    Examples
    --------
    >>> round(pascals("62 HRC") / 9.80665e6)  # kgf/mm2
    746
    """
    found = _WRITTEN.fullmatch(text)
    if not found or found[2].upper() not in _UNITS:
        reason = f"must be a number in [Pa], or have a unit of {', '.join(_UNITS)} as '62 HRC'"
        raise ArgumentError("hardness", text, reason)
    number = float(found[1])
    if found[2].upper() == "HRC":
        if not (_LEAST <= number <= _MOST):
            limits = f"must be from {_LEAST} to {_MOST} HRC, where the scale is related to others"
            raise ArgumentError("hardness", text, f"{limits}: give HV or HB")
        number = float(np.interp(number, range(_LEAST, _MOST + 1), [*map(float, _VICKERS)]))
    return number * _KGF_PER_MM2
