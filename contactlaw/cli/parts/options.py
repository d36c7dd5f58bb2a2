"""Options that subcommands share, with their help.

`command` is a parser, or one of its groups.
"""

import argparse
from argparse import Namespace
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from contactlaw import laws, quantities
from contactlaw.cli.parts import wording
from contactlaw.cli.parts.wording import OWN, Written
from contactlaw.physical.arguments import unlikely
from contactlaw.physical.materials import Material, read_materials
from contactlaw.quantities import ANGLE, HEIGHT, LENGTH, SHARE, SPEED, STIFFNESS, Quantity

Reader = Callable[[str, Quantity], Any]
Run = Callable[[Namespace], None]

UNITS = "Quantities are numbers in SI units, or carry one of their own: 0.9mm, 500um, 50nm, 36km/h."
LISTS = (
    "Several values are a list, 1,5,10, or a range start:stop:count, 0.1:10:50, or 0.1:10:50log for "
    "logarithmic steps. Every combination of the values is an impact."
)


def command(commands: Any, name: str, about: str, run: Run | None = None) -> argparse.ArgumentParser:
    """Add a subcommand, which calls `run`."""
    sentence = f"{about[0].upper()}{about[1:]}."
    made: argparse.ArgumentParser = commands.add_parser(name, help=about, description=sentence)
    made.set_defaults(run=run)
    return made


def group(commands: Any, name: str, about: str, metavar: str, what: str) -> Any:
    """Add a subcommand with actions of its own; return the subparsers to add these to."""
    return command(commands, name, about).add_subparsers(required=True, metavar=metavar, help=what)


def add_quantity(
    command: Any, option: str, quantity: Quantity, what: str, read: Reader = quantities.value, **more: Any
) -> None:
    """Add the option of a quantity; `read` reads one value or several."""
    command.add_argument(option, type=reader_of(read, quantity), help=what, **more)


def add_speed(command: Any, read: Reader, what: str = "normal approach speed") -> None:
    """Add the options of the impact speed."""
    group = command.add_mutually_exclusive_group(required=True)
    add_quantity(group, "--speed", SPEED, f"{what} [m/s]", read, metavar="V")
    add_drop(group, read)


def add_drop(command: Any, read: Reader, then: str = "in place of --speed; the air slows the bead") -> None:
    """Add the option of the height of a drop."""
    add_quantity(command, "--drop", HEIGHT, f"height of a fall from rest [m], {then}", read, metavar="Z")


def add_wall(command: Any) -> None:
    """Add the options of walls other than a bare flat sheet."""
    add_layers(command)
    shape = command.add_mutually_exclusive_group()
    where = "[m], negative if beads hit it from outside (default: flat)"
    add_quantity(shape, "--cylinder", LENGTH, f"radius of a cylindrical wall {where}", metavar="A")
    add_quantity(shape, "--bowl", LENGTH, f"radius of a spherical wall {where}", metavar="A")
    what = "stiffness of the bed below the plate, pressure per deflection [N/m3] (default: no bed)"
    add_quantity(shape, "--foundation", STIFFNESS, what, metavar="K")


def add_layers(command: Any) -> None:
    """Add the option of layers below the plate."""
    command.add_argument(
        "--on",
        metavar="NAME:H",
        action="append",
        default=[],
        help="material and thickness of a layer bonded below the plate, as steel-s235:3mm; "
        "repeat it for more layers, from top to bottom (default: none)",
    )


OF_RECORD = " (default: that of the record)"


def add_pair(command: Any, otherwise: str = "") -> None:
    """Add the options of materials, required unless their help says what holds `otherwise`."""
    settings: Any = {"required": not otherwise, "metavar": "NAME"}
    bead = f"material of the bead: a name that `contactlaw materials` lists, or numbers, {OWN}{otherwise}"
    command.add_argument("--sphere", help=bead, **settings)
    command.add_argument("--plate", help=f"material of the plate, in the same way{otherwise}", **settings)
    add_materials(command)


def add_materials(command: Any) -> None:
    """Add the option of a file of materials."""
    command.add_argument(
        "--materials",
        metavar="FILE",
        type=_materials,
        default={},
        help="TOML file of your own materials, in the format of the catalogue (default: none)",
    )


def _materials(path: str) -> dict[str, Material]:
    try:
        return read_materials(path)
    except (OSError, ValueError) as error:
        raise argparse.ArgumentTypeError(wording.sentence(error, {}).removeprefix("materials: ")) from None


