"""``contactlaw oblique``: tangential rebound and spin of beads that come at an angle."""

from __future__ import annotations

import argparse
import csv
import sys
from decimal import Decimal
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlaw import style
from contactlaw.cli.parts import chosen, impacts, options, plots, quantities, wording
from contactlaw.cli.parts.quantities import Quantity
from contactlaw.physical.arguments import within
from contactlaw.physical.validity import count_flags

Array = NDArray[np.float64]

_ANGLE = Quantity(
    "angle", {"deg": Decimal(1), "rad": Decimal(180) / Decimal(np.pi), "°": Decimal(1)}
)
_FRICTION = quantities.SHARE._replace(name="coefficient of friction")
# Columns: SI unit, and title on a terminal; a column without one is not shown there.
_COLUMNS = {
    "angle": ("deg", "angle"),
    "friction": ("", "friction"),
    "restitution": ("", "COR"),
    "tangential_restitution": ("", "tangential"),
    "rotational_restitution": ("", "rotational"),
    "impulse_ratio": ("", "J_t/J_n"),
    "sliding_speed": ("m/s", ""),
    "spin": ("rad/s", "spin"),
    "rebound_angle": ("deg", "leaves at"),
    "friction_energy": ("J", ""),
}


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
    add("--angle", required=True, metavar="A", type=options.reader_of(quantities.values, _ANGLE),
        help="angle of incidence from the plate's normal [deg], from 0 to below 90")  # fmt: skip
    add("--friction", required=True, metavar="MU",
        type=options.reader_of(quantities.values, _FRICTION),
        help="coefficient of friction between bead and plate")  # fmt: skip
    add = command.add_mutually_exclusive_group().add_argument
    add("--csv", action="store_true", help="print rows of all fields in SI units, every digit")
    add("--plot", metavar="FILE",
        help="draw the tangential restitution over the angle into FILE (PNG, SVG, PDF), a curve "
        "per coefficient of friction")  # fmt: skip
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
            _plot(arguments, _rows(arguments, angles, coefficients)[0], coefficients)
        return
    rows, flags = _rows(arguments, angles, coefficients)
    if arguments.csv:
        writer = csv.writer(sys.stdout, lineterminator="\n")
        header = (name + f"_{unit}" * bool(unit) for name, (unit, _) in _COLUMNS.items())
        writer.writerow([*header, "flags"])
        named = ("|".join(impacts.flag_names(flag)) for flag in flags)
        columns = (rows[name].tolist() for name in _COLUMNS)
        writer.writerows([*row, last] for *row, last in zip(*columns, named, strict=True))
        return
    cells = [
        [title, f"[{unit or '-'}]", *(f"{value:.4g}" for value in rows[name])]
        for name, (unit, title) in _COLUMNS.items()
        if title
    ]
    cells.append(["flags", "", *map(", ".join, map(impacts.flag_names, flags))])
    print(*impacts.aligned(cells), *impacts.explained(count_flags(flags), len(flags)), sep="\n")


def _rows(
    arguments: argparse.Namespace, angles: Array, coefficients: Array
) -> tuple[dict[str, Array], NDArray[np.int64]]:
    """Columns and flags of all impacts; angles change fastest. Few impacts need no table."""
    friction, angle = (part.ravel() for part in np.meshgrid(coefficients, angles, indexing="ij"))
    inclined = np.radians(angle)
    speed, sliding = arguments.speed * np.cos(inclined), arguments.speed * np.sin(inclined)
    size = arguments.radius, arguments.thickness
    with wording.naming_impact(speed, np.full_like(speed, size[0]), np.full_like(speed, size[1])):
        hit = chosen.model(arguments).oblique(speed, sliding, *size, friction, method="solve")
    along = sliding - (sliding - np.asarray(hit.sliding_speed)) / 3.5
    found = {
        **vars(hit), "angle": angle, "friction": friction,
        "spin": 2.5 * (sliding - along) / arguments.radius,
        "rebound_angle": np.degrees(np.arctan2(along, hit.restitution * speed)),
    }  # fmt: skip
    return found, found["flags"]


def _plot(arguments: argparse.Namespace, rows: dict[str, Array], coefficients: Array) -> None:
    with style.applied():
        figure = style.figure(
            8.0, 5.2, "Tangential restitution over the angle of impact",
            f"{arguments.sphere} on {arguments.plate}, radius {plots.length_of(arguments.radius)}, "
            f"{plots.plate_of(arguments.thickness)}, {arguments.speed:g} m/s, no spin before",
        )  # fmt: skip
        axes = figure.add_subplot()
        for n, friction in enumerate(coefficients):
            part = rows["friction"] == friction
            axes.plot(rows["angle"][part], rows["tangential_restitution"][part], linewidth=2.4,
                      color=plots.colour_of(n, coefficients.size),
                      label=f"friction {friction:g}")  # fmt: skip
        axes.set(xlabel="angle of incidence from the normal [°]", xlim=(0, 90),
                 ylabel="tangential restitution $v_t'/v_t$ [-]")  # fmt: skip
        axes.set_ylim(top=1.0)
        axes.legend(loc="lower right")
        figure.savefig(arguments.plot)
