"""The studies: what is computed, and the file that each one leaves in validation/data."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import contactlaw as cl
from validation.fem import calculix, campaign, cases, journal, store
from validation.fem.impact import impact
from validation.fem.indentation import BLOCK, Indentation, indent
from validation.fem.solver import SETTINGS
from validation.fem.yielding import (
    BOTH,
    BOTH_DEPTH,
    BOTH_SIZE,
    HARDENING,
    HARDENING_DEPTH,
    HARDENING_SIZE,
    JOBS,
    SOFT,
    press,
)
from validation.paper.setting import PAIR, RADIUS, YIELD_COMPRESSION

Pressed = dict[str, tuple[NDArray[Any], str]]  # values and unit by name, of one indentation

DEPTHS = (2.0, 5.0, 10.0, 30.0)  # largest compressions of the indentations [d_Y]
CALCULIX_SIZE, CALCULIX_DEPTH = 0.03, 10.0  # [R], [d_Y]
_SPEED, _THICKNESS = 26.0, 0.5e-3  # impact of the paper's Figs 11 to 13 [m/s, m]


def indentation(processes: int) -> None:
    """Force against compression, loading and unloading (Fig. 3)."""
    unit = YIELD_COMPRESSION
    jobs: dict[str, dict[str, Any]] = {f"{d:g}": {"depth": d * unit} for d in DEPTHS}
    jobs["10_twice_as_slow"] = {"depth": 10 * unit, "slowness": 2.0}
    jobs["10_coarse"] = {"depth": 10 * unit, "size": 0.04}
    jobs["10_calculix_mesh"] = {"depth": CALCULIX_DEPTH * unit, "size": CALCULIX_SIZE}
    jobs["30_elastic"] = {"depth": 30 * unit, "yields": False}
    jobs["1_elastic"] = {"depth": unit, "yields": False, "size": 0.01}
    data, units = _all_pressed(_indented, jobs, "indentation", processes)
    store.write(
        "indentation",
        "hemisphere pressed into a block and drawn back; the suffix is the depth in yield "
        "compressions d_Y, and what is special",
        data,
        units,
        mesh=f"element size 0.02 R unless the suffix says otherwise, block of {BLOCK:g} R",
        friction=0.1,
        yield_compression=YIELD_COMPRESSION,
        **SETTINGS,
    )


def yielding(processes: int) -> None:
    """Compute the indentations of `yielding`, in which the block may yield."""
    data, units = _all_pressed(_yielded, {name: name for name in JOBS}, "yielding", processes)
    store.write(
        "yielding",
        "indentations in which the block may yield, with the plastic work in each body; the suffix "
        "is the name in `yielding.JOBS`: block (yields under an elastic sphere), flat (sphere "
        "yields on a rigid mirror), pair (equal materials, both yield) and its image in the "
        "mirror, both (pair and mesh of study calculix_block)",
        data,
        units,
        mesh=f"element sizes in `yielding.JOBS`, block of {BLOCK:g} R",
        friction="0; 0.1 in both",
        radius=RADIUS,
        yield_strength=SOFT.require_yield_strength("fem"),
        plane_modulus=SOFT.plane_modulus,
        **SETTINGS,
    )


def _all_pressed(
    one: Callable[[Any], Pressed], jobs: dict[str, Any], title: str, processes: int
) -> tuple[dict[str, NDArray[Any]], dict[str, str]]:
    """Compute indentations side by side; arrays and units, the job's name added to theirs."""
    data: dict[str, NDArray[Any]] = {}
    units: dict[str, str] = {}
    with cases.workers(processes) as pool:
        bar = tqdm(pool.map(one, jobs.values()), title, len(jobs), disable=None, leave=False)
        for name, outcome in zip(jobs, bar, strict=True):
            for key, (values, unit) in outcome.items():
                data[f"{key}_{name}"], units[f"{key}_{name}"] = values, unit
    return data, units


