"""Numbers as people read them: a size in a suitable unit, a value with its error, and a share.

Everything that is printed for people uses these; files for programs have every digit.
"""

import math
import sys

# Smallest size in SI units for each unit with a prefix, and what the unit stands for. Strengths of
# thousands of MPa and plates of tenths of a mm keep the units of data sheets.
_PREFIXES = {
    "Pa": ((1e10, "GPa", 1e9), (1e5, "MPa", 1e6), (1e2, "kPa", 1e3), (0.0, "Pa", 1.0)),
    "m": ((1.0, "m", 1.0), (1e-4, "mm", 1e-3), (1e-7, "um", 1e-6), (0.0, "nm", 1e-9)),
    "s": ((1.0, "s", 1.0), (1e-3, "ms", 1e-3), (1e-7, "us", 1e-6), (0.0, "ns", 1e-9)),
    "kg": ((1.0, "kg", 1.0), (1e-3, "g", 1e-3), (1e-6, "mg", 1e-6), (0.0, "ug", 1e-9)),
    "J": ((1.0, "J", 1.0), (1e-3, "mJ", 1e-3), (1e-6, "uJ", 1e-6), (0.0, "nJ", 1e-9)),
}
_FINEST = 1e-6  # smallest relative error that is written: no material is known so well
_PLAIN = (1e-4, 1e7)  # sizes between which a number needs no exponent


def scale_of(size: float, unit: str) -> tuple[str, float]:
    """Find the unit that suits a size in SI units, and the unit's size in SI units.

    Examples
    --------
    >>> scale_of(3.13e9, "Pa"), scale_of(0.5e-3, "m"), scale_of(2500.0, "kg/m3")
    (('MPa', 1000000.0), ('mm', 0.001), ('kg/m3', 1.0))
    """
    for least, name, scale in _PREFIXES.get(unit, ()):
        if abs(size) >= least:
            return name, scale
    return unit, 1.0


def in_unit(size: float, unit: str, digits: int = 6) -> str:
    """Write a size in SI units in the unit that suits it.

    Examples
    --------
    >>> in_unit(0.9e-3, "m"), in_unit(5.0, "m/s"), in_unit(0.0, "J"), in_unit(math.inf, "m")
    ('0.9 mm', '5 m/s', '0 J', 'inf')
    """
    if not math.isfinite(size):
        return f"{size:g}"
    name, scale = scale_of(size, unit) if size else (unit, 1.0)
    return f"{size / scale:.{digits}g} {name}"


def drawn(size: float, unit: str = "m", digits: int = 6) -> str:
    """Write a size for figures and pages, which have µ; an infinite plate is a half-space.

    Examples
    --------
    >>> drawn(50e-6), drawn(math.inf), drawn(1.2345e-3, "J", 3)
    ('50 µm', 'half-space', '1.23 mJ')
    """
    if size == math.inf:
        return "half-space"
    return in_unit(size, unit, digits).replace(" u", " µ")


def rounded(number: float, digits: int = 2) -> str:
    """Write a number with so many significant digits, and an exponent where it needs one.

    Examples
    --------
    >>> rounded(190.3), rounded(0.01249), rounded(99.6), rounded(2.2e-14)
    ('190', '0.012', '100', '2.2e-14')
    """
    short = f"{number:.{digits - 1}e}"
    size = abs(float(short))
    if not (_PLAIN[0] <= size < _PLAIN[1]):  # NaN, too
        return f"{number:.{digits}g}"
    return f"{float(short):.{max(0, digits - 1 - _exponent(size))}f}"


def with_error(value: float, error: float, unit: str) -> str:
    """Write a value with its standard error, both to the error's second digit.

    Parameters
    ----------
    value, error : float
        In SI units; the error is not negative. One below a millionth of the value is written as
        a millionth; an error of 0, or too small for a normal float, as 0.
    unit : str
        SI unit; Pa, m and s get a prefix.

    Returns
    -------
    str
        The text; numbers from 1e-4 to 1e7 have no exponent.

    Examples
    --------
    >>> with_error(852.3e6, 190.4e6, "Pa"), with_error(0.509e-3, 0.0041e-3, "m")
    ('850 +- 190 MPa', '0.5090 +- 0.0041 mm')
    """
    name, scale = scale_of(max(abs(value), error if error < math.inf else 0.0), unit)
    if not (math.isfinite(value) and math.isfinite(error)):
        return f"{value / scale:g} +- {error / scale:g} {name}"
    if error < sys.float_info.min:
        return f"{value / scale:.6g} +- 0 {name}"
    value, error = value / scale, max(error / scale, abs(value / scale) * _FINEST)
    last = _exponent(float(f"{error:.1e}")) - 1  # place of the second digit, after rounding
    size = max(abs(value), error)
    if not (_PLAIN[0] <= size < _PLAIN[1]):
        power = _exponent(size)
        value, error, last = value / 10.0**power, error / 10.0**power, last - power
        return f"({_at(value, last)} +- {_at(error, last)})e{power} {name}"
    return f"{_at(value, last)} +- {_at(error, last)} {name}"


def percent(share: float) -> str:
    """Write a share in percent; shares of ten and more as a multiple.

    Examples
    --------
    >>> percent(0.0123), percent(2.2e-14), percent(1810.0), percent(-0.5)
    ('1.2 %', 'below 0.01 %', '1800 times', '-50 %')
    """
    if share and abs(share) < 1e-4:
        return "below 0.01 %"
    if abs(share) >= 10.0:
        return f"{rounded(share)} times"
    return f"{rounded(100.0 * share) if share else 0} %"


def relative(error: float, form: str = ".1%") -> str:
    """Write a relative error of at least -1; beyond 1000 % its digits mean nothing.

    Examples
    --------
    >>> relative(0.44), relative(-0.01, "+z.2%"), relative(float("inf"))
    ('44.0%', '-1.00%', '>1000%')
    """
    return format(error, form) if error <= 10.0 else ">1000%"


def _exponent(size: float) -> int:
    return int(f"{size:e}".partition("e")[2])


def _at(number: float, last: int) -> str:
    """Write a number to a decimal place, a negative one after the point."""
    return f"{round(number, -last):z.{max(0, -last)}f}"
