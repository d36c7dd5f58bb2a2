"""``contactlaw history``: force over time of one impact, as CSV or a plot."""

from __future__ import annotations

import argparse
import sys
from typing import Any, Literal

import numpy as np

from contactlaw.cli.parts import chosen, impacts, options, plots, quantities, wording
from contactlaw.cli.parts.quantities import LENGTH, formatted
from contactlaw.physical.history import ForceHistory
from contactlaw.physical.validity import explain


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "force over time of one impact, as CSV or a plot"
    command = options.command(commands, "history", about, _run)
    options.add_impact(command, quantities.value)
    command.add_argument("--samples", type=int, default=256, metavar="N",
                         help="number of times (default: %(default)s)")  # fmt: skip
    command.add_argument("--plot", metavar="FILE", help="draw into FILE (PNG, SVG, PDF)")
    command.epilog = options.UNITS


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    if arguments.plot is not None:
        with chosen.plot_file(arguments):
            _plot_history(arguments)
        return
    contact = np.column_stack(_contact(arguments))
    print("time_s,force_N,compression_m,impulse_Ns,plate_displacement_m")
    np.savetxt(sys.stdout, contact, fmt="%.9g", delimiter=",")


def _contact(arguments: argparse.Namespace) -> ForceHistory:
    """Force over time; flags are warnings on stderr, because the output is CSV alone."""
    impact = (arguments.speed, arguments.radius, arguments.thickness)
    method: Literal["solve", "table"] = "solve" if arguments.solve else "table"
    model = chosen.model(arguments)
    with wording.naming_impact(*impact):
        found = model.force_history(*impact, arguments.samples, method)
        rebound = model.solve(*impact) if arguments.solve else model.lookup(*impact)
    flags = int(rebound.flags)
    for name, words in zip(impacts.flag_names(flags), explain(flags), strict=True):
        wording.print_warning(f"{name}: {words}")
    return found


def _plot_history(arguments: argparse.Namespace) -> None:
    contact = _contact(arguments)
    radius, thickness = (
        formatted(size, LENGTH) for size in (arguments.radius, arguments.thickness)
    )
    title = (
        f"{arguments.sphere} on {arguments.plate}: radius {radius}, plate {thickness}, "
        f"{arguments.speed:g} m/s"
    )
    plots.save_history(contact, title, arguments.plot)