def _indented(job: dict[str, Any]) -> Pressed:
    return _measured(indent(PAIR, RADIUS, **job))


def _yielded(name: str) -> Pressed:
    found = press(name)
    bodies = {"sphere": found.system.sphere, "block": found.system.plate}
    works = {f"work_{role}": (np.array(2.0 * math.pi * body.work[0]), "J") for role, body in bodies.items()}
    return {**_measured(found), **works}


def _measured(done: Indentation) -> Pressed:
    return {
        "compression": (done.compression, "m"),
        "force": (done.force, "N"),
        "contact_radius": (done.contact_radius, "m"),
        "kinetic": (np.array(done.kinetic), "-"),
        "plastic": (np.array(done.plastic), "-"),
    }


def _where_installed(study: Callable[[int], None]) -> Callable[[int], None]:
    """Make a study keep its stored result where CalculiX is not installed."""

    @functools.wraps(study)
    def run(processes: int) -> None:
        if calculix.installed():
            study(processes)
        else:
            tqdm.write("calculix: ccx is not installed (Debian: calculix-ccx); its result stays")

    return run


@_where_installed
def calculix_indentation(_: int) -> None:
    """Repeat one indentation with CalculiX."""
    depth = CALCULIX_DEPTH * YIELD_COMPRESSION
    _by_calculix("calculix", "the indentation to 10 d_Y", PAIR, depth, CALCULIX_SIZE)


@_where_installed
def calculix_block(_: int) -> None:
    """Repeat one indentation in which both bodies yield with CalculiX."""
    what = "an indentation in which both bodies yield"
    _by_calculix("calculix_block", what, BOTH, BOTH_DEPTH, BOTH_SIZE)


@_where_installed
def calculix_hardening(_: int) -> None:
    """Press a sphere that hardens into an elastic block with CalculiX."""
    what = "an indentation in which the sphere hardens, and the same by this solver (own_),"
    own = indent(HARDENING, RADIUS, HARDENING_DEPTH, size=HARDENING_SIZE)
    pressed = {"own_compression": own.compression, "own_force": own.force}
    _by_calculix("calculix_hardening", what, HARDENING, HARDENING_DEPTH, HARDENING_SIZE, pressed)


def _by_calculix(
    name: str, what: str, pair: cl.Pair, depth: float, size: float, own: dict[str, NDArray[Any]] | None = None
) -> None:
    own = own or {}
    compression, force = calculix.run(pair, RADIUS, depth, size)
    store.write(
        name,
        f"{what} by CalculiX: CAX4 elements, surface-to-surface contact",
        {"compression": compression, "force": force, **own},
        {"compression": "m", "force": "N", **dict(zip(own, ("m", "N"), strict=False))},
        mesh=f"element size {size:g} R, block of {BLOCK:g} R",
        elements=calculix.elements(calculix.deck(pair, RADIUS, depth, size)),
        **calculix.SETTINGS,
        **calculix.facts(pair),
    )


@_where_installed
def calculix_impact(_: int) -> None:
    """Repeat one impact with CalculiX: two meshes, and more numerical damping."""
    runs = [
        calculix.Fall(PAIR, _SPEED, RADIUS, _THICKNESS, size, damping, increments)
        for size, damping, increments in ((0.06, 0.05, 115), (0.06, 0.3, 115), (0.03, 0.05, 170))
    ]
    bar = tqdm(runs, "calculix_impact", disable=None, leave=False)
    found = [calculix.run_impact(run) for run in bar]
    finest = found[-1]
    store.write(
        "calculix_impact",
        "26 m/s on 0.5 mm of glass by CalculiX: CAX4 elements, implicit dynamics; an entry per "
        "run, and the history of the last",
        {
            "size": np.array([run.size for run in runs]),
            "damping": np.array([run.damping for run in runs]),
            "increments": np.array([run.increments for run in runs]),
            "elements": np.array([calculix.elements(calculix.impact_deck(run)) for run in runs]),
            "restitution": np.array([one.restitution for one in found]),
            "contact_time": np.array([one.contact_time for one in found]),
            "peak_force": np.array([one.force.max() for one in found]),
            "time": finest.time,
            "force": finest.force,
            "speed": finest.speed,
        },
        {
            "size": "sphere radius",
            "damping": "-",
            "restitution": "-",
            "contact_time": "s",
            "peak_force": "N",
            "time": "s",
            "force": "N",
            "speed": "m/s",
        },
        mesh="of `impact.impact`; element size [R] in column size",
        columns="damping: -alpha of Hilber, Hughes and Taylor; increments: in the contact time that the model expects",
        speed=_SPEED,
        radius=RADIUS,
        thickness=_THICKNESS,
        **calculix.IMPACT_SETTINGS,
        **calculix.facts(PAIR),
    )


