"""Quantities as people write them: ``0.9mm``, ``0.5mm,1mm,inf``, ``0.1:10:50log``.

A library of units such as pint would be one more dependency for two dozen units, and lists and
ranges would still have to be read here.
"""

import math
import re
from decimal import Decimal, DecimalException
from typing import NamedTuple

import numpy as np

_MOST = 100_000  # values of one range
_NUMBER = re.compile(
    r"\s*(?P<number>[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?|[-+]?inf|nan)"
    r"\s*(?P<unit>[^\W\d](?:.*\S)?|[%°])?\s*"
)
_COUNT = re.compile(r"\s*[0-9]{1,9}\s*(log)?\s*")


class Quantity(NamedTuple):
    """A physical quantity, and the units in which it may be given; the first is the SI unit."""

    name: str
    units: dict[str, Decimal]

    @property
    def si(self) -> str:
        """SI unit, which holds for a number without a unit."""
        return next(iter(self.units))


def _quantity(name: str, units: str) -> Quantity:
    """Quantity from its units and their sizes in SI units."""
    sizes = (unit.split() for unit in units.split(", "))
    return Quantity(name, {unit: Decimal(size) for unit, size in sizes})


LENGTH = _quantity("length", "m 1, cm 0.01, mm 1e-3, um 1e-6, nm 1e-9")
HEIGHT = LENGTH._replace(name="height")  # of drops, which may be of metres
SPEED = _quantity("speed", "m/s 1, cm/s 0.01, mm/s 1e-3, km/h 0.2777777777777777777777777778")
FREQUENCY = _quantity("frequency", "Hz 1, kHz 1000, MHz 1e6")
TIME = _quantity("time", "s 1, ms 1e-3, us 1e-6, ns 1e-9")
FORCE = _quantity("force", "N 1, kN 1000, mN 1e-3, uN 1e-6")
MASS = _quantity("mass", "kg 1, g 1e-3, mg 1e-6, ug 1e-9")
STRESS = _quantity("stress", "Pa 1, kPa 1000, MPa 1e6, GPa 1e9, N/mm2 1e6")
STIFFNESS = _quantity("stiffness", "N/m3 1, MN/m3 1e6, GN/m3 1e9, N/mm3 1e9")
DENSITY = _quantity("density", "kg/m3 1, g/m3 1e-3, g/cm3 1000")
SHARE = _quantity("share", "- 1, 1 1, % 0.01")
ANGLE = Quantity("angle", {"deg": Decimal(1), "rad": Decimal(180) / Decimal(math.pi), "°": Decimal(1)})
FRICTION = SHARE._replace(name="coefficient of friction")
SPIN = Quantity("spin", {"rad/s": Decimal(1), "rpm": Decimal(math.pi) / 30, "deg/s": Decimal(math.pi) / 180})
_MICRO = str.maketrans("µμ", "uu")  # the micro sign and the Greek letter


class _Item(NamedTuple):
    number: str
    unit: str


def values(text: str, quantity: Quantity) -> tuple[float, ...]:
    """Read a list of numbers and ranges, each with its unit or all in SI units.

    Items stand between commas: a number, or a range start:stop:count of evenly spaced values that
    include both ends; ``log`` after the count spaces them logarithmically. The values are not
    rounded by their unit: 0.9mm is 0.9e-3 to the last bit. Any sign, ``inf`` and ``nan`` are read:
    limits are for the caller to check.

    Examples
    --------
    >>> values("0.5mm, 1mm, inf", LENGTH), values("0.1:10:3log", SPEED)
    ((0.0005, 0.001, inf), (0.1, 1.0, 10.0))
    """
    items = [[_item(part, quantity) for part in _ends(item)] for item in text.split(",")]
    _check_units(text, [number for item in items for number in item], quantity)
    found: list[float] = []
    for item, numbers in zip(text.split(","), items, strict=True):
        sizes = [_size(number, quantity) for number in numbers]
        found += _range(item, *sizes) if ":" in item else sizes
    return tuple(found)


def value(text: str, quantity: Quantity) -> float:
    """Read one number with its unit, or in the SI unit."""
    found = values(text, quantity)
    if len(found) > 1:
        raise ValueError(f"got {text!r}, expected one {quantity.name}")
    return found[0]


def decimal_comma(text: str) -> str:
    """Write a text with a decimal point if it may be one number with a comma; otherwise ""."""
    return text.replace(",", ".") if re.fullmatch(r"\s*\d+,\d+\s*\D*", text) else ""


def _ends(item: str) -> list[str]:
    """Parts of an item that are numbers with units: a number, or the two ends of a range."""
    parts = item.split(":")
    if len(parts) == 1:
        return parts
    if len(parts) != 3 or not _COUNT.fullmatch(parts[2]):
        raise ValueError(
            f"got {item!r}; a range is start:stop:count, as 0.1:10:50, or 0.1:10:50log for logarithmic steps"
        )
    return parts[:2]


def _item(text: str, quantity: Quantity) -> _Item:
    match = _NUMBER.fullmatch(text)
    if not match:
        raise ValueError(f"got {text!r}, expected a {quantity.name} such as 0.5 or 0.5{list(quantity.units)[2]}")
    unit = (match["unit"] or "").translate(_MICRO)
    if unit and unit not in quantity.units:
        *others, last = quantity.units
        raise ValueError(
            f"got {text!r}: {unit!r} is no unit of {quantity.name}; take {', '.join(others)} or "
            f"{last}, or none for {quantity.si}"
        )
    return _Item(match["number"], unit)


def _check_units(text: str, items: list[_Item], quantity: Quantity) -> None:
    """Refuse units at some of the numbers: 0.9e-3,1mm and 0.5,1mm mean different things."""
    finite = [item for item in items if not item.number.endswith("inf")]
    unit = next((item.unit for item in finite if item.unit), None)
    bare = next((item.number for item in finite if not item.unit), None)
    if unit and bare:
        pointed = decimal_comma(text)
        hint = f"; {pointed} if it is a decimal comma" if pointed else ""
        raise ValueError(
            f"got {text!r}: {bare!r} has no unit and others have: give each number its unit, as {bare}{unit}{hint}"
        )


def _size(item: _Item, quantity: Quantity) -> float:
    if item.number[-1].isalpha():  # inf, nan
        return float(item.number)
    try:
        size = float(Decimal(item.number) * quantity.units[item.unit or quantity.si])
    except DecimalException:
        size = math.inf
    if math.isinf(size):
        raise ValueError(f"got {item.number + item.unit!r}, too large a {quantity.name}")
    return size


def _range(item: str, start: float, stop: float) -> list[float]:
    digits, log, _ = item.split(":")[2].partition("log")
    if not 2 <= int(digits) <= _MOST:
        raise ValueError(f"got {item!r}; a range has from 2 to {_MOST} values")
    if not (math.isfinite(start) and math.isfinite(stop)):
        raise ValueError(f"got {item!r}; the ends of a range have to be finite")
    if log and not (start > 0.0 and stop > 0.0):
        raise ValueError(f"got {item!r}; logarithmic steps need ends above 0")
    spaced = np.geomspace if log else np.linspace
    return [float(number) for number in spaced(start, stop, int(digits))]
