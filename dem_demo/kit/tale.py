"""Texts and facts of a bed's scene, and the summary and the page that are made of them."""

from __future__ import annotations

import base64
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw import ImpactModel
from contactlaw._readable import scale_of
from contactlaw.reporting import page as common
from contactlaw.reporting.limits import exceeded, limits_lines
from dem_demo.kit.measure import account, kept
from dem_demo.kit.runs import Run, Runs

_WIDTH = 42

Facts = list[tuple[str, str]]
Marks = NDArray[np.bool_]


class Tale(NamedTuple):
    """Texts, facts and figures of a scene."""

    wall: str  # name of what the beads hit, such as "deck"
    # where the COR of the law holds, in words, and the mask of such impacts
    flat: tuple[str, Callable[[Run[Any]], Marks]]
    own: Callable[[Run[Any]], Facts]  # facts that only this scene has
    # beads and walls in one line, and the motion of the walls in another
    title: Callable[[Run[Any]], tuple[str, str]]
    figures: ModuleType
    page: Mapping[str, str]  # texts of the page: heading, lede, alt (of the film), others (files)


def summary(tale: Tale, runs: Runs[Any]) -> str:
    """Write the summary."""
    columns = [dict(facts(tale, run)) for run in runs.both]
    lines = [*title(tale, runs), ""]
    lines += [
        "".join([f"{name:{_WIDTH}}", *(f"{column.get(name, '-'):>18}" for column in columns)]) for name in columns[0]
    ]
    lines += ["", "Bead on bead is the engine's own, not recorded impact by impact"]
    lines += [f"{run.name}: {run.record.left_out}" for run in runs.both if run.record.left_out]
    lines += limits_lines(exceeded(runs.law.impacts["flags"]))
    return "\n".join(lines)


def title(tale: Tale, runs: Runs[Any]) -> tuple[str, str]:
    """Title in two lines: beads and walls; motion, friction, engine and seed."""
    run = runs.law
    what, how = tale.title(run)
    ranks = f"{run.ranks} {'rank' if run.ranks == 1 else 'ranks'}"
    friction = f"friction {run.scene.friction:g}"
    return what, f"{how}, {friction}, in LAMMPS on {ranks}, seed {run.scene.seed}"


def facts(tale: Tale, run: Run[Any]) -> Facts:
    """Names and values of all facts of a run."""
    words, flat = tale.flat[0], run.collisions[tale.flat[1](run) & run.record.impact]
    energy = account(run)
    unit, scale = scale_of(energy.start[-1], "J")  # the same for both runs

    def written(part: float) -> str:
        return f"{part / scale:z.1f} {unit}".replace("u", "µ")

    found = [("", run.name), (f"impacts on the {tale.wall}", f"{run.impacts.size}")]
    if run.record.left_out:
        found.append(("  contacts that are none, left out", f"{(~run.record.impact).sum()}"))
    if flat.size:
        low, middle, high = np.quantile(flat["restitution"], [0.05, 0.5, 0.95])
        found += [
            (f"  {words}", f"{flat.size}"),
            ("  mean approach speed there", f"{flat['approach_speed'].mean():.3f} m/s"),
            ("  median COR there", f"{middle:.3f}"),
            ("  COR of nine in ten of them", f"{low:.3f} - {high:.3f}"),
            ("  one COR that dissipates as much", f"{kept(run, flat):.3f}"),
        ]
    return [
        *found,
        (f"dissipated at the {tale.wall}", written(float(run.dissipated.sum()))),
        ("  bending wave in the plate", written(energy.wave[-1])),
        ("  lost at the contact", written(energy.plastic[-1])),
        (f"work of the {tale.wall} on the beads", written(energy.walls[-1])),
        (f"friction on the {tale.wall}", written(energy.friction[-1])),
        ("beads on beads", written(energy.others[-1])),
        ("kinetic energy at the start", written(energy.start[-1])),
        ("kinetic energy at the end", written(energy.moving[-1])),
        *tale.own(run),
        ("simulated", f"{run.time[-1] * 1e3:.0f} ms"),
        ("computed in", f"{run.elapsed[-1]:.0f} s"),
    ]


def page(tale: Tale, runs: Runs[Any], pictures: Mapping[str, bytes], film: bytes) -> str:
    """Write index.html, one file that needs no other and no network, with a GIF of the bed."""
    run = runs.law
    what, how = title(tale, runs)
    columns = [dict(facts(tale, one)) for one in runs.both]
    head, *names = columns[0]
    return common.template("dem_demo.kit", "bed.html").render(
        tale.page,
        title=f"{tale.page['heading']}: what contactlaw gives a particle simulation",
        facts=(what, how),
        name=run.scene.NAME,
        film=f"data:image/gif;base64,{base64.b64encode(film).decode('ascii')}",
        head=["", *(c[head] for c in columns)],
        rows=[[name.strip(), *(c.get(name, "") for c in columns)] for name in names],
        limits=exceeded(run.impacts["flags"]),
        figures=common.shown(tale.figures.module, pictures),
        command=run.record.made["command"],
        law=run.law,
        source=ImpactModel(run.pair, run.law).force_law.source,
        made=run.made,
    )
