"""From a command to its folder: simulate, print, draw, and move all files."""

from __future__ import annotations

import math
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from contactlaw import _atomic, style
from contactlaw._readable import scale_of
from contactlaw._version import VERSION
from contactlaw.reporting import page as common
from contactlaw.reporting import run as of_any_run
from contactlaw.reporting import summary as tables
from dem_demo.kit.run import Run, Runs
from dem_demo.kit.scene import Facts
from dem_demo.kit.signals import Interrupted

FORESEEN = Interrupted, OSError, ValueError, RuntimeError  # their messages suffice: no traceback
_WIDTH = 42


class Show(NamedTuple):
    """What draws a scene, and what its page has beside that of other scenes."""

    figures: Sequence[ModuleType]  # each has `draw(runs)`; its docstring is the caption
    package: str = "dem_demo.kit"  # that has the template page.html
    data: Callable[[Any], Mapping[str, Any]] = lambda runs: {}  # for the template


def deliver(out: Path, show: Show, simulate: Callable[[Path], tuple[list[Run[Any]], BaseException | None]]) -> int:
    """Simulate a scene and write its files.

    Of a run that has not come to its end, with all its figures, the records alone are kept, as
    ``*-partial.h5``: what they have until then is whole, and an earlier run in the folder stays as
    it is. The next one that comes to its end removes them.
    """
    with _atomic.folder(out) as folder:
        text = ""
        runs, stop = simulate(folder)
        if stop is None:
            try:
                text = f"{summary(runs)}\n"
                make(show, runs, text, folder)
            except (Exception, Interrupted) as error:
                text, stop = "", error
        if stop is not None:
            for file in list(folder.iterdir()):
                if file.suffix == ".h5":
                    file.rename(_partial(file))
                else:
                    file.unlink()
        written = sorted(file.name for file in folder.iterdir())
        if not written:
            assert stop is not None
            raise stop
    if stop is None:
        for name in written:
            _partial(out / name).unlink(missing_ok=True)
    print(f"{text}\nWritten to {out}: {', '.join(written)}", flush=True)
    if stop is None:
        return 0
    if not isinstance(stop, FORESEEN):
        traceback.print_exception(stop)
    print(f"dem-demo: stopped: {sentence(stop)}", file=sys.stderr)
    return int(getattr(stop, "exit_status", 1))


def _partial(record: Path) -> Path:
    return record.with_stem(f"{record.stem}-partial")


def sentence(error: BaseException) -> str:
    """Say what went wrong, and at which impact if that is known."""
    where = "; ".join(getattr(error, "__notes__", []))
    text = str(error) or type(error).__name__
    return f"{where}: {text}" if where else text


def make(show: Show, runs: Runs[Any], text: str, folder: Path) -> None:
    """Make all files of a run but the records, the summary first."""
    (folder / "summary.txt").write_text(text, encoding="utf-8")
    modules, pictures = {module.__name__.rpartition(".")[2]: module for module in show.figures}, {}
    for name, module in sorted(modules.items()):
        with style.applied():
            pictures[name] = style.png(module.draw(runs))
        (folder / f"{name}.png").write_bytes(pictures[name])
    run, (what, how) = runs[0], title(runs[0])
    made, engine = run.record.made, run.record.made["engine"]
    page = common.template(show.package, "page.html").render(
        run.scene.PAGE,
        title=f"{run.scene.PAGE['heading']}: what contactlaw gives a particle simulation",
        facts=(what, f"{how}."),
        name=run.scene.NAME,
        measured=_columns(runs),
        impacts=of_any_run.Run(run.record),
        summary=tables,
        figures=common.shown(modules, pictures),
        command=run.making.command,
        law=run.law,
        source=run.model.force_law.source,
        made=common.made({"contactlaw": VERSION, engine: made["version_engine"]}),
        **show.data(runs),
    )
    (folder / "index.html").write_text(page, encoding="utf-8")


def title(run: Run[Any]) -> tuple[str, str]:
    """Title in two lines: beads and walls; duration or motion, engine, contacts, law and seed."""
    (what, how), made = run.scene.title(), run.record.made
    ranks, softening = made.get("ranks", 1), made.get("softening", 1.0)
    engine = f"in {made['engine']}" + f" on {ranks} ranks" * (ranks > 1)
    if softening > 1.0:
        engine += f", contacts softened {softening:g} times (overlaps to {_overlap(run, softening):.1%} of the radius)"
    return what, f"{how}, friction {run.scene.friction:g}, {engine}, law {run.law}, seed {run.scene.seed}"


def _overlap(run: Run[Any], softening: float) -> float:
    """Largest overlap [radius], with the energy of the fastest impact in a spring of Hertz."""
    pressure = run.scene.sphere_material.density * run.impacts["approach_speed"].max(initial=0.0) ** 2
    return float((1.25 * math.pi * softening * pressure / run.model.pair.effective_modulus) ** 0.4)


def summary(runs: Runs[Any]) -> str:
    """Write the summary: each run, and that under the law as `contactlaw report` has it."""
    columns = [[name.ljust(_WIDTH), *(f"{value:>18}" for value in values)] for name, *values in _columns(runs)]
    return "\n".join([*title(runs[0]), "", *map("".join, columns), "", tables.text(of_any_run.Run(runs[0].record))])


def _columns(runs: Runs[Any]) -> list[list[str]]:
    """Names of the facts, and their values in each run."""
    columns = [dict(facts(run)) for run in runs]
    return [[name, *(column.get(name, "-") for column in columns)] for name in columns[0]]


def facts(run: Run[Any]) -> Facts:
    """Names and values of all facts of a run."""
    wall, energy = run.scene.WALL, run.account
    unit, scale = scale_of(energy.start[-1], "J")  # the same for all runs

    def written(part: float) -> str:
        return f"{part / scale:z.1f} {unit}".replace("u", "µ")

    middle = np.median(run.impacts["restitution"]) if run.impacts.size else np.nan
    return [
        ("", run.name),
        (f"impacts on the {wall}", f"{run.impacts.size}"),
        ("  median COR", f"{middle:.3f}"),
        (f"dissipated at the {wall}", written(run.dissipated.sum())),
        ("  bending wave in the plate", written(energy.wave[-1])),
        ("  lost at the contact", written(energy.plastic[-1])),
        (f"friction on the {wall}", written(energy.friction[-1])),
        ("beads on beads", written(energy.others[-1])),
        (f"work of the {wall} on the beads", written(energy.walls[-1])),
        ("work of gravity on the beads", written(energy.gravity[-1])),
        ("kinetic energy at the start", written(energy.start[-1])),
        ("kinetic energy at the end", written(energy.moving[-1])),
        *run.scene.facts(run),
        ("simulated", f"{run.time[-1] * 1e3:.0f} ms"),
        ("computed in", f"{run.elapsed[-1]:.0f} s"),
    ]
