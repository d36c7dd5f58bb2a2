"""Normal force of a sphere on a plate, step by step.

In each step an engine knows the overlap of the sphere with the undeformed plate; `advance` gives
the force and keeps five numbers per contact, `State`, and near an edge of the plate six more
(`contactlaw.stepping.edge`). The plate's displacement u2 is advanced by the trapezoidal rule,
implicit in the force F' at the end of the step,

    u2' = u2 + alpha dt (F + F')/2,
    d'  = x' - u2' + alpha dt (F' - F)/12 - dt^2 F'/(12 m),    F' = F(d'; dm).

The last two terms of the compression d' correct errors of the schemes. The first is the error of
the trapezoidal rule, alpha dt^2/12 dF/dt. The second is Numerov's: what an engine's Verlet scheme
moves by the forces F is not the sphere but the sum of its position and dt^2 F/(12 m), to fourth
order (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, III.10). An error of
order dt^2.5 is left only where contact begins and ends, because that is inside a step.

The largest compression usually lies between two steps. Where the bead turns, d'' = -F/m whatever
the plate does, so the parabola through the last two compressions gives it to third order.

Legend, as in `contactlaw.equation`: scaled by d_Y and F_Y inside the kernels,

    d   compression                    q   root compression, sqrt(d - dr)
    dm  largest compression so far     b   (5/12) alpha dt + dt^2/(12 m)
    dr  residual compression           f   contact force

Where a law corrects the mobility of a thin plate (`contactlaw.equation.corrections`), it depends on
the contact time, and so on the approach speed, which is first known in the second step. So does the
strength of a pair with a rate (`contactlaw.stepping.strength`).

An infinite plate recedes for ever under a lasting force such as a bead's weight. A real one has
edges: here u2 relaxes within 1e5 contact times, too slowly to change an impact, and a bead at rest
sinks by alpha F times that time and no further.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw._jit import kernel
from contactlaw.equation import force as forces
from contactlaw.equation.corrections import CONTACT_TIME, is_thin
from contactlaw.equation.edge import Memory
from contactlaw.equation.force import UnloadingCurve
from contactlaw.equation.legs import NO_CURVE
from contactlaw.equation.numbers import (
    ModulusGrowth,
    Numbers,
    PlateConstants,
    numbers,
    relaxed,
    relaxes,
)
from contactlaw.equation.recall import remembered
from contactlaw.model import ImpactModel
from contactlaw.physical.scaling import sphere_on_plate
from contactlaw.stepping import strength
from contactlaw.stepping.edge import Near, recalled

Array = NDArray[np.float64]

RELAXATION = 1e5  # [contact times]; within an impact, u2 relaxes by 1e-5 of itself
# Speed of the impacts at whose frequency springs have their moduli [m/s]. Slower ones flow little,
# so that the yield compression, which stays, matters less to them.
USUAL_SPEED = 3.0
FEWEST_STEPS = 20  # of a contact; with fewer the error does not follow the order of the method

# A force of at least this share of the loading curve's is on that curve.
ON_LOADING_CURVE = 1.0 - 1e-12
MOST_ITERATIONS = 60
CONVERGED = 1e-8  # last relative change of q; the error of the secant method is almost its square


class State(NamedTuple):
    """One contact between two steps, all zero where the bodies are apart; floats or arrays."""

    plate_displacement: Any  # u2 [m]
    largest_compression: Any  # dm [m]
    force: Any  # F [N]
    mobility: Any = 0.0  # of the plate in this contact [m/(s N)]; 0 where the spring's holds
    # stiffness of the contact over the spring's; 0 where the spring's holds; of a pair with a rate
    # it holds the strength, too
    stiffening: Any = 0.0
    # memory of a plate near an edge [N], see `contactlaw.equation.edge`
    x1: Any = 0.0
    y1: Any = 0.0
    x2: Any = 0.0
    y2: Any = 0.0
    x3: Any = 0.0
    y3: Any = 0.0


class Spring(NamedTuple):
    """Constants of a contact; floats or arrays."""

    mass: Any  # [kg]
    stiffness: Any  # K in F = K d^1.5 [N/m^1.5]
    mobility: Any  # alpha of a thin plate [m/(s N)]
    scale: Any  # d_Y [m], or the radius for a law that never yields
    relaxation: Any  # time in which the plate's displacement relaxes [s]
    ratio: Any  # R/H
    plate: PlateConstants
    levels: Any = None  # laws by strength of a pair with a rate, an array


class Largest(NamedTuple):
    """A contact from its largest compression on, in units of the spring's d_Y and F_Y."""

    stiffening: float
    lost: float
    other: float  # part of the loss that is not plastic work
    residual: float
    peak: float


