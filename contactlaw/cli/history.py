"""``contactlaw history``: force over time of one impact, as CSV or a plot."""

import argparse
import sys
from typing import Any, Literal

import numpy as np

from contactlaw import quantities, style
from contactlaw._readable import drawn
from contactlaw.cli.parts import chosen, impacts, options, wording
from contactlaw.cli.parts.plots import plate_of, save
from contactlaw.model import ImpactModel
from contactlaw.physical.history import ForceHistory
from contactlaw.physical.validity import explain, limits_in_words


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "force over time of one impact, as CSV or a plot"
    command = options.command(commands, "history", about, _run)
    options.add_impact(command, quantities.value)
    options.add_mass(command)
    options.add_wall(command)
    command.add_argument("--samples", type=int, default=256, metavar="N", help="number of rows (default: %(default)s)")
    command.add_argument("--plot", metavar="FILE", help="draw the force into FILE (PNG, SVG, PDF)")
    command.epilog = options.UNITS


def _run(arguments: argparse.Namespace) -> None:
    chosen.check_quantities(arguments)
    if arguments.plot is not None:
        with chosen.plot_file(arguments):
            _plot_history(arguments)
        return
    given = {name: getattr(arguments, name) for name in ("speed", "radius", "thickness", "mass")}
    model = chosen.model(arguments)
    contact = np.column_stack(_contact(arguments, model))
    asked = impacts.asked(model, **given)
    asked["plate"] = chosen.plate_in_words(arguments, asked["plate"])
    print(f"# {impacts.in_words(asked)}")
    print("time_s,force_N,compression_m,impulse_Ns,plate_displacement_m")
    np.savetxt(sys.stdout, contact, fmt="%.9g", delimiter=",")


def _contact(arguments: argparse.Namespace, model: ImpactModel) -> ForceHistory:
    """Force over time; flags are warnings on stderr, because the output is CSV alone."""
    impact = (arguments.speed, arguments.radius, arguments.thickness)
    method: Literal["solve", "table"] = "solve" if arguments.solve else "table"
    with wording.naming_impact(*impact, mass=arguments.mass):
        plate = chosen.wall(arguments, model.pair.given[1], arguments.thickness)
        found = model.force_history(*impact[:2], plate, arguments.samples, method, mass=arguments.mass)
    flags = int(found.flags)
    for name, words in zip(impacts.flag_names(flags), explain(flags), strict=True):
        wording.print_warning(f"{name}: {words}")
    return found


def _plot_history(arguments: argparse.Namespace) -> None:
    contact = _contact(arguments, chosen.model(arguments))
    title = (
        f"{arguments.sphere} on {chosen.plate_in_words(arguments, arguments.plate)}: radius {drawn(arguments.radius)}, "
        f"{plate_of(arguments.thickness)}, {arguments.speed:g} m/s"
    )
    _draw(contact, title, arguments.plot)


def _draw(contact: ForceHistory, title: str, path: str) -> None:
    """Draw force over time, and over compression; matplotlib is loaded here."""
    with style.applied():
        limits = "; ".join(limits_in_words(int(contact.flags)))
        caption = f"Beyond a limit: {limits}" if limits else "Inside every limit of the model"
        figure = style.figure(10.0, 5.2, title, caption)
        left, right = figure.subplots(1, 2, sharey=True)
        top = int(np.argmax(contact.force))
        parts = ((slice(top + 1), style.BLUE, "loading"), (slice(top, None), style.VERMILION, "unloading"))
        for part, colour, name in parts:
            left.plot(contact.time[part] * 1e6, contact.force[part], color=colour, linewidth=2.2)
            right.plot(contact.compression[part] * 1e6, contact.force[part], color=colour, linewidth=2.2, label=name)
        left.set(xlabel="time since touch [µs]", ylabel="contact force [N]", ylim=(0.0, None))
        left.set_xlim(0.0, 1.02 * contact.time[-1] * 1e6)
        plate = left.twinx()
        plate.plot(contact.time * 1e6, contact.plate_displacement * 1e6, color=style.MUTED, linestyle="--")
        plate.set_ylabel("plate moves [µm] (dashed)", color=style.MUTED)
        plate.set_ylim(0.0, None)
        plate.grid(visible=False)
        plate.spines["right"].set_visible(True)
        right.set(xlabel="compression [µm]", xlim=(0.0, None))
        right.legend(loc="upper left")
        save(figure, path)
