"""One bead on each of three plates in YADE, with the force of ``contactlaw.softsphere``.

Tested by hand with YADE 2023.02a of Debian 12, numpy 1.24.2, numba 0.68.1, h5py 3.16.0. YADE uses
the system's Python and numpy. Run from the repository, pip installs the rest in a folder DIR:

    pip install --no-deps --target DIR . numba llvmlite h5py platformdirs filelock tqdm
    CONTACTLAW_PATH=DIR yade -x -n docs/examples/yade_softsphere.py
"""

import os
import sys

import yade.wrapper as engine
from yade import O, utils

sys.path.append(os.environ.get("CONTACTLAW_PATH", "."))

import numpy as np  # noqa: E402

import contactlaw as cl  # noqa: E402
from contactlaw.softsphere import Contacts, time_step  # noqa: E402

RADIUS, SPEED, THICKNESS = 0.9e-3, 5.0, np.array([0.5e-3, 1e-3, 3e-3])  # [m], [m/s], [m]
model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
contacts = Contacts(model, RADIUS, THICKNESS)
soft = O.materials.append(engine.FrictMat(young=1e-9))  # YADE's own spring is then negligible
hard = O.materials.append(engine.FrictMat(density=model.pair.sphere.density))
plate = O.bodies.append(utils.wall(0.0, axis=2, material=soft))
places = [(0.01 * n, 0.0, 1.1 * RADIUS) for n in range(THICKNESS.size)]
beads = [O.bodies.append(utils.sphere(at, RADIUS, material=hard)) for at in places]
for n in beads:
    O.bodies[n].state.vel = (0, 0, -SPEED)
O.dt = time_step(model, SPEED, RADIUS, THICKNESS.max())


def push():
    """Add the force of the law where YADE has found a bead on the plate."""
    overlap = np.zeros(THICKNESS.size)
    for i in filter(lambda i: i.isReal, O.interactions.withBody(plate)):
        overlap[beads.index(max(i.id1, i.id2))] = i.geom.penetrationDepth
    for n, force in zip(beads, contacts.advance(overlap, O.dt), strict=True):
        O.forces.addF(n, (0, 0, force))


shapes = [engine.Ig2_Sphere_Sphere_ScGeom(), engine.Ig2_Wall_Sphere_ScGeom()]
physics, law = (
    [engine.Ip2_FrictMat_FrictMat_FrictPhys()],
    [engine.Law2_ScGeom_FrictPhys_CundallStrack()],
)
O.engines = [
    engine.ForceResetter(),
    engine.InsertionSortCollider([engine.Bo1_Sphere_Aabb(), engine.Bo1_Wall_Aabb()]),
    engine.InteractionLoop(shapes, physics, law),
    engine.PyRunner(command="push()", iterPeriod=1),
    engine.NewtonIntegrator(damping=0),
]
O.run(400, True)
for thickness, n in zip(THICKNESS, beads, strict=True):
    cor, wanted = O.bodies[n].state.vel[2] / SPEED, model.restitution(SPEED, RADIUS, thickness)
    print(f"{1e3 * thickness:.1f} mm: COR {cor:.4f}, of the table {wanted:.4f}")