PARTED = State(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@kernel(inline=True)
def with_memory(state: State, m: Memory) -> State:
    """State with this memory of the plate."""
    return State(
        state.plate_displacement, state.largest_compression, state.force, state.mobility,
        state.stiffening, m.x1, m.y1, m.x2, m.y2, m.x3, m.y3,
    )  # fmt: skip


@kernel(inline=True)
def memory_of(state: State) -> Memory:
    """Memory of the plate."""
    return Memory(state.x1, state.y1, state.x2, state.y2, state.x3, state.y3)


def unit_spring(model: ImpactModel, thickness: float) -> Spring:
    """Spring of a bead of radius 1 m; `resized` makes that of any other."""
    one = np.ones(())
    contact = sphere_on_plate(model.pair, model.force_law, one, thickness * one)
    scale = float(contact.yield_compression)
    mass, stiffness = float(contact.mass), float(contact.stiffness)
    return Spring(
        mass=mass,
        stiffness=stiffness,
        mobility=float(contact.mobility),
        scale=scale if scale < math.inf else 1.0,
        relaxation=relaxation(mass, stiffness),
        ratio=float(contact.ratio),
        plate=contact.plate,
        levels=strength.levels_of(model.pair, model.force_law),
    )


def relaxation(mass: Any, stiffness: Any) -> Any:
    """Time in which the plate's displacement relaxes [s], from the contact time at 1 m/s."""
    return RELAXATION * CONTACT_TIME * (mass / stiffness) ** 0.4


@kernel
def at_usual_frequency(spring: Spring) -> Spring:
    """Spring with the moduli of an impact at `USUAL_SPEED`, from one with the pair's.

    In the second step of a contact moduli become those of its own speed; the yield compression
    stays.
    """
    if not relaxes(spring.plate):
        return spring
    own, usual = spring.plate, 0.2 * math.log(USUAL_SPEED)
    plate, faster, growth = relaxed(
        own, 1.0, 0.4 * math.log(spring.mass / spring.stiffness) - usual
    )
    stiffness = spring.stiffness * math.exp(growth)
    slower = plate.inelasticity / own.inelasticity if own.inelasticity > 0.0 else 1.0
    return Spring(
        spring.mass, stiffness, spring.mobility * slower,
        spring.scale * math.exp(own.growth.yield_power * growth), spring.relaxation, spring.ratio,
        PlateConstants(
            plate.inelasticity * faster, plate.transit * faster, plate.x_at_one * (faster * faster),
            plate.saturated / faster, plate.corrections,
            ModulusGrowth(
                0.4 * math.log(spring.mass / stiffness) - usual, own.growth.modulus_power,
                own.growth.plate_power, own.growth.yield_power, own.growth.wave,
                own.growth.wave_slope,
            ),
        ),
        spring.levels,
    )  # fmt: skip


@kernel(cache=True)
def resized(unit: Spring, radius: float) -> Spring:
    """Spring of a bead of this radius [m], from that of radius 1 m on the same plate."""
    return at_usual_frequency(
        Spring(
            unit.mass * (radius * radius * radius),
            unit.stiffness * math.sqrt(radius),
            unit.mobility,
            unit.scale * radius,
            unit.relaxation * radius,
            unit.ratio * radius,
            unit.plate,
            unit.levels,
        )
    )


@kernel(entry=True)
def impact(spring: Spring, speed: float) -> Numbers:
    """Dimensionless numbers of the impact with which a contact begins."""
    return numbers(
        spring.plate, spring.mass, spring.stiffness, spring.scale, speed, spring.ratio
    )  # fmt: skip


@kernel
def strengthened(spring: Spring, place: float) -> Spring:
    """Spring whose plate knows that a stronger contact yields later; its scale stays."""
    plate = spring.plate
    later = strength.yield_growth(spring.levels, place) ** 0.25
    return Spring(
        spring.mass, spring.stiffness, spring.mobility, spring.scale, spring.relaxation,
        spring.ratio,
        PlateConstants(
            plate.inelasticity, plate.transit, plate.x_at_one, later * plate.saturated,
            plate.corrections, plate.growth,
        ),
        spring.levels,
    )  # fmt: skip


@kernel
def _slow_scale(spring: Spring) -> float:
    """Yield compression with the moduli that the pair was given, as `relaxation` has them."""
    if not relaxes(spring.plate):
        return float(spring.scale)
    time = RELAXATION * CONTACT_TIME * (spring.mass / spring.stiffness) ** 0.4
    growth = (spring.relaxation / time) ** 2.5
    return float(spring.scale * growth**-spring.plate.growth.yield_power)


@kernel
def returning(spring: Spring, mobility: float) -> float:
    """Mobility with which the wave from an edge returns, as `contactlaw.physical.scaling.edges_of`.

    It is that of a thin plate, or of the contact if that is less; of bodies with losses the latter.
    """
    return mobility if relaxes(spring.plate) else min(spring.mobility, mobility)


@kernel
def _first_known(
    levels: Array | None, spring: Spring, state: State, overlap: float, step: float
) -> tuple[float, float, float]:
    """Mobility, stiffening and place of a contact in its second step, when the speed is known."""
    stiffening, place = state.stiffening, 0.0
    if levels is not None:
        stiffening, place = strength.split(stiffening)
    if not state.largest_compression > 0.0 or stiffening > 0.0:
        return state.mobility, stiffening, place
    speed = (overlap - state.plate_displacement - state.largest_compression) / step
    if not speed > 0.0:
        return spring.mobility, 1.0, place
    if levels is not None:
        place = strength.place_at(levels, speed, _slow_scale(spring))
        spring = strengthened(spring, place)
    found = impact(spring, speed)
    stiffer = found.stiffer
    return (
        found.inelasticity * found.time / spring.mass,
        stiffer * stiffer * math.sqrt(stiffer),
        place,
    )


@kernel
def _force(
    law: Array, levels: Array | None, place: float, loading: bool, q: float, curve: UnloadingCurve
) -> float:
    if loading or curve.stiffness == 0.0:
        return strength.loading(law, levels, place, q)
    return forces.unloading_force(law, curve, q)


@kernel
def _balance(
    law: Array, levels: Array | None, place: float, loading: bool, curve: UnloadingCurve, b: float,
    r: float,
) -> tuple[float, float]:  # fmt: skip
    """Root compression and force with q^2 + b f(q) = r; 0, 0 where the bodies do not press.

    The left side is convex, so the secant method comes down to the root from the right and cannot
    jump over it. The first slope is the one that Hertz's force would have.
    """
    if not r > 0.0:
        return 0.0, 0.0
    q = math.sqrt(r)
    f = _force(law, levels, place, loading, q, curve)
    if b == 0.0:
        return q, f
    gap = b * f
    slope = 2.0 * q + 3.0 * gap / q
    for _ in range(MOST_ITERATIONS):
        change = gap / slope
        q = max(q - change, 0.0)
        f = _force(law, levels, place, loading, q, curve)
        if not abs(change) > CONVERGED * q:
            break
        last, gap = gap, q * q + b * f - r
        if gap == last:
            break
        slope = (last - gap) / change
    return q, f


@kernel(cache=True)
def advance(
    law: Array, spring: Spring, state: State, overlap: float, step: float, near: Near | None = None
) -> State:
    """State at the end of a step [s], from the overlap [m] at its end.

    The force to apply is the state's. Compression that falls, or grows again below its largest
    value, follows the unloading curve. An overlap of zero or less clears the state.
    """
    if not overlap > 0.0:
        return PARTED
    scale, levels = spring.scale, spring.levels
    unit = spring.stiffness * scale * math.sqrt(scale)  # F_Y
    leak = 0.5 * step / spring.relaxation
    before = state.stiffening
    if levels is not None:
        before, _ = strength.split(before)
    before = unit * before if before > 0.0 else unit
    own, stiffening, mobility, place = 0.0, 0.0, spring.mobility, 0.0
    if not is_thin(spring.plate.corrections):
        own, stiffening, place = _first_known(levels, spring, state, overlap, step)
        if stiffening > 0.0:
            mobility, unit = own, unit * stiffening
    moved = 0.5 * step * mobility / (1.0 + leak)  # motion of the plate per force at either end
    known = state.plate_displacement * (1.0 - leak) / (1.0 + leak) + moved * state.force
    rule_error = moved / 6.0  # the trapezoidal rule's error in `moved`
    sent = 0.5 * step * returning(spring, mobility)
    before_edge = recalled(near, memory_of(state), state.force, step)
    known += sent * before_edge.known
    by_edge = sent * before_edge.per_force
    b = (moved + by_edge - rule_error + step * step / (12.0 * spring.mass)) * unit / scale
    r = (overlap - known - rule_error * state.force) / scale
    dm = state.largest_compression / scale
    # Whether the contact is at compression dm, on the loading curve.
    highest = strength.loading(law, levels, place, math.sqrt(dm))
    top = state.force >= ON_LOADING_CURVE * highest * before
    loading, q, f = True, 0.0, 0.0
    least = strength.lossless(law, levels)
    if dm > least and not top:
        curve = strength.unloading(law, levels, place, dm)
        q, f = _balance(law, levels, place, False, curve, b, r - curve.residual)
        loading = q * q + curve.residual > dm
    if loading:
        q, f = _balance(law, levels, place, True, NO_CURVE, b, r)
        d = q * q
        fall = f * unit * step * step / (spring.mass * scale)  # -d'' dt^2
        if top and fall > 0.0:
            vertex = 0.5 + (d - dm) / fall  # time of the parabola's vertex, in steps
            if vertex < 1.0:
                dm = max(d, dm + 0.5 * fall * max(vertex, 0.0) ** 2)
                if dm > least:
                    curve = strength.unloading(law, levels, place, dm)
                    q, f = _balance(law, levels, place, False, curve, b, r - curve.residual)
        dm = max(d, dm)
    force = f * unit
    if levels is not None and stiffening > 0.0:
        stiffening = strength.with_place(stiffening, place)
    moved += by_edge
    new = State(known + moved * force, dm * scale, force, own, stiffening)
    return with_memory(new, remembered(before_edge, force))


@kernel
def at_largest(law: Array, spring: Spring, state: State) -> Largest:
    """Say what the largest compression of a contact means for its unloading."""
    stiffening, place, levels = state.stiffening, 0.0, spring.levels
    if levels is not None:
        stiffening, place = strength.split(stiffening)
    dm = state.largest_compression / spring.scale
    lost, other = strength.losses(law, levels, place, dm)
    residual = strength.unloading(law, levels, place, dm).residual
    return Largest(
        stiffening, lost, other, residual, strength.loading(law, levels, place, math.sqrt(dm))
    )


@kernel
def nearest_level(
    law: Array, levels: Array, spring: Spring, state: State
) -> tuple[Array, Spring, State]:
    """Law of the level that is nearest to a contact's place, with spring and state for it.

    The state is shifted so that its compression is as far above the residual one as in the contact.
    """
    stiffening, place = strength.split(state.stiffening)
    own, growth = strength.nearest(levels, place)
    dm = state.largest_compression / spring.scale
    left = strength.unloading(law, levels, place, dm).residual
    shift = spring.scale * (left - growth * forces.residual(own, dm / growth))
    return (
        own,
        Spring(
            spring.mass, spring.stiffness, spring.mobility, growth * spring.scale,
            spring.relaxation, spring.ratio, spring.plate, spring.levels,
        ),
        with_memory(
            State(
                state.plate_displacement + shift, state.largest_compression, state.force,
                state.mobility, stiffening,
            ),
            memory_of(state),
        ),
    )  # fmt: skip
