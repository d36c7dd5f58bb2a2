"""``contactlaw oblique``: tangential rebound and spin of beads that come at an angle."""

import argparse
import sys
from typing import Any

import numpy as np

from contactlaw import _atomic, quantities
from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._readable import drawn
from contactlaw._version import VERSION
from contactlaw.cli.oblique import tracers
from contactlaw.cli.parts import chosen, impacts, layout, options, wording
from contactlaw.cli.parts import old_figure as figure
from contactlaw.cli.parts.impacts import Column, ImpactTable
from contactlaw.cli.parts.plots import plate_of
from contactlaw.equation.tangential import POINT
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import within

_STEEPEST = 0.01  # [deg] angle that stands for normal incidence
_GIVEN = "angle", "speed", "thickness", "radius", "friction"  # in the order of axes
_COLUMNS = (
    Column("angle", "deg", "angle", "deg"),
    Column("friction", "", "friction"),
    *(column for column in impacts.COLUMNS if column.name in _GIVEN),
    Column("restitution", "", "COR"),
    Column("tangential_restitution", "", "tangential"),
    Column("rotational_restitution", "", "rotational"),
    Column("impulse_ratio", "", "J_t/J_n"),
    Column("sliding_speed", "m/s"),
    Column("spin", "rad/s", "spin", "rad/s"),
    Column("rebound_angle", "deg", "leaves at", "deg"),
    Column("friction_energy", "J"),
)


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "tangential rebound and spin of beads that come at an angle, without spin"
    command = options.command(commands, "oblique", about, _run)
    options.add_pair(command)
    options.add_sizes(command, quantities.values)
    options.add_mass(command)
    options.add_speed(command, quantities.values, "speed of the bead")
    options.add_name_of_law(command)
    command.set_defaults(outside="raise")  # every impact is integrated
    for option, quantity, metavar, what in (
        ("--angle", quantities.ANGLE, "A", "angle of incidence from the plate's normal [deg], from 0 to below 90"),
        ("--friction", quantities.FRICTION, "MU", "coefficient of friction between bead and plate"),
    ):
        options.add_quantity(command, option, quantity, what, quantities.values, required=True, metavar=metavar)
    add = command.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print rows of all fields in SI units, every digit")
    add(
        "--plot",
        metavar="FILE",
        help="draw the tangential restitution into FILE (PNG, SVG, PDF). A list of angles, speeds, "
        "thicknesses, radii or coefficients of friction is the axis. A second list makes curves; "
        "two lists of more than 8 values make a map",
    )
    for name, program in (("fluent", "Ansys Fluent"), ("acusolve", "AcuTrace (AcuSolve)")):
        add(
            f"--{name}",
            metavar="FILE",
            help="write the restitution of the wall over these angles into FILE, in the "
            f"format that {program} documents; not tried in that program",
        )
    command.epilog = (
        f"--speed is that of the bead, whose normal part is speed cos(angle). {options.UNITS} "
        "Several values are a list, 10,20, or a range start:stop:count."
    )


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    within("angle", np.array(arguments.angle), 0.0, 89.999, "degrees from the normal")
    given = {name: getattr(arguments, name) for name in _GIVEN}
    if arguments.plot is not None:
        with chosen.plot_file(arguments):
            _plot(arguments, given)
        return
    for name in ("fluent", "acusolve"):
        if (path := getattr(arguments, name)) is not None:
            with wording.writing(name, path):
                _atomic.write(path, _traced(arguments, name, given).encode())
            print(path)
            return
    found = _table(arguments, given)
    if arguments.csv:
        impacts.write_csv(found, sys.stdout, _COLUMNS)
    else:
        print(*impacts.text(found, _COLUMNS), sep="\n")


def _table(arguments: argparse.Namespace, given: dict[str, Any]) -> ImpactTable:
    """All impacts, of which angles change fastest."""
    names = _GIVEN[::-1]
    parts = np.meshgrid(*(given[name] for name in names), indexing="ij")
    every = dict(zip(names, (part.ravel() for part in parts), strict=True))
    model = chosen.model(arguments)
    found = _hits(model, every, arguments.mass)
    columns = {column.name: found[column.name] for column in _COLUMNS}
    return ImpactTable(columns, found["flags"], impacts.asked(model, mass=arguments.mass))


def _hits(model: ImpactModel, given: dict[str, Array], mass: float | None) -> dict[str, Any]:
    """Columns of impacts by what is given of each. Few impacts need no table of the model."""
    angle, total, thickness, radius, friction = np.broadcast_arrays(*(given[n] for n in _GIVEN))
    inclined = np.radians(angle)
    speed, sliding = total * np.cos(inclined), total * np.sin(inclined)
    with wording.naming_impact(speed, radius, thickness, mass=mass):
        hit = model.oblique(speed, sliding, radius, thickness, friction, method="solve", mass=mass)
    changed = sliding - np.asarray(hit.sliding_speed)
    return {
        **vars(hit),
        **given,
        "spin": (1.0 - 1.0 / POINT) * changed / radius,
        "rebound_angle": np.degrees(np.arctan2(sliding - changed / POINT, hit.restitution * speed)),
    }


def _traced(arguments: argparse.Namespace, program: str, given: dict[str, Any]) -> str:
    """Write a wall for a program that traces particles."""
    angles = np.unique(given["angle"])
    others = {name: len(values) for name, values in given.items() if name != "angle"}
    if max(others.values()) > 1 or angles.size < 2:
        raise ArgumentError(
            program,
            None,
            f"got {angles.size} angles and of {', '.join(others)} "
            f"{', '.join(map(str, others.values()))} values; give one of each and at least two "
            "angles, best from 0 to 89",
        )
    # without sliding there is no tangential restitution, but it has a limit
    given = given | {"angle": np.maximum(angles, _STEEPEST)[::-1]}
    rows = _table(arguments, given).columns
    (speed,), (friction,) = arguments.speed, arguments.friction
    about = (
        f"{arguments.sphere} on {arguments.plate}, radius {drawn(*arguments.radius)}, "
        f"{plate_of(*arguments.thickness)}, {speed:g} m/s, friction {friction:g}, "
        f"law {arguments.law}, no spin before"
    )
    inclined = angles[::-1]
    write, place = {
        "fluent": (tracers.fluent, 90.0 - inclined),
        "acusolve": (tracers.acusolve, speed * np.cos(np.radians(inclined))),
    }[program]
    return write(about, VERSION, place, rows["restitution"], rows["tangential_restitution"])


def _plot(arguments: argparse.Namespace, given: dict[str, Any]) -> None:
    model = chosen.model(arguments)
    pair = model.pair

    def ask(grid: dict[str, Array]) -> layout.Answers:
        steep = {"angle": np.maximum(grid["angle"], _STEEPEST)}
        hit = _hits(model, grid | steep, arguments.mass)
        value = hit["tangential_restitution"]
        return layout.Answers(value, hit["flags"], hit["overload"], value, value)

    about = f"{pair.sphere.name} on {pair.plate.name}, law {arguments.law}, no spin before"
    label = "tangential restitution $v_t'/v_t$ [-]"
    subject = figure.Subject("Tangential restitution", label, about)
    figure.save(arguments.plot, subject, given, ask, along=120, across=41)
