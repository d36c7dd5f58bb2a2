"""``contactlaw cor --history``: force over time of one impact, as CSV or a plot."""

import argparse
import io
import sys

import numpy as np

from contactlaw import _atomic
from contactlaw._errors import ArgumentError
from contactlaw.cli.parts import chosen, impacts, wording
from contactlaw.cli.parts.figure import Curve, Figure
from contactlaw.cli.parts.table import flag_names, in_words
from contactlaw.model import ImpactModel
from contactlaw.physical.history import ForceHistory
from contactlaw.physical.validity import explain

_SAMPLES = 256
_HEAD = "time_s,force_N,compression_m,impulse_Ns,plate_displacement_m"


def run(arguments: argparse.Namespace) -> None:
    """Print, write or draw the force; flags are warnings on stderr, because the output is CSV alone."""
    sizes = {name: _single(arguments, name) for name in ("speed", "radius", "thickness")}
    model = chosen.model(arguments)
    asked = impacts.asked(model, **sizes, mass=arguments.mass)
    asked["plate"] = chosen.plate_in_words(arguments, asked["plate"])
    about = in_words(asked)
    if arguments.plot is not None:
        with chosen.plot_file(arguments):
            _draw(_contact(arguments, model, sizes), about, arguments.plot)
    elif arguments.out is not None:
        with wording.writing("out", arguments.out):
            wording.check_suffix("out", arguments.out, (".csv",))
            _atomic.write(arguments.out, _csv(_contact(arguments, model, sizes), about).encode())
        print(arguments.out)
    else:
        sys.stdout.write(_csv(_contact(arguments, model, sizes), about))


def _single(arguments: argparse.Namespace, name: str) -> float:
    values: tuple[float, ...] = getattr(arguments, name)
    if len(values) > 1:
        raise ArgumentError(name, None, f"got {len(values)} values; --history takes one")
    return values[0]


def _contact(arguments: argparse.Namespace, model: ImpactModel, sizes: dict[str, float]) -> ForceHistory:
    """Integrate one impact, which needs no table."""
    samples = _SAMPLES if arguments.samples is None else arguments.samples
    with wording.naming_impact(**sizes, mass=arguments.mass):
        plate = chosen.wall(arguments, model.pair.given[1], sizes["thickness"])
        contact = model.force_history(sizes["speed"], sizes["radius"], plate, samples, "solve", mass=arguments.mass)
    flags = int(contact.flags)
    for name, words in zip(flag_names(flags), explain(flags), strict=True):
        wording.print_warning(f"{name}: {words}")
    return contact


def _csv(contact: ForceHistory, about: str) -> str:
    text = io.StringIO()
    np.savetxt(text, np.column_stack(contact), fmt="%.9g", delimiter=",", header=f"# {about}\n{_HEAD}", comments="")
    return text.getvalue()


def _draw(contact: ForceHistory, about: str, path: str) -> None:
    curve = Curve(contact.time, contact.force, flags=np.full(contact.time.size, int(contact.flags)))
    Figure("Contact force", about, "time", "force", [curve]).save(path)
