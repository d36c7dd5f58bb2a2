"""One oblique impact of a sphere on a plate by finite elements in three dimensions.

Explicit central differences with a lumped mass; velocities are half a step behind positions. The
plane of incidence is one of symmetry, so half of each body is computed; all integrals here are of
the half.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw._jit import kernel
from contactlaw.physical.arguments import checked
from contactlaw.physical.materials import sphere_mass
from validation.fem.impact import PATIENCE, expect, free_width
from validation.fem3d import contact, hexahedra, mesh
from validation.fem3d.contact import Surfaces
from validation.fem3d.hexahedra import Body
from validation.fem3d.mesh import Mesh

Array = NDArray[np.float64]

VERSION = 1  # stored with each result; to be raised when the solver gives other numbers
ACROSS = 6  # elements in the expected radius of the contact; v_s' changes by 0.005 mu V0 with 9
_CORE = 1.3  # finest part, over that radius
_COURANT = 0.95  # share of the stable step of the stiffest element by itself
_SOFT = 0.05  # stiffness of the hourglass strains where a body may flow, as in the plane
_SOFT_REACH = 3.0  # how far from the first contact a plate may flow [width of the finest part]
_TOUCH = 3.0  # nodes that may touch lie within so many contact radii and the way of the slide
_SAMPLES = 200  # samples of the history per expected contact time
_SOONEST, _GIVE_UP = 0.5, 3.0  # earliest and latest end [expected contact times]


class System(NamedTuple):
    """Everything that moves: the sphere's nodes first, then the plate's."""

    x: Array  # (n, 3), positions [m]
    v: Array  # (n, 3), velocities [m/s]
    force: Array  # (n, 3), inner forces [N]
    mass: Array  # (n,) [kg]
    inverse_mass: Array  # (n, 3); 0 where a node cannot move [1/kg]
    sphere: Body
    plate: Body
    surfaces: Surfaces


@dataclass(frozen=True)
class Oblique:
    """Outcome of an oblique impact; shares are of the initial kinetic energy.

    Attributes
    ----------
    restitution : float
        Normal rebound velocity of the sphere over its impact speed [-].
    sliding_speed : float
        v_s' of the contact point: speed of the centre along the plate less radius times spin [m/s].
    spin : float
        Angular velocity about the axis across the plane of incidence [rad/s].
    impulse_ratio : float
        Tangential impulse over the normal one [-].
    contact_time, peak_force : float
        Until the last step with a force [s], and the largest normal force [N].
    contact_radius, pressure : float
        Of a circle as large as the nodes in contact at the largest force [m], and the mean pressure
        on it [Pa].
    slide : float
        Way of the contact point along the plate while in contact [m].
    translation, rotation : float
        Shares of the energy in the sphere's motion as a rigid body afterwards.
    plastic, wave, vibration, friction, hourglass, contact : float
        Shares as in `validation.fem.impact.Impact`.
    balance : float
        Largest deviation of the sum of all energies from the first [-].
    elements, steps : int
        Their numbers.
    history : ndarray
        Rows of time [s], normal and tangential force [N], v_s [m/s], area in contact [m2].
    """

    restitution: float
    sliding_speed: float
    spin: float
    impulse_ratio: float
    contact_time: float
    peak_force: float
    contact_radius: float
    pressure: float
    slide: float
    translation: float
    rotation: float
    plastic: float
    wave: float
    vibration: float
    friction: float
    hourglass: float
    contact: float
    balance: float
    elements: int
    steps: int
    history: Array


@kernel(entry=True)
def advance(system: System, dt: float, steps: int, total: Array) -> int:
    """Take some steps, adding up the impulse upon the sphere; the last one with contact, from 1."""
    x, v, force, inverse = system.x, system.v, system.force, system.inverse_mass
    touched = 0
    for step in range(steps):
        near = contact.approach(system.surfaces, x, v, inverse)
        for n in range(x.shape[0]):
            for k in range(3):
                v[n, k] += dt * inverse[n, k] * force[n, k]
        if contact.resolve(system.surfaces, v, inverse, dt, near, total):
            touched = step + 1
        for n in range(x.shape[0]):
            for k in range(3):
                x[n, k] += dt * v[n, k]
                force[n, k] = 0.0
        hexahedra.add_forces(system.sphere, x, v, dt, force)
        hexahedra.add_forces(system.plate, x, v, dt, force)
    return touched


def oblique_impact(
    pair: cl.Pair,
    speed: float,
    sliding_speed: float,
    radius: float,
    thickness: float,
    friction: float,
    *,
    yields: bool = False,
    plate_yields: bool = False,
    across: int = ACROSS,
    distance: float | None = None,
    hole: float = math.inf,
) -> Oblique:
    """Let a sphere without spin hit a plate whose outer rim sends no wave back.

    Parameters
    ----------
    pair : Pair
        Materials; a body that yields is elastic-perfectly plastic.
    speed, sliding_speed : float
        Speed towards the plate and along it [m/s].
    radius, thickness : float
        Radius of the sphere and thickness of the plate [m]; inf is the half-space.
    friction : float
        Coefficient of friction, 0 to 1.
    yields, plate_yields : bool, optional
        Whether the sphere yields, and the plate.
    across : int, optional
        Elements in the expected radius of the contact, 3 to 20.
    distance : float, optional
        Distance [m] to a free edge of a plate of finite thickness, ahead in the direction of the
        slide. With inf there is none nearby, on
        a mesh of the same rows; by default the plate is round.
    hole : float, optional
        Radius [m] of the hole whose rim is the edge; inf is a straight edge.

    Returns
    -------
    Oblique

    Raises
    ------
    ValueError
        If an argument is outside its range.
    RuntimeError
        If elements collapse, or the sphere does not leave within three contact times expected.
    """
    checked(friction=(friction, 0.0, 1.0, ""), across=(across, 3, 20, "elements"))
    guess = expect(pair, speed, radius, thickness, yields, plate_yields)
    core, n = _CORE * guess.contact, round(_CORE * across)
    width = free_width(pair.plate, guess.time)
    if math.isinf(thickness):
        below = mesh.half_space(core, n, width)
    elif distance is None:
        below = mesh.plate(core, n, thickness, width)
    else:
        checked(distance=(distance, core, math.inf, "m"))
        below = mesh.edged_plate(core, n, thickness, width, min(distance, width), hole)
    touch = _TOUCH * guess.contact + sliding_speed * guess.time
    bodies = mesh.sphere(radius, core, n), below
    system = assemble(bodies, pair, radius, friction, yields, plate_yields, core, touch)
    step = _COURANT * min(
        hexahedra.stable_step(body, system.x, material.density)
        for body, material in zip((system.sphere, system.plate), (pair.sphere, pair.plate), strict=True)
    )
    count = len(bodies[0].nodes)
    system.v[:count, 0], system.v[:count, 2] = sliding_speed, -speed
    every = max(1, round(guess.time / _SAMPLES / step))
    areas = 2.0 * mesh.areas(bodies[0])[system.surfaces.slave]
    rows: list[tuple[float, ...]] = []
    energies, impulse = [energy(system, count)], np.zeros(3)
    last = 0.0
    while True:
        start, time = impulse.copy(), len(rows) * every * step
        touched = advance(system, step, every, impulse)
        if touched:
            last = time + touched * step
        time += every * step
        mean, spin = rigid(system, count)
        force = (impulse - start) / (every * step)
        area = float(areas @ (system.surfaces.impulse[:, 0] > 0.0)) if touched else 0.0
        rows.append((time, 2.0 * force[2], -2.0 * force[0], mean[0] - radius * spin, area))
        if len(rows) % 10 == 0:
            energies.append(energy(system, count))
            if not abs(sum(energies[-1]) / sum(energies[0]) - 1.0) < 0.1:
                raise RuntimeError(f"elements collapsed at {time:.3g} s")
        if last and time > max((1.0 + PATIENCE) * last, _SOONEST * guess.time):
            break
        if time > _GIVE_UP * guess.time:
            raise RuntimeError(f"the sphere is still in contact after {time:.3g} s")
    energies.append(energy(system, count))
    history = np.array(rows).T
    first = sum(energies[0])
    share = [value / first for value in energies[-1]]
    lasts = history[0] <= last
    force, area = history[[1, 4], history[1].argmax()]
    return Oblique(
        restitution=float(mean[2]) / speed,
        sliding_speed=float(history[3, -1]),
        spin=spin,
        impulse_ratio=float(-impulse[0] / impulse[2]),
        contact_time=last,
        peak_force=float(force),
        contact_radius=math.sqrt(area / math.pi),
        pressure=float(force / area),
        slide=float(np.abs(history[3, lasts]).sum() * every * step),
        translation=share[0],
        rotation=share[1],
        vibration=share[2] + share[3] + share[4],
        wave=share[5] + share[6] + share[7],
        plastic=share[8],
        contact=share[9],
        friction=share[10],
        hourglass=share[4] + share[7],
        balance=float(np.abs(np.sum(energies, axis=1) / first - 1.0).max()),
        elements=sum(len(one.elements) for one in bodies),
        steps=len(rows) * every,
        history=history,
    )


def assemble(
    meshes: tuple[Mesh, Mesh],
    pair: cl.Pair,
    radius: float,
    friction: float,
    yields: bool,
    plate_yields: bool,
    core: float,
    touch: float,
) -> System:
    """Put half a sphere upon half a plate, both at rest.

    `core` is the width of the finest part [m], and `touch` how far from the first contact the
    bodies may touch [m].
    """
    above, below = meshes
    first = len(above.nodes)
    x = np.concatenate([above.nodes, below.nodes])
    far = np.linalg.norm(below.nodes[below.elements].mean(axis=1), axis=1)
    soft = far < _SOFT_REACH * core if plate_yields else np.zeros(far.size, dtype=bool)
    bodies = (
        _body(above, pair.sphere, 0, np.full(len(above.elements), yields), yields),
        _body(below, pair.plate, first, soft, plate_yields),
    )
    mass = hexahedra.lumped_mass(bodies[0].elements, x, pair.sphere.density)
    # flat faces cut a per cent off the ball
    mass *= 0.5 * float(sphere_mass(pair.sphere.density, radius)) / mass.sum()
    mass += hexahedra.lumped_mass(bodies[1].elements, x, pair.plate.density)
    inverse_mass = np.repeat(1.0 / mass[:, None], 3, axis=1)
    inverse_mass[x[:, 1] == 0.0, 1] = 0.0
    near = np.hypot(*above.nodes[:, :2].T) < touch
    slave = np.flatnonzero(above.surface & near & (above.nodes[:, 2] < radius))
    faces = mesh.top(below)
    centre = below.nodes[faces].mean(axis=1)
    faces = faces[np.hypot(centre[:, 0], centre[:, 1]) < 1.5 * touch] + first
    # no gap of a tenth of the finest part closes within a step
    surfaces = contact.pair_up(slave, faces, x, friction, 0.1 * core)
    still = np.zeros((2, *x.shape))
    return System(x, still[0], still[1], mass, inverse_mass, *bodies, surfaces)


def _body(of: Mesh, material: cl.Material, first: int, soft: NDArray[np.bool_], yields: bool) -> Body:
    """Elements at rest; `first` is the number of the mesh's first node."""
    m = len(of.elements)
    ratio = material.poissons_ratio
    shear = 0.5 * material.youngs_modulus / (1.0 + ratio)
    return Body(
        elements=of.elements + first,
        stress=np.zeros((m, 6)),
        hourglass=np.zeros((m, hexahedra.HOURGLASSES)),
        plastic_strain=np.zeros(m),
        stiffness=np.where(soft, _SOFT, 1.0),
        work=np.zeros(2),
        bulk=2.0 * shear * ratio / (1.0 - 2.0 * ratio),
        shear=shear,
        strength=material.require_yield_strength("fem") if yields else math.inf,
    )


