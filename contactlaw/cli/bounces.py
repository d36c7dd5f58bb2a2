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
from contactlaw.cli.parts import chosen, columns, options, own, wording
from contactlaw.cli.parts.plots import save
from contactlaw.fitting.bounces import Bounces, bounces, loudest, of_times
from contactlaw.quantities import TIME

_LARGEST = 1e8  # [bytes] of a recording, our choice; two minutes of two channels have 2e7
_POINTS = 4000  # of the sound that is drawn
_TIME = {"time": columns.TextColumn(("time", "t", "at", "bounce_time", "bounce", "bounces"), TIME)}


def add(commands: Any) -> None:
    """Add the subcommand and its options."""
    about = "speeds and CORs of a bouncing bead from a recording, as a table for fit"
    command = options.command(commands, "bounces", about, _run)
    what = "recording (.wav) of drops onto a plate, or the times of one drop's bounces (.csv with a column time_s)"
    command.add_argument("sound", metavar="FILE", help=what)
    options.add_drop(command, quantities.value, "which gives the first bounce a COR, too (default: unknown)")
    options.add_radius(command, "the bead", quantities.value)
    command.add_argument("--sphere", metavar="NAME", help="material of the bead: takes the air off, with its size")
    options.add_materials(command)
    command.add_argument(
        "--plot", metavar="FILE", help="draw sound, bounces and CORs into FILE (PNG, SVG, PDF) instead"
    )
    command.epilog = options.UNITS


def _run(arguments: argparse.Namespace) -> None:
    if arguments.plot is None:
        _print(_heard(arguments)[0], arguments.radius)
        return
    with chosen.plot_file(arguments):
        _draw(*_heard(arguments), arguments)


def _heard(arguments: argparse.Namespace) -> tuple[Bounces, float, Array]:
    """Bounces in a file, the time between two samples of its sound [s], and these."""
    chosen.check_quantities(arguments)
    path, known, lines = Path(arguments.sound), dict[str, float](), list[int]()
    if (arguments.sphere is None) != (arguments.radius is None):
        raise ArgumentError("sphere, radius", None, "the air is taken off with both, and left in without both")
    if arguments.sphere is not None:
        density = own.material_of("sphere", arguments.sphere, arguments.materials).density
        known = {"radius": arguments.radius, "density": density}
    samples, rate = np.empty(0), 1.0
    try:
        if path.suffix.lower() in (".csv", ".tsv", ".txt"):
            with wording.reading(path):
                lines, times = _times(content_of(path, LARGEST_TEXT, pipe=True))
            found = of_times(times, arguments.drop, **known)
        else:
            with wording.reading(path):
                rate, samples = _samples(content_of(path, _LARGEST), path)
            found = bounces(samples, rate, arguments.drop, **known)
    except ArgumentError as error:
        if error.name in vars(arguments):
            raise
        at = "" if error.element is None or error.name != "times" else f", line {lines[error.element]}"
        complaint = error.complaint if error.name in ("samples", "times") else error
        raise ValueError(f"{path}{at}: {complaint}") from None
    if not known:
        wording.print_warning("the air is left in, which slows small beads: --sphere and --radius take it off")
    return found, 1.0 / rate, samples


def _times(content: bytes) -> tuple[list[int], Array]:
    """Lines of a table, and their times [s]."""
    names, rows, delimiter = columns.split_table(content)
    if not (place := columns.locate(names, _TIME).get("time")):
        raise ValueError(f"no column of times in its first line, {', '.join(names)[:200]!r}: call it time_s")
    lines, table = columns.numbers(rows, delimiter, names, [place.place])
    return lines, table[:, 0] / place.per_unit


def _samples(content: bytes, path: Path) -> tuple[float, Array]:
    """Take the samples in a second, and these, from the content of a file."""
    if not content.startswith((b"RIFF", b"RIFX", b"RF64")):
        raise ValueError(f"takes WAV, or .csv of times: ffmpeg -i {path.name} {path.stem}_new.wav")
    from scipy.io import wavfile

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", wavfile.WavFileWarning)  # of chunks about the telephone
        rate, samples = wavfile.read(io.BytesIO(content))
    return rate, loudest(samples)


def _print(found: Bounces, radius: float | None) -> None:
    """Print a table that `contactlaw fit` takes, with a remark behind each row."""
    shown = {"speed_m/s": found.speed, "COR": found.restitution, "COR_error": found.restitution_error}
    shown["radius_m"] = None if radius is None else np.full(found.at.size, radius)
    table = {name: values for name, values in shown.items() if values is not None}
    print(",".join(table))
    for at, drop, *row in zip(found.at, found.drop, *table.values(), strict=True):
        print(f"{','.join(f'{one:.6g}' for one in row)}  # drop {drop + 1}, at {at:.4f} s")


def _draw(found: Bounces, step: float, x: Array, arguments: argparse.Namespace) -> None:
    with style.applied():
        caption = f"{found.at.size} CORs; triangles: impacts; bars: standard errors"
        figure = style.figure(10.0, 6.4, Path(arguments.sound).name, caption)
        above, below = figure.subplots(2, 1)
        if x.size:
            x = x - x.mean()
            starts = np.linspace(0, x.size - 1, min(_POINTS, x.size)).astype(int)
            low, top = (part.reduceat(x / abs(x).max(), starts) for part in (np.minimum, np.maximum))
            above.fill_between(starts * step, low, top, color=style.MUTED, linewidth=0.4)
        for n, impacts in enumerate(found.impacts):
            colour = (style.BLUE, style.VERMILION, style.GREEN, style.PURPLE)[n % 4]
            above.plot(impacts, np.full(impacts.size, 1.12), "v", color=colour)
            one = found.drop == n
            bars = None if found.restitution_error is None else found.restitution_error[one]
            below.errorbar(found.speed[one], found.restitution[one], bars, fmt="o", color=colour, label=f"drop {n + 1}")
        first, last = min(one[0] for one in found.impacts), max(one[-1] for one in found.impacts)
        above.set(xlabel="time [s]", ylabel="sound over its peak", xlim=(first - 0.2, last + 0.2), ylim=(-1.05, 1.25))
        below.set(xlabel="impact speed [m/s]", ylabel="COR [-]", xlim=(0.0, None))
        below.legend(loc="best")
        save(figure, arguments.plot)
