"""The options of a scene, made from the parameters of the function that makes it. No slow imports."""

from __future__ import annotations

import argparse
import inspect
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contactlaw import quantities
from contactlaw.quantities import Quantity
from dem_demo.kit import signals

if TYPE_CHECKING:
    from contactlaw import ImpactModel
    from dem_demo.kit.scene import Scene

# Parameters that may have units.
_QUANTITIES = {"speed": quantities.SPEED}
_QUANTITIES |= dict.fromkeys(("radius", "thickness", "plates", "opening", "amplitude"), quantities.LENGTH)
_RANGE, _LIST = "MIN,MAX", "H,..."  # placeholders of options that take two values, or any number
# Placeholder and help of the options that scenes share; a scene may have words of its own.
_ABOUT = {
    "beads": ("N", "number of beads"),
    "radius": (_RANGE, "bead radii [m], or with units"),
    "thickness": ("H", "thickness of the sheet metal [m], or with a unit"),
    "sphere": ("NAME", "material of the beads"),
    "plate": ("NAME", "material of the walls"),
    "friction": ("MU", "coefficient of friction, on the walls and of beads on each other"),
    "softening": ("S", "number by which the modulus of all contacts is divided, for longer steps; 1: true contacts"),
    "duration": ("T", "simulated time [s]"),
    "seed": ("S", "the same seed gives the same beads"),
}


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
    given = vars(arguments)
    return {name: given[name] for name in inspect.signature(make).parameters if name in given}


def model(scene: Scene, arguments: argparse.Namespace, outside: Any) -> ImpactModel:
    """Make the model of the impacts on walls, with the law of the options."""
    from contactlaw import ImpactModel, Pair, laws

    pair = Pair(scene.sphere_material, scene.plate_material)
    return ImpactModel(pair, getattr(arguments, "law", laws.DEFAULT), outside=outside)


def add_scene(
    commands: Any,
    make: Callable[..., Any],
    about: Mapping[str, tuple[str, str]],
    start: Callable[[argparse.Namespace, str], int],
    *,
    help: str,
    description: str,
) -> argparse.ArgumentParser:
    """Add a scene to the commands, with an option for each parameter of the function that makes it.

    `about` has a placeholder and a help text for each parameter that scenes do not share.
    """
    name = make.__name__
    what = (
        f"Writes {name}.h5, index.html, figures (PNG) and summary.txt. What has been computed is kept if it is "
        "stopped. All numbers are in SI units."
    )
    command: argparse.ArgumentParser = commands.add_parser(
        name, help=help, description=f"{description} {what}", formatter_class=argparse.ArgumentDefaultsHelpFormatter
    )
    for key, parameter in inspect.signature(make).parameters.items():
        metavar, words = {**_ABOUT, **about}[key]
        default = parameter.default
        kind: Callable[[str], Any] = type(default)
        if key in _QUANTITIES:
            values = default if isinstance(default, tuple) else (default,)
            default, kind = ",".join(f"{one:g}" for one in values), partial(_read, _QUANTITIES[key], metavar)
        elif default is None:
            default, kind = argparse.SUPPRESS, float
        command.add_argument(f"--{key}", type=kind, metavar=metavar, default=default, help=words)
    law = "contact law, of those that contactlaw cor --help lists (default: the one there)"
    command.add_argument("--law", metavar="NAME", default=argparse.SUPPRESS, help=law)
    command.add_argument("--out", type=Path, metavar="DIR", default=Path(name), help="folder for the results")
    command.set_defaults(start=start)
    return command


def _read(quantity: Quantity, metavar: str, words: str) -> float | tuple[float, ...]:
    """Read one number, two, or several, each with its unit or all in SI units."""
    try:
        found = quantities.values(words, quantity)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    count = {_RANGE: 2, _LIST: len(found)}.get(metavar, 1)
    if len(found) != count:
        expected = "one number" if count == 1 else f"two numbers {_RANGE}"
        raise argparse.ArgumentTypeError(f"expected {expected}, got {words!r}")
    return found if metavar in (_RANGE, _LIST) else found[0]
