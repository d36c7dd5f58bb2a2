"""Models, materials and figures from the options that subcommands share."""

import argparse
import dataclasses
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from contactlaw._errors import ArgumentError
from contactlaw.cli.parts import own, plots, wording
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import scalars
from contactlaw.physical.pair import Pair


def model(arguments: argparse.Namespace) -> ImpactModel:
    """Model of the given materials, with errors of their own if there are such options, and law."""
    bodies = []
    for role, body in zip(("sphere", "plate"), pair(arguments).given, strict=True):
        errors = dict(getattr(arguments, f"{role}_error", ()))
        try:
            changed = dataclasses.replace(body, uncertainty={**body.uncertainty, **errors})
        except ValueError as error:
            raise ArgumentError(f"{role}_error", None, str(error)) from error
        for name in errors:
            if name not in changed.uncertainty:
                raise ArgumentError(f"{role}_error", name, f"{body.name!r} has none to be wrong")
        bodies.append(changed)
    return ImpactModel(Pair(*bodies), law=arguments.law, outside=arguments.outside)


def pair(arguments: argparse.Namespace, known: Pair | None = None) -> Pair:
    """Materials that the options name, otherwise those of the `known` pair of a record."""
    bodies = {}
    for name in ("sphere", "plate"):
        chosen = getattr(arguments, name)
        if chosen is None:
            if known is None:
                raise ArgumentError(name, None, "has to be given, no record says it")
            bodies[name] = getattr(known, name)
        else:
            bodies[name] = own.material_of(name, chosen, arguments.materials)
    return Pair(**bodies)


def check_quantities(arguments: argparse.Namespace) -> None:
    """Refuse values beyond their limits one by one, so that the message can name the value."""
    for name in ("speed", "radius", "thickness", "friction"):
        given = getattr(arguments, name, None)
        for value in () if given is None else np.atleast_1d(given).tolist():
            scalars(**{name: value})


@contextmanager
def plot_file(arguments: argparse.Namespace) -> Iterator[None]:
    """Refuse a file that cannot be drawn into before anything is computed; print its name after."""
    with wording.writing("plot", arguments.plot):
        wording.check_suffix("path", arguments.plot, plots.SUFFIXES)
        yield
    print(arguments.plot)
