"""The stateful law: contact force step by step, for engines that integrate through the contact.

Soft-sphere engines (LAMMPS, YADE, a loop of one's own) resolve a contact in some tens of steps. In
each one they know how deep the sphere is in the undeformed plate, the overlap; this module gives
the force. It keeps five numbers per contact, `State`. The plate's displacement u2 is advanced by
the trapezoidal rule, implicit in the force F' at the end of the step,

    u2' = u2 + alpha dt (F + F')/2,
    d'  = x' - u2' + alpha dt (F' - F)/12 - dt^2 F'/(12 m),    F' = F(d'; dm).

The last two terms of the compression d' take back what the schemes get wrong. The first is the
error of the trapezoidal rule, alpha dt^2/12 dF/dt. The second is Numerov's: what an engine's Verlet
scheme moves by the forces F is not the sphere but the sum of its position and dt^2 F/(12 m), to
fourth order (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, III.10). Only
where contact begins and ends inside a step an error of order dt^2.5 is left.

The largest compression lies between two steps as a rule. Where the bead turns, d'' = -F/m whatever
the plate does, so the parabola through the last two compressions gives it to third order.

Legend, as in `contactlaw.equation`: scaled by d_Y and F_Y inside the kernels,

    d   compression                    q   root compression, sqrt(d - dr)
    dm  largest compression so far     b   (5/12) alpha dt + dt^2/(12 m)
    dr  residual compression           f   contact force

Under a law that takes the plate's mobility to the next order it depends on how long the contact
will last, and so on the speed of the approach: that of the second step, when it is first known.

An infinite plate recedes for ever under a force that stays, as a bead's weight does. A real one has
edges: here u2 relaxes within 1e5 contact times, too slow for an impact to notice, and a bead at
rest sinks by alpha F times that and no further.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contactlaw._jit import enable_caching, kernel
from contactlaw.answers.backend import OutsideTableError, too_thin
from contactlaw.equation import force as forces
from contactlaw.equation.force import Curve
from contactlaw.equation.legs import NO_CURVE
from contactlaw.equation.numbers import Numbers, PlateConstants, numbers
from contactlaw.equation.waves import CONTACT_TIME
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import broadcast, check, number, refuse_units, scalars
from contactlaw.physical.scaling import scales, sphere_on_plate

Array = NDArray[np.float64]

RELAXATION = 1e5  # [contact times]; u2 then moves by 1e-5 of itself within an impact
FEWEST_STEPS = 20  # per contact; with fewer the error no longer follows the order of the method
# Largest error of COR times (steps per contact)^2.5, at any phase of the first touch: 0.86 measured
# with velocity Verlet and the law myc, for lambda to 2 and speeds to 7 V_Y0, at 20, 50, 100 steps.
_ERROR = 0.9

TOP = 1.0 - 1e-12  # of the loading curve: a force above came from there, and not by reloading
MOST_ITERATIONS = 60
CONVERGED = 1e-8  # last change of q, relative; the secant method squares it, almost


class State(NamedTuple):
    """One contact between two steps, all zero where the bodies are apart; floats or arrays."""

    plate_displacement: Any  # u2 [m]
    largest_compression: Any  # dm [m]
    force: Any  # F [N]
    mobility: Any = 0.0  # of the plate in this contact [m/(s N)]; 0 where it is the spring's
    stiffening: Any = 0.0  # of the contact, over the spring's stiffness; 0 likewise


class Spring(NamedTuple):
    """What does not change during a contact; floats or arrays."""

    mass: Any  # [kg]
    stiffness: Any  # K in F = K d^1.5 [N/m^1.5]
    mobility: Any  # alpha of a thin plate [m/(s N)]
    scale: Any  # d_Y [m], or the radius for a law that never yields
    relaxation: Any  # time in which the plate's displacement relaxes [s]
    ratio: Any  # R/H
    plate: PlateConstants


PARTED = State(0.0, 0.0, 0.0, 0.0, 0.0)


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
        relaxation=_relaxation(mass, stiffness),
        ratio=float(contact.ratio),
        plate=contact.plate,
    )


def _relaxation(mass: Any, stiffness: Any) -> Any:
    """Time in which the plate's displacement relaxes [s], from the contact time at 1 m/s."""
    return RELAXATION * CONTACT_TIME * (mass / stiffness) ** 0.4


