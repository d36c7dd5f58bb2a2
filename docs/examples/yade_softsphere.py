"""One oblique impact on each of three plates in YADE, with ``contactlaw.softsphere``.

Tested with YADE 2023.02a of Debian 12, numpy 1.24.2, numba 0.68.1, h5py 3.16.0. YADE uses
the system's Python and numpy. Run from the repository, pip installs the rest in a folder DIR:

    pip install --no-deps --target DIR . numba llvmlite h5py platformdirs filelock tqdm
    PYTHONPATH=DIR yade -x -n docs/examples/yade_softsphere.py
"""

import numpy as np
import yade.wrapper as engine
from yade import O, utils

import contactlaw as cl
from contactlaw.softsphere import Contacts, time_step

RADIUS, SPEED, THICKNESS = 0.9e-3, 5.0, np.array([0.5e-3, 1e-3, 3e-3])  # [m], [m/s], [m]
ALONG, FRICTION, UP = 3.0, 0.2, np.array([0.0, 0.0, 1.0])  # [m/s], [-], normal of the plate
model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
contacts = Contacts(model, RADIUS, THICKNESS)
soft = O.materials.append(engine.FrictMat(young=1e-9))  # YADE's own spring is then negligible
hard = O.materials.append(engine.FrictMat(density=model.pair.sphere.density))
plate = O.bodies.append(utils.wall(0.0, axis=2, material=soft))
places = [(0.01 * n, 0.0, 1.1 * RADIUS) for n in range(THICKNESS.size)]
beads = [O.bodies.append(utils.sphere(at, RADIUS, material=hard)) for at in places]
now = [O.bodies[n].state for n in beads]
for one in now:
    one.vel = (ALONG, 0, -SPEED)
O.dt = time_step(model, SPEED, RADIUS, THICKNESS.max())


def push():
    """Add force and torque of the law where YADE has found a bead on the plate."""
    overlap = np.array([RADIUS - one.pos[2] for one in now])  # below 0 for a gap
    for i in filter(lambda i: i.isReal, O.interactions.withBody(plate)):
        overlap[beads.index(max(i.id1, i.id2))] = i.geom.penetrationDepth
    velocity, spin = (np.array([tuple(getattr(s, k)) for s in now]) for k in ("vel", "angVel"))
    force = contacts.advance(overlap, O.dt)[:, None] * UP
    force += contacts.slide(UP, velocity - RADIUS * np.cross(spin, UP), FRICTION)
    for n, f, torque in zip(beads, force, -RADIUS * np.cross(UP, force), strict=True):
        O.forces.addF(n, tuple(f))
        O.forces.addT(n, tuple(torque))


shapes = [engine.Ig2_Sphere_Sphere_ScGeom(), engine.Ig2_Wall_Sphere_ScGeom()]
physics = [engine.Ip2_FrictMat_FrictMat_FrictPhys()]
law = [engine.Law2_ScGeom_FrictPhys_CundallStrack()]
O.engines = [
    engine.ForceResetter(),
    engine.InsertionSortCollider([engine.Bo1_Sphere_Aabb(), engine.Bo1_Wall_Aabb()]),
    engine.InteractionLoop(shapes, physics, law),
    engine.PyRunner(command="push()", iterPeriod=1),
    engine.NewtonIntegrator(damping=0),
]
O.run(400, True)
hit = model.oblique(SPEED, ALONG, RADIUS, THICKNESS, FRICTION, method="solve")
for n, (x, _, z) in enumerate(one.vel for one in now):
    print(f"{1e3 * THICKNESS[n]:.1f} mm: COR {z / SPEED:.4f}, integrated {hit.restitution[n]:.4f};")
    print(f"  along {x / ALONG:.4f}, integrated {hit.tangential_restitution[n]:.4f}")
