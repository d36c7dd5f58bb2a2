"""Options with units that the commands share, and their errors. No slow imports."""

from __future__ import annotations

import argparse
import inspect
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from types import ModuleType
from typing import Any

from dem_demo.kit import signals


class Refused(Exception):
    """The command cannot do what was asked for; the message says why."""


@contextmanager
def needing(extras: str) -> Iterator[None]:
    """Import within this block; for a missing module, `Refused` names the extras to install.

    Interrupts wait until the block ends: matplotlib's extension modules drop them, or crash.
    """
    try:
        with signals.held():
            yield
        signals.check()
    except ModuleNotFoundError as error:
        raise Refused(f"{error.name} is missing: pip install contactlaw[{extras}]") from error


@contextmanager
def refusing(arguments: argparse.Namespace) -> Iterator[None]:
    """Raise a `ValueError` of this block as `Refused`, in terms of the options."""
    from contactlaw.cli.parts.wording import sentence

    try:
        yield
    except ValueError as error:
        raise Refused(sentence(error, vars(arguments))) from error


def of(make: Callable[..., Any], arguments: argparse.Namespace) -> dict[str, Any]:
    """Pick the arguments of the command line that a function takes."""
    return {name: getattr(arguments, name) for name in inspect.signature(make).parameters}


def text(numbers: Sequence[float]) -> str:
    """Write numbers as an option takes them.

    Examples
    --------
    >>> text((0.5e-3, 1.0))
    '0.0005,1'
    """
    return ",".join(f"{number:g}" for number in numbers)


def quantity(
    add: Any, name: str, read: Callable[[str], Any], metavar: str, default: float | Sequence[float], about: str
) -> None:
    """Add an option for one number or several, with units, which one of the functions below reads."""
    numbers = default if isinstance(default, Sequence) else (default,)
    add(name, type=read, metavar=metavar, default=text(numbers), help=about)


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
    from contactlaw import quantities

    try:
        return quantities.values(words, getattr(quantities, quantity))
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _one(words: str, found: tuple[float, ...]) -> float:
    if len(found) != 1:
        raise argparse.ArgumentTypeError(f"expected one number, got {words!r}")
    return found[0]


def _two(words: str, found: tuple[float, ...]) -> tuple[float, float]:
    if len(found) != 2:
        raise argparse.ArgumentTypeError(f"expected two numbers MIN,MAX, got {words!r}")
    return found[0], found[1]


def add_law(add: Any) -> None:
    """Add the option for the law."""
    add(
        "--law",
        metavar="NAME",
        default=argparse.SUPPRESS,
        help="contact law, of those that contactlaw cor --help lists (default: the one there)",
    )


def add_bed(add: Any, defaults: ModuleType, *, wall: str, beads: str) -> None:
    """Add the options of every bed; `wall` and `beads` are its words in the help texts."""
    quantity(add, "--thickness", length, "H", defaults.THICKNESS, "thickness of the sheet metal [m], or with a unit")
    add("--sphere", metavar="NAME", default=defaults.SPHERE, help="material of the beads")
    add("--plate", metavar="NAME", default=defaults.PLATE, help="material of the sheet metal")
    add(
        "--friction",
        type=float,
        metavar="MU",
        default=defaults.FRICTION,
        help=f"coefficient of friction, on the {wall} and of beads on each other",
    )
    add("--duration", type=float, metavar="T", default=defaults.DURATION, help="simulated time [s]")
    add("--seed", type=int, metavar="S", default=defaults.SEED, help=f"the same seed gives the same {beads}")
    add_law(add)
    add(
        "--constant-cor",
        type=float,
        metavar="E",
        default=argparse.SUPPRESS,
        help=f"COR of the other run (default: the law's for a thick block, at the speed of the {beads})",
    )
