"""Explicit dynamics of two axisymmetric bodies: central differences with a lumped mass.

All integrals are per radian; velocities are half a step behind positions.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.physical.materials import Material
from validation.fem import contact, elements, prony
from validation.fem.contact import Surfaces
from validation.fem.elements import Body
from validation.fem.flow_stress import flow_stress
from validation.fem.mesh import Mesh

Array = NDArray[np.float64]

VERSION = 2  # stored with each result; to be raised when the solver gives other numbers
_COURANT = 0.85  # share of the stable step, as elements may shorten by a tenth in an impact
# Stiffness of the hourglass modes over that of bending. The plate bends, and an elastic sphere
# pressed flat folds without them; a plastic one must not be stiffened. The study `verification`
# shows the effect of the choice.
_HOURGLASS, _HOURGLASS_ELASTIC = 0.05, 1.0
SETTINGS = {
    "solver_version": VERSION,
    "courant": _COURANT,
    "hourglass_plastic": _HOURGLASS,
    "hourglass_elastic": _HOURGLASS_ELASTIC,
    "contact_sweeps": contact.SWEEPS,
}


class System(NamedTuple):
    """Everything that moves: the sphere's nodes first, then the plate's."""

    x: Array  # (n, 2), positions [m]
    v: Array  # (n, 2), velocities [m/s]
    force: Array  # (n, 2), inner forces [N]
    mass: Array  # (n,) [kg]
    inverse_mass: Array  # (n, 2); 0 where a node cannot move [1/kg]
    sphere: Body
    plate: Body
    surfaces: Surfaces


@kernel(entry=True)
def advance(system: System, load: Array, dt: float, steps: int) -> tuple[float, int]:
    """Take some steps; mean contact force [N per radian], and the last step with contact, from 1.

    No contact in any of them is step 0.
    """
    x, v, force, inverse = system.x, system.v, system.force, system.inverse_mass
    total, touched = 0.0, 0
    for step in range(steps):
        near = contact.approach(system.surfaces, x, v)
        for n in range(x.shape[0]):
            for k in range(2):
                v[n, k] += dt * inverse[n, k] * (force[n, k] + load[n, k])
        lift = contact.resolve(system.surfaces, x, v, inverse, dt, near)
        if lift != 0.0:
            total += lift
            touched = step + 1
        for n in range(x.shape[0]):
            for k in range(2):
                x[n, k] += dt * v[n, k]
                force[n, k] = 0.0
        elements.add_forces(system.sphere, x, v, dt, force)
        elements.add_forces(system.plate, x, v, dt, force)
    return total / steps, touched


def body(
    mesh: Mesh, material: Material, first: int, bending: float | Array, yields: bool, contact_time: float = math.inf
) -> Body:
    """Elements of a mesh, at rest; `first` is the number of the mesh's first node.

    The losses of a material are followed about the frequency of a contact of the length given.
    """
    m = len(mesh.elements)
    relative = np.ones((m, 2)) if mesh.relative is None else mesh.relative
    ratio, lossy = material.poissons_ratio, prony.series(material, contact_time)
    shear = 0.5 * lossy.whole * material.youngs_modulus / (1.0 + ratio)
    return Body(
        elements=mesh.elements + first,
        stress=np.zeros((m, 4)),
        hourglass=np.zeros((m, 2)),
        plastic_strain=np.zeros(m),
        work=np.zeros(3),
        bulk=2.0 * shear * ratio / (1.0 - 2.0 * ratio),
        shear=shear,
        bending=np.full(m, bending) * material.plane_modulus * relative[:, 1],
        flow=flow_stress(material.flow if yields else None),
        branches=np.zeros((m, lossy.times.size, 4)),
        shares=lossy.moduli / lossy.whole,
        times=lossy.times,
        relative=relative,
    )


def assemble(
    meshes: tuple[Mesh, Mesh],
    materials: tuple[Material, Material],
    friction: float = 0.1,
    yields: bool = True,
    plate_yields: bool = False,
    hourglass: float | None = None,
    soft: float = math.inf,
    contact_time: float = math.inf,
) -> System:
    """Put a sphere upon a plate, both at rest.

    Parameters
    ----------
    meshes : tuple of Mesh
        Sphere and plate.
    materials : tuple of Material
        Likewise.
    friction : float, optional
        Coefficient of friction, 0.1 as in the paper.
    yields, plate_yields : bool, optional
        Whether the sphere yields, and the plate.
    hourglass : float, optional
        Stiffness of the sphere's hourglass modes, over that of bending; by default 0.05, or 1 if
        it does not yield.
    soft : float, optional
        Distance from the first contact [m] up to which a plate that yields has 0.05, too.
    contact_time : float, optional
        About how long the contact will last [s]; bodies with losses need it.

    Returns
    -------
    System

    Examples
    --------
    >>> import math
    >>> import contactlaw as cl
    >>> from validation.fem import mesh
    >>> pair = cl.Pair("gamma-alumina", "glass")
    >>> meshes = mesh.sphere(1e-3, 2e-5, 3e-4), mesh.plate(1e-3, 2e-5, 3e-4, 1e-3, 5e-3)
    >>> system = assemble(meshes, (pair.sphere, pair.plate))
    >>> mass = 2 * math.pi * system.mass[: len(meshes[0].nodes)].sum()
    >>> bool(abs(mass / (4 / 3 * math.pi * 1e-9 * 879.0) - 1) < 1e-3)
    True
    """
    above, below = meshes
    if hourglass is None:
        hourglass = _HOURGLASS if yields else _HOURGLASS_ELASTIC
    first = len(above.nodes)
    x = np.concatenate([above.nodes, below.nodes])
    bodies = (
        body(above, materials[0], 0, hourglass, yields, contact_time),
        body(below, materials[1], first, _plate_hourglass(below, soft, plate_yields), plate_yields, contact_time),
    )
    mass = np.zeros(len(x))
    for one, material in zip(bodies, materials, strict=True):
        mass += elements.lumped_mass(one.elements, x, material.density * one.relative[:, 0])
    inverse_mass = np.repeat(1.0 / mass[:, None], 2, axis=1)
    inverse_mass[x[:, 0] == 0.0, 0] = 0.0  # the axis
    slaves = above.surface.size
    surfaces = Surfaces(
        slave=above.surface,
        master=below.surface + first,
        segment=np.zeros(slaves, dtype=np.int64),
        share=np.zeros(slaves),
        gap=np.zeros(slaves),
        before=np.zeros((slaves, 2)),
        impulse=np.zeros((slaves, 2)),
        work=np.zeros(2),
        friction=friction,
        reach=float(x[below.surface[1] + first, 0]),  # the finest element: a wave needs a step
    )
    still = np.zeros((4, *x.shape))
    return System(x, still[0], still[1], mass, inverse_mass, *bodies, surfaces)


def _plate_hourglass(plate: Mesh, soft: float, yields: bool) -> Array:
    """Stiffness of a plate's hourglass modes: soft where it may flow, but not where it bends."""
    centre = plate.nodes[plate.elements].mean(axis=1)
    near = yields and np.hypot(centre[:, 0], centre[:, 1]) < soft
    return np.where(near, _HOURGLASS, _HOURGLASS_ELASTIC)


def time_step(system: System, materials: tuple[Material, Material]) -> float:
    """Step [s] that keeps the central differences stable, for the mesh as it is now."""
    bodies = zip((system.sphere, system.plate), materials, strict=True)
    return _COURANT * min(elements.stable_step(b, system.x, m.density) for b, m in bodies)
