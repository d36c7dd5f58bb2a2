"""The studies: what is computed, and the file that each one leaves in validation/data."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

import contactlaw as cl
from validation.fem import calculix, cases, store
from validation.fem.cases import Case, yield_inelasticity
from validation.fem.impact import impact
from validation.fem.indentation import BLOCK, indent
from validation.paper import PAIR, RADIUS, YIELD_COMPRESSION

SLENDERNESS = (0.1, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.8)  # R/H
SPEED_RATIO = (0.3, 0.6, 1.0, 1.5, 2.2, 3.5, 5.0, 7.0)  # V0/V_Y0
OTHER_PAIRS = (
    ("bearing-steel-52100", "soda-lime-glass"),
    ("bearing-steel-52100", "aluminium-6061-t6"),
)
DEPTHS = (2.0, 5.0, 10.0, 30.0)  # of the indentations [d_Y]
CALCULIX_SIZE, CALCULIX_DEPTH = 0.03, 10.0  # [R], [d_Y]
_SPEED, _THICKNESS = 26.0, 0.5e-3  # of the paper's Figs 11 to 13 [m/s, m]


def verification(processes: int) -> None:
    """Meshes from 0.04 R to 0.005 R, no friction, a plate twice as wide, and Hertz's limit."""
    listed: list[tuple[str, Case]] = []
    for thickness in (0.5e-3, 1e-3):
        listed += [("mesh", Case(_SPEED, thickness, size=s)) for s in (0.04, 0.02, 0.01, 0.005)]
        listed.append(("no friction", Case(_SPEED, thickness, size=0.01, friction=0.0)))
    thin = Case(speed=7.43, thickness=0.5e-3, size=0.01)
    wave = math.sqrt(PAIR.plate.plane_modulus / PAIR.plate.density)
    width = 0.55 * 1.15 * wave * 5.2e-6  # what `impact` takes, made explicit
    for factor in (1.0, 2.0):
        listed.append(("width", Case(thin.speed, thin.thickness, size=0.01, width=factor * width)))
    for speed in (8.0, 3.0, 1.0, 0.5):
        listed.append(("hertz", Case(speed, 9e-3, friction=0.0, yields=False)))
    data = cases.solve_all([case for _, case in listed], "verification", processes)
    data["check"] = np.array([check for check, _ in listed])
    about = "convergence with the mesh; influence of friction and of the plate's width; Hertz"
    cases.save("verification", about, data)


def indentation(processes: int) -> None:
    """Force against compression, loading and unloading (Fig. 3)."""
    unit = YIELD_COMPRESSION
    jobs: dict[str, dict[str, Any]] = {f"{d:g}": {"depth": d * unit} for d in DEPTHS}
    jobs["10_twice_as_slow"] = {"depth": 10 * unit, "slowness": 2.0}
    jobs["10_coarse"] = {"depth": 10 * unit, "size": 0.04}
    jobs["10_calculix_mesh"] = {"depth": CALCULIX_DEPTH * unit, "size": CALCULIX_SIZE}
    jobs["20_elastic"] = {"depth": 20 * unit, "yields": False}
    jobs["1_elastic"] = {"depth": unit, "yields": False, "size": 0.01}
    data: dict[str, NDArray[Any]] = {}
    with ProcessPoolExecutor(processes) as pool:
        futures = {name: pool.submit(_indented, job) for name, job in jobs.items()}
        for name, future in tqdm(futures.items(), "indentation", disable=None, leave=False):
            for key, values in future.result().items():
                data[f"{key}_{name}"] = values
    store.write(
        "indentation",
        "hemisphere pressed into a block and drawn back; the suffix is the depth in yield "
        "compressions d_Y, and what is special",
        data,
        {key: cases.UNITS.get(key.split("_")[0], "-") for key in data},
        mesh=f"element size 0.02 R unless the suffix says otherwise, block of {BLOCK:g} R, "
        "friction 0.1",
        yield_compression=unit,
    )


