"""Options that subcommands share, with their help."""

import argparse
from collections.abc import Callable, Iterable
from typing import Any

from contactlaw import laws, quantities
from contactlaw.cli.parts import wording
from contactlaw.cli.parts.wording import OWN
from contactlaw.physical.arguments import unlikely
from contactlaw.physical.materials import Material, read_materials
from contactlaw.quantities import ANGLE, HEIGHT, LENGTH, MASS, SHARE, SPEED, STIFFNESS, Quantity

Reader = Callable[[str, Quantity], Any]
Run = Callable[[argparse.Namespace], None]

UNITS = "Quantities are numbers in SI units, or carry one of their own: 0.9mm, 500um, 50nm, 36km/h."
LISTS = (
    "Several are a list, 1,5,10, or a range start:stop:count, 0.1:10:50, with logarithmic steps "
    "0.1:10:50log; every combination of speeds, radii and thicknesses is an impact."
)


def command(commands: Any, name: str, about: str, run: Run) -> argparse.ArgumentParser:
    """Add a subcommand, which calls `run`."""
    made = _described(commands, name, about)
    made.set_defaults(run=run)
    return made


def group(commands: Any, name: str, about: str, metavar: str, what: str) -> Any:
    """Add a subcommand with actions of its own; return the subparsers to add these to."""
    made = _described(commands, name, about)
    return made.add_subparsers(required=True, metavar=metavar, help=what)


def _described(commands: Any, name: str, about: str) -> argparse.ArgumentParser:
    sentence = f"{about[0].upper()}{about[1:]}."
    made: argparse.ArgumentParser = commands.add_parser(name, help=about, description=sentence)
    return made


def add_impact(command: argparse.ArgumentParser, read: Reader) -> None:
    """Add the options of commands about impacts; `read` reads one value or several."""
    add_pair(command)
    add_sizes(command, read)
    add_speed(command, read)
    add_law(command)
    command.add_argument("--solve", action="store_true", help="integrate the equation instead of using its table")


def add_quantity(
    command: Any, option: str, quantity: Quantity, what: str, read: Reader = quantities.value, **more: Any
) -> None:
    """Add the option of a quantity; `read` reads one value or several."""
    command.add_argument(option, type=reader_of(read, quantity), help=what, **more)


def add_mass(command: argparse.ArgumentParser) -> None:
    """Add the option of the mass of beads that are no solid spheres."""
    what = "mass of a hollow or coated bead, or of a clump [kg], or with a unit"
    add_quantity(command, "--mass", MASS, f"{what} (default: that of a solid sphere)", metavar="M")


def add_speed(command: argparse.ArgumentParser, read: Reader, what: str = "normal approach speed") -> None:
    """Add the options of the impact speed."""
    group = command.add_mutually_exclusive_group(required=True)
    add_quantity(group, "--speed", SPEED, f"{what} [m/s], or with a unit", read, metavar="V")
    add_drop(group, read)


def add_drop(
    command: Any, read: Reader, then: str = "in place of --speed: that on arrival, less what the air takes"
) -> None:
    """Add the option of the height of a drop."""
    add_quantity(
        command, "--drop", HEIGHT, f"height of a fall from rest [m], or with a unit, {then}", read, metavar="Z"
    )


def add_wall(command: argparse.ArgumentParser) -> None:
    """Add the options of walls that are no bare flat sheet."""
    add_layers(command)
    one = command.add_mutually_exclusive_group()
    where = "[m], or with a unit; negative where beads hit from outside (default: flat)"
    add_quantity(one, "--cylinder", LENGTH, f"radius of a wall that is a cylinder {where}", metavar="A")
    add_quantity(one, "--bowl", LENGTH, f"radius of a wall that is a sphere {where}", metavar="A")
    what = "stiffness of what the plate lies on, pressure per deflection [N/m3], or in N/mm3"
    add_quantity(one, "--foundation", STIFFNESS, f"{what} (default: none)", metavar="K")


def add_layers(command: argparse.ArgumentParser) -> None:
    """Add the option of layers below the plate."""
    command.add_argument(
        "--on",
        metavar="NAME:H",
        action="append",
        default=[],
        help="material and thickness of the layer to which the plate is bonded from below, as "
        "steel-s235:3mm; material and thickness of the plate are then those of the layer that beads touch; may be "
        "repeated, downwards (default: none)",
    )


OF_RECORD = " (default: that of the record)"