def paper(_: int) -> None:
    """One impact in full: plastic strain, deflection, force (Figs 11 to 13)."""
    times = (1e-6, 2e-6, 3e-6)
    hit = impact(PAIR, _SPEED, RADIUS, _THICKNESS, size=0.01, times=times)
    system = hit.system
    first = int(system.plate.elements.min())
    lower = np.arange(first, first + int(np.argmax(np.diff(system.x[first:, 0]) < 0.0)) + 1)
    strain = system.sphere.plastic_strain
    rest = -_THICKNESS
    store.write(
        "paper",
        "gamma-alumina of 0.9 mm at 26 m/s on 0.5 mm of glass: history; corners (r, z) of the "
        "sphere's elements after separation and their plastic strain; upward displacement of the "
        "plate's lower face at snapshot_time",
        {
            "time": hit.time,
            "force": hit.force,
            "speed": hit.speed,
            "compression": hit.compression,
            "corners": system.x[system.sphere.elements].astype(np.float32),
            "plastic_strain": strain.astype(np.float32),
            "snapshot_time": np.array(times),
            "r": system.x[lower, 0],
            "deflection": np.array([x[lower, 1] - rest for x in hit.snapshots]),
            "largest_plastic_strain": np.array(strain.max()),
            "yielded_share": np.array((strain > 0.0).mean()),
            "restitution": np.array(hit.restitution),
            "plastic": np.array(hit.plastic),
            "wave": np.array(hit.wave),
            "vibration": np.array(hit.vibration),
        },
        {
            "time": "s",
            "force": "N",
            "speed": "m/s",
            "compression": "m",
            "corners": "m",
            "snapshot_time": "s",
            "r": "m",
            "deflection": "m",
            "plastic_strain": "-",
            "largest_plastic_strain": "-",
            "yielded_share": "-",
            "restitution": "-",
            "plastic": "-",
            "wave": "-",
            "vibration": "-",
        },
        mesh=f"element size {hit.size:g} R",
        elements=hit.elements,
        width=float(system.x[:, 0].max()),
        friction=0.1,
        speed=_SPEED,
        thickness=_THICKNESS,
        radius=RADIUS,
        step=hit.step,
        steps=hit.steps,
        **SETTINGS,
    )


_OTHERS: dict[str, Callable[[int], None]] = {
    "indentation": indentation,
    "yielding": yielding,
    "calculix": calculix_indentation,
    "calculix_block": calculix_block,
    "calculix_hardening": calculix_hardening,
    "calculix_impact": calculix_impact,
    "paper": paper,
    campaign.NAME: campaign.indentations,
}
# All others are sets of impacts, which are computed again from the inputs in their files.
_SETS = sorted({path.stem.removeprefix("fem_") for path in store.FOLDER.glob("fem_*.h5")} - set(_OTHERS))
STUDIES: dict[str, Callable[[int], None]] = {
    **{name: functools.partial(journal.again, name) for name in _SETS},
    **_OTHERS,
}
