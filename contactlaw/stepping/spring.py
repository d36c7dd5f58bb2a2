"""Normal force of a sphere on a plate, step by step.

In each step an engine knows the overlap of the sphere with the undeformed plate; `advance` gives
the force and keeps five numbers per contact, `State`, and near an edge of the plate twelve more
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
strength of a pair with a rate.

An infinite plate recedes for ever under a lasting force such as a bead's weight. A real one has
edges: here u2 relaxes within 1e5 contact times, too slowly to change an impact, and a bead at rest
sinks by alpha F times that time and no further.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from contactlaw._arrays import Array
from contactlaw._jit import kernel, tuple_of
from contactlaw.equation import force as forces
from contactlaw.equation.corrections import CONTACT_TIME, is_thin
from contactlaw.equation.edge import Memories, Memory
from contactlaw.equation.force import BlendedLaw, UnloadingCurve, at_strength, growth_at
from contactlaw.equation.legs import NO_CURVE
from contactlaw.equation.numbers import (
    Impact,
    ModulusGrowth,
    Numbers,
    PairConstants,
    PlateConstants,
    RateOfStrain,
    numbers,
    relaxed,
    relaxes,
    scaled,
)
from contactlaw.equation.recall import remembered
from contactlaw.model import ImpactModel
from contactlaw.physical.scaling import constants_of, plate_mobility
from contactlaw.stepping.edge import EdgeEcho, recalled

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
    stiffening: Any = 0.0  # of the contact over the spring's; 0 where the spring's holds
    strength: Any = 0.0  # ln of the pair's strength over that of a slow test
    # memory of a plate near an edge [N], see `contactlaw.equation.edge`
    x1: Any = 0.0
    y1: Any = 0.0
    x2: Any = 0.0
    y2: Any = 0.0
    x3: Any = 0.0
    y3: Any = 0.0
    x4: Any = 0.0
    y4: Any = 0.0
    x5: Any = 0.0
    y5: Any = 0.0
    x6: Any = 0.0
    y6: Any = 0.0


class Spring(NamedTuple):
    """Constants of a contact; floats or arrays."""

    mass: Any  # that answers at the contact [kg]
    solid: Any  # mass of the pair's solid sphere of the same radius [kg]
    stiffness: Any  # K in F = K d^1.5 [N/m^1.5]
    mobility: Any  # alpha of a thin plate [m/(s N)]
    scale: Any  # d_Y [m], or the radius for a law that never yields
    relaxation: Any  # time in which the plate's displacement relaxes [s]
    ratio: Any  # R/H
    plate: PlateConstants


class Largest(NamedTuple):
    """A contact from its largest compression on, in units of its d_Y and F_Y."""

    scale: float  # d_Y [m]
    unit: float  # F_Y [N]
    lost: float
    other: float  # part of the loss that is not plastic work
    residual: float
    peak: float


PARTED = State(*[0.0] * 18)


@kernel(inline=True)
def memory_of(state: State) -> Memories:
    """Memory of the plate."""
    return Memories(tuple_of(Memory, state), Memory(state.x4, state.y4, state.x5, state.y5, state.x6, state.y6))


def unit_spring(model: ImpactModel, thickness: float) -> Spring:
    """Spring of a bead of radius 1 m; `resized` makes that of any other."""
    known = constants_of(model.pair, model.force_law)
    scale, time = known.yield_compression, known.time
    stiffness = known.mass / (time * time * math.sqrt(time))
    return Spring(
        mass=known.mass,
        solid=known.mass,
        stiffness=stiffness,
        mobility=float(plate_mobility(model.pair.plate, thickness)),
        scale=scale if scale < math.inf else 1.0,
        relaxation=RELAXATION * CONTACT_TIME * (known.mass / stiffness) ** 0.4,  # at 1 m/s
        ratio=np.float64(1.0) / thickness,  # whose reciprocal may be inf without the compiler
        plate=known.plate,
    )


@kernel
def at_usual_frequency(spring: Spring) -> Spring:
    """Spring with the moduli of an impact at `USUAL_SPEED`, from one with the pair's.

    The impact is that of a solid sphere. In the second step of a contact moduli become those of
    its own speed; the yield compression stays.
    """
    if not relaxes(spring.plate):
        return spring
    own, usual = spring.plate, 0.2 * math.log(USUAL_SPEED)
    plate, faster, growth = relaxed(own, 1.0, 0.4 * math.log(spring.solid / spring.stiffness) - usual)
    stiffness = spring.stiffness * math.exp(growth)
    softer = math.exp(own.growth.yield_power * growth)
    slower = plate.inelasticity / own.inelasticity if own.inelasticity > 0.0 else 1.0
    plate = tuple_of(
        PlateConstants,
        plate,
        inelasticity=plate.inelasticity * faster,
        transit=plate.transit * faster,
        x_at_one=plate.x_at_one * (faster * faster),
        saturated=plate.saturated / faster,
        growth=tuple_of(ModulusGrowth, own.growth, log_time=0.4 * math.log(spring.solid / stiffness) - usual),
        rate=RateOfStrain(own.rate.slope, own.rate.per_speed * softer),
    )
    mobility, scale = spring.mobility * slower, spring.scale * softer
    return tuple_of(Spring, spring, stiffness=stiffness, mobility=mobility, scale=scale, plate=plate)


@kernel(cache=True)
def resized(unit: Spring, radius: float) -> Spring:
    """Spring of a bead of this radius [m], from that of radius 1 m on the same plate."""
    return at_usual_frequency(
        tuple_of(
            Spring,
            unit,
            mass=unit.mass * (radius * radius * radius),
            solid=unit.solid * (radius * radius * radius),
            stiffness=unit.stiffness * math.sqrt(radius),
            scale=unit.scale * radius,
            relaxation=unit.relaxation * radius,
            ratio=unit.ratio * radius,
        )
    )


@kernel
def curved(spring: Spring, bending: float) -> Spring:
    """Spring of a bead on a curved wall, where R* takes the place of its radius R, from R*/R.

    K grows as sqrt(R*) and d_Y as R*, so that T_H falls as R*^-0.2. The bead's mass stays, and so
    does the mobility of the plate.
    """
    if bending == 1.0 or not bending > 0.0:
        return spring
    plate, root = spring.plate, bending**0.1
    faster = root * root
    return tuple_of(
        Spring,
        spring,
        stiffness=spring.stiffness * math.sqrt(bending),
        scale=spring.scale * bending,
        relaxation=spring.relaxation / faster,
        plate=scaled(plate, faster, faster, faster * faster, faster * root),
    )


@kernel(entry=True)
def impact(law: Array, spring: Spring, speed: float) -> Numbers:
    """Dimensionless numbers of the impact with which a contact begins."""
    time = (spring.solid / spring.stiffness) ** 0.4
    solid = PairConstants(spring.plate, time, spring.solid, spring.scale)
    share = spring.mass / spring.solid
    return numbers(solid, law, Impact(speed, 1.0, 1.0 / spring.ratio, share))  # of a radius of 1


@kernel
def returning(spring: Spring, mobility: float) -> float:
    """Mobility with which the wave from an edge returns, as `contactlaw.physical.scaling.edges_of`.

    It is that of a thin plate, or of the contact if that is less; of bodies with losses the latter.
    """
    return mobility if relaxes(spring.plate) else min(spring.mobility, mobility)


@kernel
def _first_known(law: Array, spring: Spring, state: State, overlap: float, step: float) -> tuple[float, float, float]:
    """Mobility, stiffening, strength of a contact in its second step, when the speed is known."""
    if not state.largest_compression > 0.0 or state.stiffening > 0.0:
        return state.mobility, state.stiffening, state.strength
    speed = (overlap - state.plate_displacement - state.largest_compression) / step
    if not speed > 0.0:
        return spring.mobility, 1.0, 0.0
    found = impact(law, spring, speed)
    stiffer = found.stiffer
    return (found.inelasticity * found.time / spring.mass, stiffer * stiffer * math.sqrt(stiffer), found.strength)


@kernel
def _balance(law: BlendedLaw, curve: UnloadingCurve, b: float, r: float) -> tuple[float, float]:
    """Root compression and force with q^2 + b f(q) = r; 0, 0 where the bodies do not press.

    The left side is convex, so the secant method comes down to the root from the right and cannot
    jump over it. The first slope is the one that Hertz's force would have.
    """
    if not r > 0.0:
        return 0.0, 0.0
    q = math.sqrt(r)
    f = forces.unloading_force(law, curve, q)
    if b == 0.0:
        return q, f
    gap = b * f
    slope = 2.0 * q + 3.0 * gap / q
    for _ in range(MOST_ITERATIONS):
        change = gap / slope
        q = max(q - change, 0.0)
        f = forces.unloading_force(law, curve, q)
        if not abs(change) > CONVERGED * q:
            break
        last, gap = gap, q * q + b * f - r
        if gap == last:
            break
        slope = (last - gap) / change
    return q, f


@kernel(cache=True)
def advance(
    law: Array, spring: Spring, state: State, overlap: float, step: float, near: EdgeEcho | None = None
) -> State:
    """State at the end of a step [s], from the overlap [m] at its end.

    The force to apply is the state's. Compression that falls, or grows again below its largest
    value, follows the unloading curve. An overlap of zero or less clears the state. The law is that
    of `contactlaw.softsphere.law_of`.
    """
    if not overlap > 0.0:
        return PARTED
    own_mobility, stiffening, mobility, strength = 0.0, 0.0, spring.mobility, 0.0
    if not is_thin(spring.plate.corrections):
        own_mobility, stiffening, strength = _first_known(law, spring, state, overlap, step)
    own = at_strength(law, strength)
    scale = spring.scale * growth_at(law, strength)
    unit = spring.stiffness * scale * math.sqrt(scale)  # F_Y
    leak = 0.5 * step / spring.relaxation
    before = unit * state.stiffening if state.stiffening > 0.0 else unit
    if stiffening > 0.0:
        mobility, unit = own_mobility, unit * stiffening
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
    highest = forces.loading(own, math.sqrt(dm))
    top = state.force >= ON_LOADING_CURVE * highest * before
    loading, q, f = True, 0.0, 0.0
    least = forces.lossless(own)
    if dm > least and not top:
        curve = forces.unloading(own, dm)
        q, f = _balance(own, curve, b, r - curve.residual)
        loading = q * q + curve.residual > dm
    if loading:
        q, f = _balance(own, NO_CURVE, b, r)
        d = q * q
        fall = f * unit * step * step / (spring.mass * scale)  # -d'' dt^2
        if top and fall > 0.0:
            vertex = 0.5 + (d - dm) / fall  # time of the parabola's vertex, in steps
            if vertex < 1.0:
                dm = max(d, dm + 0.5 * fall * max(vertex, 0.0) ** 2)
                if dm > least:
                    curve = forces.unloading(own, dm)
                    q, f = _balance(own, curve, b, r - curve.residual)
        dm = max(d, dm)
    force = f * unit
    moved += by_edge
    after = remembered(before_edge, force)
    rest = after.second
    return tuple_of(
        State,
        after.first,
        plate_displacement=known + moved * force,
        largest_compression=dm * scale,
        force=force,
        mobility=own_mobility,
        stiffening=stiffening,
        strength=strength,
        x4=rest.x1,
        y4=rest.y1,
        x5=rest.x2,
        y5=rest.y2,
        x6=rest.x3,
        y6=rest.y3,
    )


@kernel
def at_largest(law: Array, spring: Spring, state: State) -> Largest:
    """Say what the largest compression of a contact means for its unloading."""
    own = at_strength(law, state.strength)
    scale = spring.scale * growth_at(law, state.strength)
    unit = spring.stiffness * scale * math.sqrt(scale)
    if state.stiffening > 0.0:
        unit *= state.stiffening
    turned = forces.deepest(own, state.largest_compression / scale)
    return Largest(scale, unit, turned.loss, turned.other, turned.residual, turned.force)
