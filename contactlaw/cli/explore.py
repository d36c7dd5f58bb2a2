"""``contactlaw explore``: a page with sliders for a browser."""

from __future__ import annotations

import argparse
from typing import Any

from contactlaw import export
from contactlaw.cli.parts import chosen, options, wording
from contactlaw.model import ImpactModel
from contactlaw.physical.rate import rated


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "a page for a browser: sliders, curves, energy, one hit in slow motion"
    command = options.command(commands, "explore", about, _run)
    options.add_pair(command)
    options.add_name_of_law(command)
    command.add_argument("--out", default="page.html", metavar="FILE",
                         help="file to write (default: %(default)s)")  # fmt: skip


def _run(arguments: argparse.Namespace) -> None:
    model = ImpactModel(chosen.pair(arguments), law=arguments.law)
    for role in ("sphere", "plate"):
        body = getattr(model.pair, role)
        if body.rate and rated(model.pair, model.force_law):
            raise wording.Refused(
                f"--{role}: the strength of {body.name!r} grows with the rate of strain, and a "
                "page has one law for all speeds: give --materials a file with an entry without "
                f'rate, that says like = "{body.name}" and yield_strength'
            )
    with wording.file_of("out", arguments.out):
        export.page(arguments.out, model)
    print(arguments.out)