@kernel(cache=True)
def resized(unit: Spring, radius: float) -> Spring:
    """Spring of a bead of this radius [m], from that of radius 1 m on the same plate."""
    return Spring(
        unit.mass * (radius * radius * radius),
        unit.stiffness * math.sqrt(radius),
        unit.mobility,
        unit.scale * radius,
        unit.relaxation * radius,
        unit.ratio * radius,
        unit.plate,
    )


@kernel(entry=True)
def impact(spring: Spring, speed: float) -> Numbers:
    """Dimensionless numbers of the impact with which a contact begins."""
    return numbers(
        spring.plate, spring.mass, spring.stiffness, spring.scale, speed, spring.ratio
    )  # fmt: skip


@kernel
def _next_orders(spring: Spring, state: State, overlap: float, step: float) -> tuple[float, float]:
    """Mobility and stiffening of a contact in its second step, when the speed is first known."""
    if not state.largest_compression > 0.0 or state.stiffening > 0.0:
        return state.mobility, state.stiffening
    speed = (overlap - state.plate_displacement - state.largest_compression) / step
    if not speed > 0.0:
        return spring.mobility, 1.0
    found = impact(spring, speed)
    more = found.stiffer
    return found.inelasticity * found.time / spring.mass, more * more * math.sqrt(more)


@kernel
def _force(law: Array, loading: bool, q: float, curve: Curve) -> float:
    return forces.loading(law, q) if loading else forces.unloading_force(law, curve, q)


@kernel
def _balance(law: Array, loading: bool, curve: Curve, b: float, r: float) -> tuple[float, float]:
    """Root compression and force with q^2 + b f(q) = r; 0, 0 where the bodies do not press.

    The left side is convex, so the secant method comes down to the root from the right and cannot
    jump over it; its first slope takes f for Hertz's.
    """
    if not r > 0.0:
        return 0.0, 0.0
    q = math.sqrt(r)
    f = _force(law, loading, q, curve)
    if b == 0.0:
        return q, f
    gap = b * f
    slope = 2.0 * q + 3.0 * gap / q
    for _ in range(MOST_ITERATIONS):
        change = gap / slope
        q = max(q - change, 0.0)
        f = _force(law, loading, q, curve)
        if not abs(change) > CONVERGED * q:
            break
        last, gap = gap, q * q + b * f - r
        if gap == last:
            break
        slope = (last - gap) / change
    return q, f


@kernel(cache=True)
def advance(law: Array, spring: Spring, state: State, overlap: float, step: float) -> State:
    """State at the end of a step in which the overlap has become this [m]; the step in [s].

    The force to apply is the state's. Compression that falls, or grows again below its largest
    value, follows the unloading curve. An overlap of zero or less clears the state.
    """
    if not overlap > 0.0:
        return PARTED
    scale = spring.scale
    unit = spring.stiffness * scale * math.sqrt(scale)  # F_Y
    leak = 0.5 * step / spring.relaxation
    before = unit * state.stiffening if state.stiffening > 0.0 else unit
    own, stiffening, mobility = 0.0, 0.0, spring.mobility
    if spring.plate.waves.bulk_factor > 0.0:
        own, stiffening = _next_orders(spring, state, overlap, step)
        if stiffening > 0.0:
            mobility, unit = own, unit * stiffening
    moved = 0.5 * step * mobility / (1.0 + leak)  # of the plate, per force at either end
    known = state.plate_displacement * (1.0 - leak) / (1.0 + leak) + moved * state.force
    ahead = moved / 6.0  # of the trapezoidal rule, by its error
    b = (moved - ahead + step * step / (12.0 * spring.mass)) * unit / scale
    r = (overlap - known - ahead * state.force) / scale
    dm = state.largest_compression / scale
    top = state.force >= TOP * forces.loading(law, math.sqrt(dm)) * before  # compression was dm
    loading, q, f = True, 0.0, 0.0
    least = forces.lossless(law)
    if dm > least and not top:
        curve = forces.unloading(law, dm)
        q, f = _balance(law, False, curve, b, r - curve.residual)
        loading = q * q + curve.residual > dm
    if loading:
        q, f = _balance(law, True, NO_CURVE, b, r)
        d = q * q
        fall = f * unit * step * step / (spring.mass * scale)  # -d'' dt^2
        if top and fall > 0.0:
            turn = 0.5 + (d - dm) / fall  # of the parabola, in steps
            if turn < 1.0:
                dm = max(d, dm + 0.5 * fall * max(turn, 0.0) ** 2)
                if dm > least:
                    curve = forces.unloading(law, dm)
                    q, f = _balance(law, False, curve, b, r - curve.residual)
        dm = max(d, dm)
    force = f * unit
    return State(known + moved * force, dm * scale, force, own, stiffening)


