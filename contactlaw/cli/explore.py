"""``contactlaw explore`` (pages): a page with sliders for a browser."""

from argparse import Namespace
from typing import Any

from contactlaw import export
from contactlaw.cli.parts import chosen, options, wording


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "a page for a browser: sliders, curves of the COR, energies, the force over time"
    command = options.command(commands, "explore", about, _run)
    options.add_pair(command)
    options.add_name_of_law(command)
    command.add_argument("--out", default="page.html", metavar="FILE", help="file to write (default: %(default)s)")


def _run(arguments: Namespace) -> None:
    model = chosen.model(arguments)
    with wording.writing("out", arguments.out):
        export.page(arguments.out, model)
    print(arguments.out)