def add_sizes(command: Any, read: Reader, required: bool = True, unknown: str = "") -> None:
    """Add the options of sizes, but for an unknown one; if not required, a record may have them."""
    known = "" if required else OF_RECORD
    add_radius(command, "the bead", read, required, known)
    if unknown != "thickness":
        what = f"thickness of the plate [m]; inf is a half-space{known}"
        add_quantity(command, "--thickness", LENGTH, what, read, required=required, metavar="H")


def add_radius(command: Any, of: str, read: Reader, required: bool = False, known: str = "") -> None:
    """Add the options of a bead's size."""

    def halved(text: str) -> Any:
        sizes = reader_of(read, LENGTH)(text)
        return tuple(map(_half, sizes)) if isinstance(sizes, tuple) else _half(sizes)

    group = command.add_mutually_exclusive_group(required=required)
    add_quantity(group, "--radius", LENGTH, f"radius of {of} [m]{known}", read, metavar="R")
    what = f"diameter of {of}, in place of --radius"
    group.add_argument("--diameter", dest="radius", metavar="D", type=halved, help=what)


def _half(size: float) -> float:
    return Written(0.5 * size, f"{size.text}/2") if isinstance(size, Written) else 0.5 * size


_FORMS = {form: f"print all fields as {form.upper()}, in SI units with every digit" for form in ("csv", "json")}


def add_forms(command: Any, forms: Mapping[str, str] = _FORMS) -> Any:
    """Add the option of each form of output, by default CSV and JSON; return their group, for others."""
    group = command.add_mutually_exclusive_group()
    for form, what in forms.items():
        group.add_argument(f"--{form}", action="store_const", const=form, dest="form", default="text", help=what)
    return group


def add_errors(command: Any, sizes: Iterable[str]) -> None:
    """Add the options of standard errors, of sizes and of numbers of the materials."""
    for name in sizes:
        what = f"relative standard error of the {name}, such as 5%% (default: 0)"
        add_quantity(command, f"--{name}-error", SHARE, what, metavar="SHARE", default=0.0)
    for role, body in (("sphere", "bead"), ("plate", "plate")):
        command.add_argument(
            f"--{role}-error",
            metavar="NUMBER=SHARE",
            type=_error,
            default=[],
            action="append",
            help=f"relative standard error of a property of the {body}, such as yield_strength=15%%; "
            "may be repeated (default: those of the catalogue)",
        )


def _error(text: str) -> tuple[str, float]:
    name, _, share = text.partition("=")
    try:
        return name, quantities.value(share, SHARE)
    except ValueError as error:
        wanted = "expected a property and its error, such as yield_strength=15%"
        raise argparse.ArgumentTypeError(f"{wanted}: {error}") from None


def add_name_of_law(command: Any, default: str | None = laws.DEFAULT) -> None:
    """Add the option of the law."""
    stated = default or f"that of the record, or {laws.DEFAULT}"
    command.add_argument(
        "--law", default=default, metavar="LAW", help=f"force law: {', '.join(laws.names())} (default: {stated})"
    )


def add_law(command: Any, default: str | None = laws.DEFAULT) -> None:
    """Add the options of the law and of the behaviour outside its table."""
    add_name_of_law(command, default)
    command.add_argument(
        "--outside",
        default="raise",
        choices=["raise", "solve", "clamp"],
        help="impacts outside the table: refuse them, integrate the equation, or take the value at the "
        "border of the table (default: %(default)s)",
    )


def reader_of(read: Reader, quantity: Quantity) -> Callable[[str], Any]:
    """Reader of an option from a reader of quantities, with errors that argparse reports."""

    def number(text: str) -> Any:
        pointed = quantities.decimal_comma(text)
        if pointed.lstrip().startswith("0.") and quantity is not ANGLE:
            doubt = f"got {text!r}, a list that begins with 0; is it a decimal comma? Write {pointed}"
            if quantity in (LENGTH, HEIGHT, SPEED, SHARE):  # none of these may be 0
                raise argparse.ArgumentTypeError(doubt)
            wording.print_warning(doubt)
        try:
            sizes = read(text, quantity)
        except ValueError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        size = unlikely(sizes) if quantity is LENGTH and "m" not in text else None  # no unit
        if size is not None:
            wording.print_warning(f"{size:g} is {size:g} m; {size:g}mm?")
        if ":" in text:  # the values of a range are not written one by one
            return sizes
        return tuple(map(Written, sizes, text.split(","))) if isinstance(sizes, tuple) else Written(sizes, text)

    return number