@kernel(cache=True)
def _advance_all(
    law: Array, springs: Spring, states: State, deepest: Array, overlap: Array, step: float
) -> int:
    """`advance` for arrays, in place; index of an overlap that no contact has, else -1.

    The deepest overlap is in the plate where it is; it may have receded by any displacement.
    """
    for n in range(overlap.size):
        if not -math.inf < overlap[n] <= deepest[n] + states.plate_displacement[n]:
            return n
    for n in range(overlap.size):
        spring = Spring(
            springs.mass[n],
            springs.stiffness[n],
            springs.mobility[n],
            springs.scale[n],
            springs.relaxation[n],
            springs.ratio[n],
            springs.plate,
        )
        state = State(
            states.plate_displacement[n],
            states.largest_compression[n],
            states.force[n],
            states.mobility[n],
            states.stiffening[n],
        )
        state = advance(law, spring, state, overlap[n], step)
        states.plate_displacement[n] = state.plate_displacement
        states.largest_compression[n] = state.largest_compression
        states.force[n] = state.force
        states.mobility[n] = state.mobility
        states.stiffening[n] = state.stiffening
    return -1


class Contacts:
    """Contacts of many beads, one plate each, that an engine steps through.

    Parameters
    ----------
    model : ImpactModel
        Materials and law.
    radius, thickness : array_like
        Of the beads and of their plates [m]; broadcast to one entry per contact.

    Raises
    ------
    ValueError
        If a radius or thickness is no positive number.

    Notes
    -----
    Normal force of a sphere on a large plate: no friction, adhesion or rolling. Second order in the
    step; `time_step` tells which step is short enough.

    Examples
    --------
    A bead dropped at 5 m/s, by velocity Verlet:

    >>> import contactlaw as cl
    >>> from contactlaw.softsphere import Contacts, time_step
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> contacts = Contacts(model, radius=0.9e-3, thickness=1e-3)
    >>> dt = time_step(model, speed=5.0, radius=0.9e-3, thickness=1e-3, error=1e-4)
    >>> overlap, speed, mass = np.zeros(1), np.array([5.0]), contacts.mass
    >>> while speed > 0 or contacts.force > 0:
    ...     speed -= 0.5 * dt * contacts.force / mass
    ...     overlap += dt * speed
    ...     speed -= 0.5 * dt * contacts.advance(overlap, dt) / mass
    >>> bool(abs(-speed[0] / 5 - model.solve(5.0, 0.9e-3, 1e-3).restitution) < 1e-4)
    True
    """

    def __init__(self, model: ImpactModel, radius: ArrayLike, thickness: ArrayLike) -> None:
        r, h, _ = broadcast(radius=radius, thickness=thickness)
        check(radius=r, thickness=h)
        law = model.force_law
        contact = sphere_on_plate(model.pair, law, r, h)
        elastic = contact.yield_compression == math.inf
        enable_caching()
        self._law = law.data
        self._diameters = 2.0 * r  # a sphere that deep is in the plate altogether
        self._springs = Spring(
            mass=contact.mass,
            stiffness=contact.stiffness,
            mobility=contact.mobility,
            scale=np.where(elastic, r, contact.yield_compression),
            relaxation=_relaxation(contact.mass, contact.stiffness),
            ratio=contact.ratio,
            plate=contact.plate,
        )
        self._longest = float(self._springs.relaxation.min(initial=math.inf))
        self._states = State(*(np.zeros(r.size) for _ in State._fields))

    @property
    def mass(self) -> Array:
        """Masses of the beads [kg]."""
        mass: Array = self._springs.mass
        return mass

    @property
    def plate_displacement(self) -> Array:
        """Displacement u2 of the plate under the contact [m]."""
        displacement: Array = self._states.plate_displacement
        return displacement

    @property
    def largest_compression(self) -> Array:
        """Largest compression so far [m]."""
        compression: Array = self._states.largest_compression
        return compression

    @property
    def force(self) -> Array:
        """Contact force at the end of the last step [N]."""
        force: Array = self._states.force
        return force

    def advance(self, overlap: Array, step: float) -> Array:
        """Go to the end of a step.

        Parameters
        ----------
        overlap : ndarray of float64, shape (N,)
            How deep each sphere is in the undeformed plate then [m]; 0 or less: apart. At most its
            diameter and the `plate_displacement`.
        step : float
            Length of the step [s]; at most 1e5 contact times of an impact at 1 m/s.

        Returns
        -------
        ndarray, shape (N,)
            Force on each bead, away from its plate [N]; the same array every time.

        Raises
        ------
        ValueError
            If there is not one finite overlap per contact, or an overlap or the step is beyond any
            contact's; the contacts are as they were then.
        """
        # numpy's own arrays only: of a subclass, a mask or whatever else it adds would be lost
        if type(overlap) is not np.ndarray or overlap.dtype != np.float64:
            refuse_units("overlap", overlap, "m")
            raise ValueError(f"overlap: expected an array of float64, got {overlap!r}")
        if overlap.shape != self.force.shape:
            raise ValueError(
                f"overlap: expected one value per contact, shape {self.force.shape}, got "
                f"{overlap.shape}"
            )
        step = number("step", step)
        if not 0.0 < step <= self._longest:
            raise ValueError(
                f"step: must be positive and at most {self._longest:.3g} s, far longer than any "
                f"contact, got {step!r}; contactlaw.softsphere.time_step advises one"
            )
        wrong = _advance_all(self._law, self._springs, self._states, self._diameters, overlap, step)
        if wrong >= 0:
            self._refuse(overlap[wrong], wrong)
        return self.force

    def _refuse(self, overlap: float, n: int) -> NoReturn:
        if not math.isfinite(overlap):
            what = "must be finite [m]"
        else:
            what = (
                f"must be at most the diameter {self._diameters[n]:.6g} m and the plate's "
                f"displacement {self.plate_displacement[n]:.3g} m"
            )
        raise ValueError(
            f"overlap: {what}, got {float(overlap)!r} (element {n}); has the simulation blown up? "
            "contactlaw.softsphere.time_step advises a step that is short enough"
        )


