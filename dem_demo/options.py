"""What the commands have in common: refusals, and options with units. No slow imports."""

from __future__ import annotations

import argparse
from collections.abc import Sequence


class Refused(Exception):
    """The physics does not allow what was asked for."""


def text(numbers: Sequence[float]) -> str:
    """Write numbers as an option takes them.

    Examples
    --------
    >>> text((0.5e-3, 1.0))
    '0.0005,1'
    """
    return ",".join(f"{number:g}" for number in numbers)


def lengths(words: str) -> tuple[float, ...]:
    """Read lengths [m], or with units."""
    return _values(words, "LENGTH")


def length(words: str) -> float:
    """Read one length [m], or with a unit."""
    return _one(words, lengths(words))


def speed(words: str) -> float:
    """Read one speed [m/s], or with a unit."""
    return _one(words, _values(words, "SPEED"))


def radii(words: str) -> tuple[float, float]:
    """Read two lengths [m], or with units."""
    return _two(words, lengths(words))


def speeds(words: str) -> tuple[float, float]:
    """Read two speeds [m/s], or with units."""
    return _two(words, _values(words, "SPEED"))


def _values(words: str, quantity: str) -> tuple[float, ...]:
    from contactlaw.cli.parts import options, quantities

    kind = getattr(quantities, quantity)
    found: tuple[float, ...] = options.reader_of(quantities.values, kind)(words)
    return found


def _one(words: str, found: tuple[float, ...]) -> float:
    if len(found) != 1:
        raise argparse.ArgumentTypeError(f"expected one number, got {words!r}")
    return found[0]


def _two(words: str, found: tuple[float, ...]) -> tuple[float, float]:
    if len(found) != 2:
        raise argparse.ArgumentTypeError(f"expected two numbers MIN,MAX, got {words!r}")
    return found[0], found[1]