def _indented(job: dict[str, Any]) -> dict[str, NDArray[Any]]:
    press = indent(PAIR, RADIUS, **job)
    return {
        "compression": press.compression,
        "force": press.force,
        "contact": press.contact_radius,
        "kinetic": np.array(press.kinetic),
        "plastic": np.array(press.plastic),
    }


def calculix_indentation(_: int) -> None:
    """Repeat one indentation with CalculiX, where it is installed."""
    if not calculix.installed():
        tqdm.write("calculix: ccx is not installed (Debian: calculix-ccx); the stored result stays")
        return
    depth = CALCULIX_DEPTH * YIELD_COMPRESSION
    compression, force = calculix.run(PAIR, RADIUS, depth, CALCULIX_SIZE)
    store.write(
        "calculix",
        "the indentation to 10 d_Y by CalculiX: CAX4 elements, surface-to-surface contact",
        {"compression": compression, "force": force},
        cases.UNITS,
        mesh=f"element size {CALCULIX_SIZE:g} R, block of {BLOCK:g} R",
        settings=calculix.SETTINGS,
        calculix_version=calculix.version(),
    )


def matrix(processes: int) -> None:
    """Eight thicknesses by eight speeds (Figs 7, 8, 10)."""
    listed = [Case(v * PAIR.yield_speed, RADIUS / s) for s in SLENDERNESS for v in SPEED_RATIO]
    data = cases.solve_all(listed, "matrix", processes)
    cases.save("matrix", "gamma-alumina on glass, R/H 0.1 to 1.8, V0/V_Y0 0.3 to 7", data)


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
        {**cases.UNITS, "corners": "m", "snapshot_time": "s"},
        mesh=f"element size {hit.size:g} R",
        speed=_SPEED,
        thickness=_THICKNESS,
        radius=RADIUS,
        step=hit.step,
        steps=hit.steps,
    )


def pairs(processes: int) -> None:
    """Compare three pairs at equal inelasticity: does one table serve them all."""
    listed = []
    for slenderness in (0.5, 1.0, 1.5):
        inelasticity = yield_inelasticity(PAIR, RADIUS / slenderness)
        for sphere, plate in ((PAIR.sphere.name, PAIR.plate.name), *OTHER_PAIRS):
            pair = cl.Pair(sphere, plate)
            # lambda ~ 1/H^2
            thickness = RADIUS * math.sqrt(yield_inelasticity(pair, RADIUS) / inelasticity)
            for v in (0.5, 1.5, 3.5, 7.0):
                listed.append(Case(v * pair.yield_speed, thickness, sphere=sphere, plate=plate))
    data = cases.solve_all(listed, "pairs", processes)
    about = "three pairs at the same inelasticity lambda and speed over yield speed; plates elastic"
    cases.save("pairs", about, data)


def limits(processes: int) -> None:
    """Beyond the paper: thinner and faster."""
    listed = [
        Case(v * PAIR.yield_speed, RADIUS / s)
        for s in (0.5, 1.0, 1.8, 2.5)
        for v in (0.5, 1.5, 3.5, 7.0, 10.0, 14.0)
    ]
    data = cases.solve_all(listed, "limits", processes)
    cases.save("limits", "gamma-alumina on glass, R/H to 2.5, V0/V_Y0 to 14", data)


def edge(processes: int) -> None:
    """Let the bending wave come back from the free edge of a small plate: why 1.5."""
    thickness = RADIUS / 1.5
    speed = PAIR.yield_speed
    time = float(cl.ImpactModel(PAIR).lookup(speed, RADIUS, thickness).contact_time)
    way = float(cl.edge_distance(PAIR.plate, thickness, time)) / 1.5  # c_g time/2
    factors = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5, 2.0, 4.0)
    listed = [Case(speed, thickness, width=factor * way) for factor in factors]
    data = cases.solve_all(listed, "edge", processes)
    about = "free edge at 0.5 to 4 times the way of the contact's own bending wave, there and back"
    cases.save("edge", about, data)


STUDIES: dict[str, Callable[[int], None]] = {
    "verification": verification,
    "indentation": indentation,
    "calculix": calculix_indentation,
    "matrix": matrix,
    "paper": paper,
    "pairs": pairs,
    "limits": limits,
    "edge": edge,
}