def time_step(
    model: ImpactModel, speed: float, radius: float, thickness: float, error: float = 5e-4
) -> float:
    """Step with which velocity Verlet meets a wanted error of the COR.

    Parameters
    ----------
    model : ImpactModel
        Materials and law.
    speed, radius, thickness : float
        Of the fastest impact of the smallest bead on the thickest plate [m/s, m, m].
    error : float, optional
        Largest error of the COR [-], between 2e-5 (what the relaxation of the plate may do) and
        1e-2.

    Returns
    -------
    float
        Step [s]: the contact, or an elastic one with a half-space if that is shorter, in
        (0.9/error)^0.4 steps and at least 20. Measured for lambda to 2 and speeds to 7 times the
        yield speed; other laws have corners in their force, by which the error may be 1.3 times
        that (``"jackson_green"``, ``"kogut_etsion"``), with ``"stronge"`` 4 times at 20 steps and
        9 times at 100.

    Raises
    ------
    ValueError
        As `ImpactModel.lookup` on a plate too thin for the model; an error out of its range.

    Examples
    --------
    >>> import contactlaw as cl
    >>> from contactlaw.softsphere import time_step
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> f"{time_step(model, speed=10.0, radius=0.9e-3, thickness=1e-3):.1e} s"
    '2.0e-07 s'
    """
    error = number("error", error)
    if not 2e-5 <= error <= 1e-2:
        raise ValueError(f"error: must lie between 2e-5 and 1e-2, got {error!r}")
    v, r, h = scalars(speed=speed, radius=radius, thickness=thickness)
    units = scales(sphere_on_plate(model.pair, model.force_law, r, h), v)
    lam, largest = float(units.inelasticity[0]), model.largest_inelasticity
    if model.outside == "raise" and lam > largest:  # as a lookup does, but without a table
        raise OutsideTableError(0, too_thin(lam, largest))
    time = np.minimum(model.solve(v, r, h).contact_time, CONTACT_TIME * units.time)
    steps: float = (_ERROR / error) ** 0.4
    return float(time[0]) / max(FEWEST_STEPS, steps)
