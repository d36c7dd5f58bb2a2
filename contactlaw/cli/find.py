"""``contactlaw find`` (ask): the thicknesses of the plate, or the impact speeds, that give a COR."""

import functools
import itertools
import sys
from argparse import Namespace
from typing import Any

import numpy as np

from contactlaw import quantities
from contactlaw._arrays import Array
from contactlaw.cli.parts import chosen, options, wording
from contactlaw.cli.parts.impacts import COLUMNS
from contactlaw.cli.parts.table import Table, in_words
from contactlaw.physical.plates import Layers
from contactlaw.quantities import SHARE

_KNOWN = {"thickness": ("speed", "radius"), "speed": ("radius", "thickness")}


def add(commands: Any) -> None:
    """Add the subcommand, and what it finds as subcommands of its own."""
    about = "the thicknesses of the plate, or the impact speeds, that give a COR"
    unknowns = options.group(commands, "find", about, "UNKNOWN", "what to find: thickness or speed")
    for unknown, whole in (("thickness", "thicknesses of the plate"), ("speed", "impact speeds")):
        command = options.command(
            unknowns, unknown, f"find all {whole} that give a COR", functools.partial(_run, unknown)
        )
        options.add_pair(command)
        options.add_sizes(command, quantities.values, unknown=unknown)
        what = "COR to reach, between 0 and 1"
        options.add_quantity(command, "--cor", SHARE, what, quantities.values, required=True, metavar="E")
        if unknown == "thickness":
            options.add_speed(command, quantities.values)
            options.add_layers(command)
        options.add_name_of_law(command)
        options.add_forms(command)
        command.epilog = f"{options.UNITS} {options.LISTS}"


def _run(unknown: str, arguments: Namespace) -> None:
    chosen.take_drops(arguments)
    model, known = chosen.model(arguments), _KNOWN[unknown]
    layers: dict[str, Any] = {}
    if below := [chosen.layer(text, arguments.materials) for text in getattr(arguments, "on", ())]:
        layers["plate"] = lambda thickness: Layers([(model.pair.given[1], thickness), *below])
    questions = np.array([*itertools.product(arguments.cor, *(getattr(arguments, name) for name in known))])
    answers: Any = getattr(model, unknown)(*questions.T, **layers)
    remarks = [
        f"{in_words(chosen.asked(arguments, model, **dict(zip(known, sizes, strict=True))))}, COR {cor:g}: {one.remark}"
        for (cor, *sizes), one in zip(questions.tolist(), answers, strict=True)
        if one.remark
    ]
    if len(remarks) == len(questions):
        raise ValueError("\n".join(remarks))
    for remark in remarks:
        wording.print_warning(remark)

    _table(unknown, questions, answers, chosen.asked(arguments, model)).write(sys.stdout, arguments.form)


def _table(unknown: str, questions: Array, answers: Any, asked: dict[str, Any]) -> Table:
    """Table of all solutions."""
    value, flags = (np.concatenate([getattr(one, name) for one in answers]) for name in ("value", "flags"))
    names = "restitution", *_KNOWN[unknown], unknown
    of_each = np.repeat(questions, [one.value.size for one in answers], axis=0)
    by_name = {column.name: column for column in COLUMNS}
    inputs = (by_name[name]._replace(is_input=True, digits=".4g") for name in names[:-1])
    columns = [*inputs, by_name[unknown]._replace(is_input=False)]
    return Table(columns, dict(zip(names, [*of_each.T, value], strict=True)), asked, flags)
