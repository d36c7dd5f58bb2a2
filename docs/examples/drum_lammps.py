"""Beads of glass and steel in a rotating drum of thin sheet metal, in LAMMPS, also under mpirun."""

from mpi4py import MPI  # lammps finds its MPI library only after it  # noqa: I001
from lammps import lammps
import math
import numpy as np

import contactlaw as cl
from contactlaw.engines.lammps import Cylinder, Disc, Rotation, attach, pair_coeff
from contactlaw.softsphere import time_step

SPHERES, SHEET = ("soda-lime-glass", "bearing-steel-52100-ball"), "stainless-steel-304"
RADIUS, DRUM, LENGTH, THICKNESS = 2e-3, 0.03, 0.02, 0.8e-3  # [m]
SPEED, FASTEST, TURNS, STEPS = 1.0, 3.0, 2.0, 200_000  # [m/s], [m/s], [1/s]


def main():
    """Throw beads down in the drum; print the energy that each of its walls takes from them."""
    models = {kind: cl.ImpactModel(cl.Pair(name, SHEET)) for kind, name in enumerate(SPHERES, 1)}
    dt = min(time_step(model, FASTEST, RADIUS, THICKNESS) for model in models.values())
    places = [(6e-3 * n - 0.012, y, z) for n in range(5) for y in (5e-3, 0.015) for z in (0, 0.01)]
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(f"""
        units si
        atom_style sphere
        boundary f f f
        comm_modify vel yes
        region box block {-DRUM} {DRUM} 0 {LENGTH} {-DRUM} {DRUM}
        create_box 2 box
        pair_style granular
        {pair_coeff(SPHERES, radius=RADIUS, speed=SPEED, friction=0.3)}
        fix move all nve/sphere
        fix weight all gravity 9.80665 vector 0 0 -1
        timestep {dt}""")
    lmp.create_atoms(len(places), range(1, len(places) + 1), [1, 2] * 10, np.ravel(places))
    for kind, model in models.items():
        lmp.command(f"set type {kind} diameter {2 * RADIUS} density {model.pair.sphere.density}")
    lmp.command(f"velocity all set 0 0 {-SPEED}")
    turning = Rotation(axis=(0, 1, 0), speed=2 * math.pi * TURNS)
    ends = (0, 0, 0), (0, LENGTH, 0)
    shell = Cylinder(*ends, DRUM, THICKNESS, motion=turning)
    discs = [Disc(end, (0, 1, 0), DRUM, THICKNESS, motion=turning) for end in ends]
    drum = attach(lmp, models, [shell, *discs], friction=0.3)
    lmp.command(f"run {STEPS}")
    found = drum.gather()
    if MPI.COMM_WORLD.rank == 0:
        lost = sum(found[f"{name}_energy"] for name in ("plastic", "wave", "other"))
        for wall, name in enumerate(("shell", "front", "back")):
            own = found["plate"] == wall
            print(f"{name}: {own.sum()} impacts, {1e6 * lost[own].sum():.0f} uJ lost in it")
        gain = 1e6 * found["wall_work"].sum()
        print(f"in {1e3 * drum.time:.0f} ms; the rotation gave the beads {gain:.0f} uJ in impacts")
    lmp.close()
    return found


if __name__ == "__main__":
    main()