def rigid(system: System, count: int) -> tuple[Array, float]:
    """Mean velocity of the sphere's nodes, the first `count`, and its spin about the y axis."""
    mass, x, v = system.mass[:count], system.x[:count], system.v[:count]
    mean = mass @ v / mass.sum()
    centre = mass @ x / mass.sum()
    r_x, r_z = x[:, 0] - centre[0], x[:, 2] - centre[2]
    turning = mass @ (r_z * v[:, 0] - r_x * v[:, 2])
    mean[1] = 0.0  # the other half moves against it
    return mean, float(turning / (mass @ (r_x**2 + r_z**2)))


def energy(system: System, count: int) -> tuple[float, ...]:
    """List the energies [J].

    Of the sphere: translation, rotation, other kinetic, elastic, hourglass; of the plate: kinetic,
    elastic, hourglass; plastic work; losses of touching and of friction.
    """
    mass, x = system.mass[:count], system.x[:count]
    mean, spin = rigid(system, count)
    centre = mass @ x / mass.sum()
    moment = mass @ ((x[:, 0] - centre[0]) ** 2 + (x[:, 2] - centre[2]) ** 2)
    translation, rotation = 0.5 * mass.sum() * (mean @ mean), 0.5 * moment * spin**2
    kinetic = 0.5 * system.mass * (system.v**2).sum(axis=1)
    return (
        translation,
        rotation,
        kinetic[:count].sum() - translation - rotation,
        hexahedra.strain_energy(system.sphere, system.x),
        float(system.sphere.work[1]),
        kinetic[count:].sum(),
        hexahedra.strain_energy(system.plate, system.x),
        float(system.plate.work[1]),
        float(system.sphere.work[0] + system.plate.work[0]),
        *map(float, system.surfaces.work),
    )
