"""``contactlaw oblique``: tangential rebound and spin of beads that come at an angle."""

from __future__ import annotations

import argparse
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw import _atomic, style
from contactlaw._version import VERSION
from contactlaw.cli.oblique import tracers
from contactlaw.cli.parts import chosen, impacts, options, plots, quantities, wording
from contactlaw.cli.parts.impacts import Column, ImpactTable
from contactlaw.equation.tangential import POINT
from contactlaw.physical.arguments import within

Array = NDArray[np.float64]

_STEEPEST = 0.01  # [deg] angle that stands for normal incidence
_COLUMNS = (
    Column("angle", "deg", "angle", "deg"),
    Column("friction", "", "friction"),
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
    options.add_sizes(command, quantities.value)
    options.add_name_of_law(command)
    command.set_defaults(outside="raise")  # every impact is integrated
    add = command.add_argument
    add("--speed", required=True, metavar="V",
        type=options.reader_of(quantities.value, quantities.SPEED),
        help="speed of the bead [m/s], or with a unit")  # fmt: skip
    add("--angle", required=True, metavar="A",
        type=options.reader_of(quantities.values, quantities.ANGLE),
        help="angle of incidence from the plate's normal [deg], from 0 to below 90")  # fmt: skip
    add("--friction", required=True, metavar="MU",
        type=options.reader_of(quantities.values, quantities.FRICTION),
        help="coefficient of friction between bead and plate")  # fmt: skip
    add = command.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print rows of all fields in SI units, every digit")
    add("--plot", metavar="FILE",
        help="draw the tangential restitution over the angle into FILE (PNG, SVG, PDF), a curve "
        "per coefficient of friction")  # fmt: skip
    for name, program in (("fluent", "Ansys Fluent"), ("acusolve", "AcuTrace (AcuSolve)")):
        add(f"--{name}", metavar="FILE",
            help="write the restitution of the wall over these angles into FILE, in a form that "
            f"{program} documents; it was not tried there")  # fmt: skip
    command.epilog = (
        f"--speed is that of the bead, whose normal part is speed cos(angle). {options.UNITS} "
        "Several angles and coefficients are a list, 10,20, or a range start:stop:count."
    )


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    angles, coefficients = np.array(arguments.angle), np.array(arguments.friction)
    within("angle", angles, 0.0, 89.999, "degrees from the normal")
    if arguments.plot is not None:
        with chosen.plot_file(arguments):
            _plot(arguments, angles, coefficients)
        return
    for name in ("fluent", "acusolve"):
        if (path := getattr(arguments, name)) is not None:
            with wording.file_of(name, path):
                _atomic.write(path, _traced(arguments, name, angles, coefficients).encode())
            print(path)
            return
    found = _table(arguments, angles, coefficients)
    if arguments.csv:
        impacts.write_csv(found, sys.stdout, _COLUMNS)
    else:
        print(*impacts.text(found, _COLUMNS), sep="\n")


def _table(arguments: argparse.Namespace, angles: Array, coefficients: Array) -> ImpactTable:
    """All impacts, of which angles change fastest. Few impacts need no table of the model."""
    friction, angle = (part.ravel() for part in np.meshgrid(coefficients, angles, indexing="ij"))
    inclined = np.radians(angle)
    speed, sliding = arguments.speed * np.cos(inclined), arguments.speed * np.sin(inclined)
    size = arguments.radius, arguments.thickness
    with wording.naming_impact(speed, np.full_like(speed, size[0]), np.full_like(speed, size[1])):
        model = chosen.model(arguments)
        hit = model.oblique(speed, sliding, *size, friction, method="solve")
    changed = sliding - np.asarray(hit.sliding_speed)
    found = {
        **vars(hit), "angle": angle, "friction": friction,
        "spin": (1.0 - 1.0 / POINT) * changed / arguments.radius,
        "rebound_angle": np.degrees(
            np.arctan2(sliding - changed / POINT, hit.restitution * speed)
        ),
    }  # fmt: skip
    columns = {column.name: found[column.name] for column in _COLUMNS}
    given = impacts.asked(model, speed=arguments.speed, radius=size[0], thickness=size[1])
    return ImpactTable(columns, found["flags"], given)


def _traced(arguments: argparse.Namespace, program: str, angles: Array, coefficients: Array) -> str:
    """Write a wall for a program that traces particles."""
    angles = np.unique(angles)
    if coefficients.size > 1 or angles.size < 2:
        raise ValueError(
            f"{program}: got {coefficients.size} coefficients and {angles.size} angles; give "
            "one coefficient of friction and at least two angles, best from 0 to 89"
        )
    # without sliding there is no tangential restitution, but it has a limit
    rows = _table(arguments, np.maximum(angles, _STEEPEST)[::-1], coefficients).columns
    about = (
        f"{arguments.sphere} on {arguments.plate}, radius {plots.length_of(arguments.radius)}, "
        f"{plots.plate_of(arguments.thickness)}, {arguments.speed:g} m/s, friction "
        f"{coefficients[0]:g}, law {arguments.law}, no spin before"
    )
    inclined = angles[::-1]
    write, place = {
        "fluent": (tracers.fluent, 90.0 - inclined),
        "acusolve": (tracers.acusolve, arguments.speed * np.cos(np.radians(inclined))),
    }[program]
    return write(about, VERSION, place, rows["restitution"], rows["tangential_restitution"])


def _plot(arguments: argparse.Namespace, angles: Array, coefficients: Array) -> None:
    angles, coefficients = np.unique(angles), np.unique(coefficients)
    if np.count_nonzero(angles) < 2:  # at an angle of 0 there is no tangential restitution
        raise ValueError("plot: give at least two angles above 0, best from 1 to 89")
    found = _table(arguments, angles, coefficients)
    rows, reasons = found.columns, plots.limits_of(found.flags)
    caption = (
        f"{arguments.sphere} on {arguments.plate}, radius {plots.length_of(arguments.radius)}, "
        f"{plots.plate_of(arguments.thickness)}, {arguments.speed:g} m/s, no spin before"
    )
    with style.applied():
        figure = style.figure(
            8.0, 5.2, "Tangential restitution over the angle of impact",
            f"{caption}. Dashed: {reasons}" if reasons else caption,
        )  # fmt: skip
        axes = figure.add_subplot()
        for n, friction in enumerate(coefficients):
            part = rows["friction"] == friction
            plots.curve(axes, rows["angle"][part], rows["tangential_restitution"][part],
                        found.flags[part], plots.colour_of(n, coefficients.size),
                        label=f"friction {friction:g}")  # fmt: skip
        axes.set(xlabel="angle of incidence from the normal [°]", xlim=(0, 90),
                 ylabel="tangential restitution $v_t'/v_t$ [-]")  # fmt: skip
        axes.set_ylim(top=1.0)
        axes.legend(loc="lower right")
        figure.savefig(arguments.plot)
