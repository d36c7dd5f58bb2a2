"""One impact of a sphere on a plate by finite elements."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import contactlaw as cl
from contactlaw.physical.arguments import checked
from validation.fem import elements, mesh, solver
from validation.fem.mesh import SOLID, Core, Layer, Mesh
from validation.fem.solver import System

Array = NDArray[np.float64]

_SAMPLES = 400  # samples of the history per expected contact time
PATIENCE = 0.15  # share of the contact time: after so long without a force the sphere has left
_SOONEST, _GIVE_UP = 0.5, 3.0  # earliest and latest end [expected contact times]
_IMBALANCE = 0.1  # largest relative change of the total energy; collapsing elements exceed it
_FINEST = 0.01  # R, the paper's smallest element, and at least ...
_ACROSS = 15.0  # ... so many in the expected contact's radius
_SOFT = 3.0  # radius in which a plate may flow, over the width of its finest part
TYPICAL = 0.015, 100.0  # strain, and rate [1/s], at which estimates take the flow stress
_BENT = 1.35  # [R] as far as a wall is bent; the sphere ends before
_RIM = 0.55  # half of the distance that a pressure wave runs in a plate, and a tenth more


@dataclass(frozen=True)
class Impact:
    """Outcome of an impact; fractions are of the initial kinetic energy.

    Attributes
    ----------
    restitution : float
        Mean rebound velocity of the sphere over its impact speed [-].
    contact_time : float
        Until the last step with a force [s].
    peak_force, peak_compression, residual_compression : float
        Largest force [N]; largest displacement of the sphere's centre of mass towards the
        plate's lower face below it, and the displacement left at separation [m].
    plastic, wave, vibration, friction, hourglass, contact, viscous : float
        Shares of the energy: plastic work; energy in the plate; elastic and kinetic energy in the
        sphere beyond that of its mean motion; losses of friction and of touching; work of the
        hourglass modes of both bodies, which is in `wave` and `vibration` too; loss within the
        bodies by their loss factors [-].
    balance : float
        Largest deviation of the sum of all energies from the first, over the whole impact [-].
    plastic_strain : float
        Largest equivalent plastic strain [-].
    time, force, speed, compression : ndarray
        History: time [s], force [N], a mean from the sample before to the sample after,
        mean speed of the sphere towards the plate [m/s], compression [m].
    system : System
        All nodes and elements at the end.
    snapshots : list of ndarray
        Positions (n, 2) of all nodes [m] at `times`.
    size : float
        Smallest element, over the radius.
    step, steps : float, int
        Step of the integration [s] and their number.
    """

    restitution: float
    contact_time: float
    peak_force: float
    peak_compression: float
    residual_compression: float
    plastic: float
    wave: float
    vibration: float
    friction: float
    hourglass: float
    contact: float
    viscous: float
    balance: float
    plastic_strain: float
    time: Array
    force: Array
    speed: Array
    compression: Array
    system: System
    snapshots: list[Array]
    size: float
    step: float
    steps: int

    @property
    def elements(self) -> int:
        """Number of elements, of both bodies."""
        return len(self.system.sphere.elements) + len(self.system.plate.elements)


def impact(
    pair: cl.Pair,
    speed: float,
    radius: float,
    thickness: float,
    *,
    size: float | None = None,
    friction: float = 0.1,
    yields: bool = True,
    plate_yields: bool = False,
    width: float | None = None,
    far: float = 1.0,
    hourglass_stiffness: float | None = None,
    times: Sequence[float] = (),
    core: Core = SOLID,
    wall: float = math.inf,
    layers: tuple[Layer, ...] = (),
    shell: bool = False,
) -> Impact:
    """Let a sphere fall on a plate whose edge sends no wave back.

    Parameters
    ----------
    pair : contactlaw.Pair
        Materials; a body that yields is elastic-perfectly plastic.
    speed, radius, thickness : float
        Impact speed [m/s], radius of the sphere and thickness of the plate [m].
    size : float, optional
        Smallest element, over the radius, 0.001 to 0.1; by default 0.01, or a 15th of the
        contact's radius.
    friction : float, optional
        Coefficient of friction, 0 to 1.
    yields, plate_yields : bool, optional
        Whether the sphere yields, and the plate.
    width : float, optional
        Distance of the plate's free edge from the axis [m]; at least the radius; by default
        so far that no wave returns within the contact time that the model expects.
    far : float, optional
        Factor on the elements of plates and hollow spheres away from the contact, 0.1 to 2,
        see `mesh.plate`.
    hourglass_stiffness : float, optional
        Stiffness of the sphere's hourglass modes, 0 to 1, see `solver.assemble`.
    times : sequence of float, optional
        Times at which to keep all positions [s].
    core : Core, optional
        What the sphere has inside; by default it is solid.
    wall : float, optional
        Radius to which the plate's face is bent below the sphere [m], see `mesh.bent`.
    layers : tuple of Layer, optional
        What the plate is made of, see `mesh.plate`.
    shell : bool, optional
        Bend the plate as a whole, see `mesh.shell`, not its face alone.

    Returns
    -------
    Impact

    Raises
    ------
    ValueError
        If an argument is outside its range.
    RuntimeError
        If the sphere does not leave the plate within three times the contact time expected, or
        elements collapse.

    Examples
    --------
    >>> import contactlaw as cl
    >>> pair = cl.Pair("gamma-alumina", "glass")
    >>> hit = impact(pair, 26.0, 0.9e-3, 0.5e-3, size=0.06)
    >>> abs(hit.restitution - 0.51) < 0.02, hit.balance < 0.01
    (True, True)
    """
    guess = expect(with_mass(pair, core), speed, radius, thickness, yields, plate_yields)
    if width is None:
        faster = max((math.sqrt(layer.modulus / layer.density) for layer in layers), default=1.0)
        width = faster * free_width(pair.plate, guess.time)
    size = min(_FINEST, guess.contact / radius / _ACROSS) if size is None else size
    stiffness = hourglass_stiffness or 0.0
    checked(
        size=(size, 1e-3, 0.1, "sphere radii"),
        friction=(friction, 0.0, 1.0, ""),
        width=(width, radius, math.inf, "metres, from the radius on"),
        far=(far, 0.1, 2.0, ""),
        hourglass_stiffness=(stiffness, 0.0, 1.0, "of the stiffness of bending"),
    )
    above, below = meshed(guess, radius, thickness, size, width, far, core, layers)
    meshes = above, mesh.shell(below, wall) if shell else mesh.bent(below, wall, _BENT * radius)
    materials = pair.sphere, pair.plate
    soft = _SOFT * mesh.CORE * guess.contact
    system = solver.assemble(meshes, materials, friction, yields, plate_yields, hourglass_stiffness, soft, guess.time)
    step = solver.time_step(system, materials)
    system.v[: _sphere_nodes(system), 1] = -speed
    every = max(1, round(guess.time / _SAMPLES / step))
    load = np.zeros_like(system.x)
    rows: list[tuple[float, float, float, float]] = []
    energies = [energy(system)]
    snapshots: list[Array] = []
    last, start = 0.0, _height(system)
    collapsed = RuntimeError(
        f"elements collapsed at speed {speed:g} m/s on a plate of {thickness:g} m: take a lower "
        f"speed, or coarser elements than {size:g}"
    )
    while True:
        force, touched = solver.advance(system, load, step, every)
        if not np.isfinite(system.v).all():
            raise collapsed
        if touched:
            last = (len(rows) * every + touched) * step
        time = (len(rows) + 1) * every * step
        rows.append((time, 2.0 * math.pi * force, _speed(system), start - _height(system)))
        if len(rows) % 20 == 0:
            energies.append(energy(system))
            if abs(sum(energies[-1]) / sum(energies[0]) - 1.0) > _IMBALANCE:
                raise collapsed
        if len(snapshots) < len(times) and time >= times[len(snapshots)]:
            snapshots.append(system.x.copy())
        if last and time > max((1.0 + PATIENCE) * last, _SOONEST * guess.time):
            break
        if time > _GIVE_UP * guess.time:
            raise RuntimeError(
                f"the sphere is still in contact after {time:.3g} s, {_GIVE_UP:g} times the time "
                f"expected at speed {speed:g} m/s on a plate of {thickness:g} m"
            )
    return _outcome(system, np.array(rows).T, energies, last, snapshots, size, step, every)


class Expected(NamedTuple):
    """Estimates of the model, by which duration and mesh of a computation are chosen."""

    time: float  # contact time [s]
    contact: float  # radius of the contact [m]


def expect(
    pair: cl.Pair, speed: float, radius: float, thickness: float, yields: bool = True, plate_yields: bool = False
) -> Expected:
    """Estimate an impact by the model, whose sphere has the lower of the flow stresses."""
    strengths = []
    for body, may in ((pair.sphere, yields), (pair.plate, plate_yields)):
        if may:
            body.require_yield_strength("fem")
            assert body.flow is not None
            strengths.append(body.flow.stress(*TYPICAL))
    if strengths:
        sphere = dataclasses.replace(pair.sphere, yield_strength=min(strengths))
        pair = cl.Pair(sphere, pair.plate)
    model = cl.ImpactModel(pair, law="myc" if strengths else "hertz", outside="solve")
    found = model.lookup(speed, radius, thickness)
    return Expected(float(found.contact_time), math.sqrt(radius * float(found.peak_compression)))


def with_mass(pair: cl.Pair, core: Core) -> cl.Pair:
    """Pair whose solid sphere is as heavy as one with the core."""
    sphere = dataclasses.replace(pair.sphere, density=core.mass * pair.sphere.density)
    return cl.Pair(sphere, pair.plate)


def meshed(
    guess: Expected,
    radius: float,
    thickness: float,
    size: float,
    width: float,
    far: float = 1.0,
    core: Core = SOLID,
    layers: tuple[Layer, ...] = (),
) -> tuple[Mesh, Mesh]:
    """Sphere and plate for an expected impact; lengths [m], `size` over the radius."""
    fine = size * radius, mesh.CORE * guess.contact
    if core.density:
        above = mesh.layered(radius, *fine, core)
    else:
        above = mesh.hollow(radius, *fine, core, far)
    return above, mesh.plate(radius, *fine, thickness, width, far, layers)


def free_width(plate: cl.Material, contact_time: float) -> float:
    """Distance [m] from which an edge sends no wave back while a contact lasts."""
    wave = math.sqrt(plate.plane_modulus / plate.density)
    return _RIM * wave * (1.0 + PATIENCE) * contact_time


def _sphere_nodes(system: System) -> int:
    return int(system.plate.elements.min())


def _speed(system: System) -> float:
    n = _sphere_nodes(system)
    return -float(system.mass[:n] @ system.v[:n, 1] / system.mass[:n].sum())


def _height(system: System) -> float:
    """Height of the sphere's centre of mass over the plate's lower face, on the axis."""
    n = _sphere_nodes(system)
    centre = system.mass[:n] @ system.x[:n, 1] / system.mass[:n].sum()
    return float(centre - system.x[n, 1])


def energy(system: System) -> tuple[float, ...]:
    """List the energies [J per radian].

    Kinetic of the sphere as a whole and within itself, and of the plate; elastic of both; plastic;
    hourglass of both; losses of touching and of friction; viscous.
    """
    n = _sphere_nodes(system)
    kinetic = 0.5 * system.mass * (system.v**2).sum(axis=1)
    mean = 0.5 * system.mass[:n].sum() * _speed(system) ** 2
    return (
        mean,
        kinetic[:n].sum() - mean,
        kinetic[n:].sum(),
        elements.strain_energy(system.sphere, system.x),
        elements.strain_energy(system.plate, system.x),
        system.sphere.work[0] + system.plate.work[0],
        system.sphere.work[1],
        system.plate.work[1],
        *system.surfaces.work,
        system.sphere.work[2] + system.plate.work[2],
    )


def _outcome(
    system: System,
    history: Array,
    energies: list[tuple[float, ...]],
    contact_time: float,
    snapshots: list[Array],
    size: float,
    step: float,
    every: int,
) -> Impact:
    time, mean_force, speed, compression = history
    first = float(sum(energies[0]))
    share = [float(value) / first for value in energy(system)]
    mass = system.mass[: _sphere_nodes(system)].sum()
    end = int(np.searchsorted(time, contact_time))
    # the force of a row is the mean since the row before, so half a sample older than the rest
    force = 0.5 * (mean_force + np.append(mean_force[1:], 0.0))
    return Impact(
        restitution=float(-speed[-1]) / math.sqrt(2.0 * first / mass),
        contact_time=contact_time,
        peak_force=float(mean_force.max()),
        peak_compression=float(compression.max()),
        residual_compression=float(compression[end]),
        plastic=share[5],
        wave=share[2] + share[4] + share[7],
        vibration=share[1] + share[3] + share[6],
        friction=share[9],
        hourglass=share[6] + share[7],
        contact=share[8],
        viscous=share[10],
        balance=float(np.abs(np.sum(energies, axis=1) / first - 1.0).max()),
        plastic_strain=float(max(body.plastic_strain.max() for body in (system.sphere, system.plate))),
        time=time,
        force=force,
        speed=speed,
        compression=compression,
        system=system,
        snapshots=snapshots,
        size=size,
        step=step,
        steps=time.size * every,
    )