def add_pair(command: argparse.ArgumentParser, otherwise: str = "", action: str = "store") -> None:
    """Add the options of materials, required unless their help says what holds `otherwise`."""
    given: Any = {"required": not otherwise, "action": action, "metavar": "NAME"}
    bead = f"material of the bead: a name that `contactlaw materials` lists, or numbers, {OWN}{otherwise}"
    command.add_argument("--sphere", help=bead, **given)
    command.add_argument("--plate", help=f"material of the plate{otherwise}", **given)
    add_materials(command)


def add_materials(command: argparse.ArgumentParser) -> None:
    """Add the option of a file of materials."""
    command.add_argument(
        "--materials",
        metavar="FILE",
        type=_materials,
        default={},
        help="file of your own materials, TOML in the format of the catalogue (default: none)",
    )


def _materials(path: str) -> dict[str, Material]:
    try:
        return read_materials(path)
    except (OSError, ValueError) as error:
        raise argparse.ArgumentTypeError(wording.sentence(error, ())) from None


def add_sizes(command: argparse.ArgumentParser, read: Reader, required: bool = True, unknown: str = "") -> None:
    """Add the options of sizes, but for an unknown one; if not required, a record may have them."""
    known = "" if required else OF_RECORD
    add_radius(command, "the bead", read, required, known)
    if unknown != "thickness":
        what = f"thickness of the plate [m], or with a unit; inf: a half-space{known}"
        add_quantity(command, "--thickness", LENGTH, what, read, required=required, metavar="H")


def add_radius(
    command: argparse.ArgumentParser, of: str, read: Reader, required: bool = False, known: str = ""
) -> None:
    """Add the options of a bead's size."""

    def half(text: str) -> Any:
        found = reader_of(read, LENGTH)(text)
        return tuple(0.5 * one for one in found) if isinstance(found, tuple) else 0.5 * found

    group = command.add_mutually_exclusive_group(required=required)
    add_quantity(group, "--radius", LENGTH, f"radius of {of} [m], or with a unit{known}", read, metavar="R")
    group.add_argument(
        "--diameter", dest="radius", metavar="D", type=half, help=f"diameter of {of}, in place of --radius"
    )


def add_errors(command: argparse.ArgumentParser, sizes: Iterable[str]) -> None:
    """Add the options of standard errors, of sizes and of numbers of the materials."""
    for name in sizes:
        what = f"relative standard error of the {name}, as 5%% (default: 0)"
        add_quantity(command, f"--{name}-error", SHARE, what, metavar="SHARE", default=0.0)
    for role in ("sphere", "plate"):
        command.add_argument(
            f"--{role}-error",
            metavar="NUMBER=SHARE",
            type=_error,
            default=[],
            action="append",
            help=f"relative standard error of a property of the {role}'s material, as yield_strength=15%%; "
            "may be repeated (default: those of the catalogue)",
        )


def _error(text: str) -> tuple[str, float]:
    name, _, share = text.partition("=")
    try:
        return name, quantities.value(share, SHARE)
    except ValueError as error:
        wanted = "expected a number of a material and its error, as yield_strength=15%"
        raise argparse.ArgumentTypeError(f"{wanted}: {error}") from None


def add_name_of_law(command: argparse.ArgumentParser, default: str | None = laws.DEFAULT) -> None:
    """Add the option of the law."""
    stated = default or f"that of the record, or {laws.DEFAULT}"
    command.add_argument(
        "--law", default=default, metavar="LAW", help=f"force law: {', '.join(laws.names())} (default: {stated})"
    )


def add_law(command: argparse.ArgumentParser, default: str | None = laws.DEFAULT) -> None:
    """Add the options of the law and of the behaviour outside its table."""
    add_name_of_law(command, default)
    command.add_argument(
        "--outside",
        default="raise",
        choices=["raise", "solve", "clamp"],
        help="what to do with impacts outside the table: refuse them, integrate the equation, or take "
        "the value at the table's border (default: %(default)s)",
    )


def reader_of(read: Reader, quantity: Quantity) -> Callable[[str], Any]:
    """Reader of an option from a reader of quantities, with errors that argparse reports."""

    def one(text: str) -> Any:
        pointed = quantities.decimal_comma(text)
        if pointed.lstrip().startswith("0.") and quantity is not ANGLE:
            said = f"got {text!r}, a list that begins with 0; is it a decimal comma? Write {pointed}"
            if quantity in (LENGTH, HEIGHT, SPEED, SHARE):  # none of these may be 0
                raise argparse.ArgumentTypeError(said)
            wording.print_warning(said)
        try:
            found = read(text, quantity)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        size = unlikely(found) if quantity is LENGTH and "m" not in text else None  # no unit
        if size is not None:
            wording.print_warning(f"{size:g} is {size:g} m; {size:g}mm?")
        return found

    return one
