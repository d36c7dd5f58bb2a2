"""``contactlaw bounces``: speeds and CORs of a bouncing bead from a recording, as a table for ``fit``."""

import argparse
import io
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from contactlaw import quantities, style
from contactlaw._arrays import Array
from contactlaw._content import LARGEST_TEXT, content_of
from contactlaw._errors import ArgumentError
from contactlaw._readable import in_unit
from contactlaw.cli.parts import chosen, columns, options, own, wording
from contactlaw.cli.parts.columns import TextColumn
from contactlaw.cli.parts.plots import colour_of, save
from contactlaw.fitting.bounces import Bounces, bounces, of_times
from contactlaw.quantities import TIME

_LARGEST = 1e8  # [bytes] of a recording, our choice: two minutes with two channels have 46e6
_POINTS = 4000  # of the sound that is drawn
_TIME = {"time": TextColumn(("time", "t", "at", "bounce_time", "bounce", "bounces"), TIME)}


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "speeds and CORs of a bouncing bead from a recording, as a table for fit"
    command = options.command(commands, "bounces", about, _run)
    what = "recording (.wav) of drops onto a plate, or the times of one drop's bounces (.csv with a column time_s)"
    command.add_argument("sound", metavar="FILE", help=what)
    then = "of which the first bounce then has a COR, too (default: not known)"
    options.add_drop(command, quantities.value, then)
    options.add_radius(command, "the bead", quantities.value)
    command.add_argument("--sphere", metavar="NAME", help="material of the bead, by whose drag the air is taken off")
    options.add_materials(command)
    command.add_argument(
        "--plot", metavar="FILE", help="draw sound, bounces and CORs into FILE (PNG, SVG, PDF) instead"
    )
    command.epilog = options.UNITS


def _run(arguments: argparse.Namespace) -> None:
    if (arguments.sphere is None) != (arguments.radius is None):
        raise ArgumentError("sphere, radius", None, "the air is taken off with both, or left in without them")
    air: dict[str, Any] = {}
    if arguments.sphere is not None:
        sphere = own.material_of("sphere", arguments.sphere, arguments.materials)
        air = {"radius": arguments.radius, "density": sphere.density}
    if arguments.plot is None:
        found, _ = _heard(arguments, air)
        _print(found, arguments)
        return
    with chosen.plot_file(arguments):
        found, sound = _heard(arguments, air)
        _draw(found, sound, arguments)


def _heard(arguments: argparse.Namespace, air: dict[str, Any]) -> tuple[Bounces, tuple[float, Array]]:
    """Bounces in a file, and its sound with the time between two samples."""
    path, suffix = Path(arguments.sound), Path(arguments.sound).suffix.lower()
    if suffix not in (".wav", ".csv", ".tsv", ".txt"):
        raise ValueError(f"{path}: takes .wav, or .csv of times; `ffmpeg -i {path.name} {path.stem}.wav` converts it")
    with wording.reading(path):
        if suffix != ".wav":
            return of_times(_times(content_of(path, LARGEST_TEXT, pipe=True)), arguments.drop, **air), (
                1.0,
                np.empty(0),
            )
        try:
            from scipy.io import wavfile
        except ImportError as error:
            raise ImportError("recordings need scipy: pip install 'contactlaw[fit]'") from error
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)  # of chunks about the telephone
            rate, samples = wavfile.read(io.BytesIO(content_of(path, _LARGEST)))
        try:
            found = bounces(samples, rate, arguments.drop, **air)
        except ArgumentError as error:
            if error.name != "samples":
                raise
            raise ValueError(error.complaint) from None
    if not air:
        wording.print_warning("the air is left in, which slows small beads: take it off with --sphere and --radius")
    return found, (1.0 / rate, samples if samples.ndim == 1 else samples.mean(axis=1))


def _times(content: bytes) -> Array:
    names, rows, delimiter = columns.split_table(content)
    found = columns.locate(names, _TIME)
    if not found:
        raise ValueError(f"no column of times in its first line, {', '.join(names)[:200]!r}: call it time_s")
    _, table = columns.numbers(rows, delimiter, names, [found["time"].place])
    times: Array = table[:, 0] / found["time"].per_unit
    return times


def _print(found: Bounces, arguments: argparse.Namespace) -> None:
    """Print a table that `contactlaw fit` takes, where remarks follow each row."""
    names, values = ["speed_m/s", "COR"], [found.speed, found.restitution]
    if found.restitution_error is not None:
        names, values = [*names, "COR_error"], [*values, found.restitution_error]
    if arguments.radius is not None:
        names, values = [*names, "radius_m"], [*values, np.full(found.at.size, arguments.radius)]
    print(",".join(names))
    for at, drop, *row in zip(found.at, found.drop, *values, strict=True):
        print(f"{','.join(f'{one:.6g}' for one in row)}  # drop {drop + 1}, at {at:.4f} s")


def _draw(found: Bounces, sound: tuple[float, Array], arguments: argparse.Namespace) -> None:
    step, x = sound
    with style.applied():
        fell = "" if arguments.drop is None else f", dropped from {in_unit(arguments.drop, 'm')}"
        caption = f"{found.at.size} CORs of {len(found.impacts)} drop{'s' * (len(found.impacts) > 1)}{fell}"
        air = "air taken off" if arguments.radius else "air left in"
        figure = style.figure(10.0, 6.4, Path(arguments.sound).name, f"{caption}; {air}. Bars: standard errors")
        above, below = figure.subplots(2, 1)
        if x.size:
            ends = np.linspace(0, x.size, min(_POINTS, x.size) + 1).astype(int)[:-1]
            top, low = (part.reduceat(x / np.abs(x).max(), ends) for part in (np.maximum, np.minimum))
            above.fill_between(ends * step, low, top, color=style.MUTED, linewidth=0.4)
        for n, impacts in enumerate(found.impacts):
            colour = colour_of(n, len(found.impacts)) if n else style.BLUE
            above.plot(impacts, np.full(impacts.size, 1.12), "v", color=colour, label=f"drop {n + 1}")
            one = found.drop == n
            bars = None if found.restitution_error is None else found.restitution_error[one]
            below.errorbar(found.speed[one], found.restitution[one], bars, fmt="o", color=colour, elinewidth=1.3)
        first, last = min(one[0] for one in found.impacts), max(one[-1] for one in found.impacts)
        above.set(
            xlabel="time [s]", ylabel="sound over its largest", xlim=(first - 0.2, last + 0.2), ylim=(-1.05, 1.25)
        )
        below.set(xlabel="impact speed [m/s]", ylabel="COR [-]", xlim=(0.0, None))
        if len(found.impacts) > 1:
            above.legend(loc="lower right", ncols=4)
        save(figure, arguments.plot)
