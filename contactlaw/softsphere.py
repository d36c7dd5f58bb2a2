"""The stateful law: contact force step by step, for engines that integrate through the contact.

Soft-sphere engines (LAMMPS, YADE, a loop of one's own) resolve a contact in some tens of steps. In
each one they know how deep the sphere is in the undeformed plate, the overlap; `Contacts` gives the
force for arrays of contacts, `advance` within a compiled loop, and `time_step` a step that is short
enough. `contactlaw.stepping` has the schemes, in `spring` and `friction`.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._arrays import Array
from contactlaw._errors import ArgumentError
from contactlaw._jit import enable_caching, kernel, tuple_of
from contactlaw.answers.solver import Solver
from contactlaw.equation.corrections import CONTACT_TIME
from contactlaw.equation.edge import Edge
from contactlaw.equation.numbers import PlateConstants
from contactlaw.model import ImpactModel
from contactlaw.physical.arguments import number, refuse_units, scalars
from contactlaw.physical.bodies import SphereOnPlate
from contactlaw.physical.scaling import plate_mobility
from contactlaw.physical.strengths import COARSE, by_strength
from contactlaw.physical.vectors import dot
from contactlaw.stepping.edge import EdgeEcho, edge_echo
from contactlaw.stepping.friction import DEEPEST, FRICTION, check_friction, clear_friction, tangential_force
from contactlaw.stepping.softened import DEEPEST_OVERLAP, SoftState, advance_softened, check_softening
from contactlaw.stepping.spring import (
    FEWEST_STEPS,
    PARTED,
    RELAXATION,
    Spring,
    State,
    advance,
    at_usual_frequency,
    impact,
    resized,
    unit_spring,
)
from contactlaw.table import Settings
from contactlaw.walls.facet import Point

__all__ = [
    "PARTED",
    "Contacts",
    "SoftState",
    "Spring",
    "State",
    "advance",
    "advance_softened",
    "law_of",
    "most_softening",
    "resized",
    "time_step",
    "unit_spring",
]

# Largest error of COR times (steps per contact)^2.5, at any phase of the first touch: 0.86 measured
# with velocity Verlet and the law myc, for lambda to 2 and speeds to 7 V_Y0, at 20, 50, 100 steps.
_ERROR = 0.9
# With 20 the COR of a softened contact is right, too; friction of beads that roll likes shorter.
_SOFTENED_STEPS = 30
# Overlap at the slowest speed over v^2/g, by which a bead's rebound from below the surface is
# higher than from the surface.
_WEIGHT = 0.005
GRAVITY = 9.81  # [m/s2]


class _Batch(NamedTuple):
    """Contacts of one model, as kernels take them."""

    law: Array
    tangential: float  # stiffness along the surface over that across it
    plate: PlateConstants
    near: EdgeEcho | None
    springs: Any  # a row with the fields of Spring for each contact
    states: Any  # a row with the fields of State
    values: Array  # the numbers of these rows
    friction: Any  # rows of FRICTION
    force: Array  # [N]
    largest: Array  # largest compression before the last step [m]


@kernel(inline=True)
def _spring_at(batch: _Batch, n: int) -> Spring:
    return at_usual_frequency(tuple_of(Spring, batch.springs[n], plate=batch.plate))


@kernel(inline=True)
def _near_at(near: EdgeEcho | None, n: int) -> EdgeEcho | None:
    if near is None:
        return None
    return EdgeEcho(near.response[n], near.rate[n])


@kernel(inline=True)
def _sliding_at(normal: Array, velocity: Array, n: int) -> tuple[Point, Point, float]:
    """Read the normal of a contact, and the velocity of its surface along the plate and away from it."""
    at = normal[n, 0], normal[n, 1], normal[n, 2]
    slip = velocity[n, 0], velocity[n, 1], velocity[n, 2]
    up = dot(slip, at)
    return at, (slip[0] - up * at[0], slip[1] - up * at[1], slip[2] - up * at[2]), up


@kernel(cache=True)
def _advance_all(batch: _Batch, overlap: Array, step: float) -> None:
    """`advance` for arrays, in place."""
    for n in range(overlap.size):
        last, near = tuple_of(State, batch.states[n]), _near_at(batch.near, n)
        state = advance(batch.law, _spring_at(batch, n), last, overlap[n], step, near)
        for k in range(len(state)):
            batch.values[n, k] = state[k]
        batch.force[n] = state.force


@kernel(cache=True)
def _slide_all(
    batch: _Batch, friction: float, overlap: Array, normal: Array, velocity: Array, step: float, force: Array
) -> None:
    """Friction of arrays of contacts."""
    for n in range(overlap.size):
        state, row, out = tuple_of(State, batch.states[n]), batch.friction[n], (0.0, 0.0, 0.0)
        if state.force > 0.0:
            at, slip, up = _sliding_at(normal, velocity, n)
            x, law, kappa, before = overlap[n], batch.law, batch.tangential, batch.largest[n]
            spring = _spring_at(batch, n)
            out = tangential_force(row, friction, kappa, law, spring, state, before, x, -up, at, slip, step, 0.0)
        else:
            clear_friction(row)
        force[n, 0], force[n, 1], force[n, 2] = out
        batch.largest[n] = state.largest_compression


def law_of(model: ImpactModel) -> Array:
    """Force law of a model at any strength, for `advance`.

    Examples
    --------
    >>> import contactlaw as cl
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    >>> law_of(model) is model.force_law.data  # this pair knows no rate
    True
    """
    return by_strength(model.pair, model.force_law, COARSE)


class Contacts:
    """Contacts of many beads, one plate each, that an engine steps through.

    Parameters
    ----------
    model : ImpactModel
        Materials and law.
    radius, thickness : array_like
        Of the beads and of their plates [m]; broadcast to one entry per contact.
    edge, edge_distance, hole_radius, mass
        As in `ImpactModel.restitution`.

    Raises
    ------
    ValueError
        If a radius or thickness is no positive number.

    Notes
    -----
    Normal force of a sphere on a large plate, by `advance`, and friction, by `slide`; no adhesion
    or rolling. Second order in the step; `time_step` gives a step that is short enough.

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

    def __init__(
        self,
        model: ImpactModel,
        radius: ArrayLike,
        thickness: ArrayLike,
        edge: Edge = "free",
        edge_distance: ArrayLike = math.inf,
        hole_radius: ArrayLike = math.inf,
        mass: ArrayLike | None = None,
    ) -> None:
        bodies = SphereOnPlate(model.pair, model.force_law)
        given = bodies.given(1.0, radius, thickness, edge, edge_distance, hole_radius, mass)
        r, h = given.radius, given.thickness
        near: tuple[Array | None, Array | None] = (None, None) if given.edge is None else given.edge[1:]
        unit = unit_spring(model, 1.0)
        relaxation = unit.relaxation * r
        self._longest = float(relaxation.min(initial=math.inf))
        enable_caching()
        springs = {
            "mass": bodies.mass(given),
            "solid": bodies.solid_mass(r),
            "stiffness": unit.stiffness * np.sqrt(r),
            "mobility": plate_mobility(model.pair.plate, h),
            "scale": unit.scale * r,
            "relaxation": relaxation,
            "ratio": r / h,
        }
        states = np.zeros(r.size, [(name, "f8") for name in State._fields]).view(np.recarray)
        self._batch = _Batch(
            law=law_of(model),
            tangential=model.pair.tangential_ratio,
            plate=unit.plate,
            near=edge_echo(model.pair.plate, h, edge, *near, relaxation / (RELAXATION * CONTACT_TIME)),
            springs=np.rec.fromarrays([*springs.values()], dtype=[(name, "f8") for name in springs]),
            states=states,
            values=states.view(np.float64).reshape(r.size, len(states.dtype)),
            friction=np.zeros(r.size, FRICTION),
            force=np.zeros(r.size),
            largest=np.zeros(r.size),
        )
        self._diameters = 2.0 * r  # with this overlap a sphere is in the plate altogether
        self._pair, self._overlap, self._step, self._sliding = model.pair, np.zeros(r.size), 0.0, np.zeros((r.size, 3))

    @property
    def mass(self) -> Array:
        """Masses of the beads [kg]."""
        return np.asarray(self._batch.springs["mass"])

    @property
    def plate_displacement(self) -> Array:
        """Displacement u2 of the plate under the contact [m]."""
        return np.asarray(self._batch.states.plate_displacement)

    @property
    def largest_compression(self) -> Array:
        """Largest compression so far [m]."""
        return np.asarray(self._batch.states.largest_compression)

    @property
    def force(self) -> Array:
        """Contact force at the end of the last step [N]."""
        return self._batch.force

    def advance(self, overlap: Array, step: float) -> Array:
        """Go to the end of a step.

        Parameters
        ----------
        overlap : ndarray of float64, shape (N,)
            Depth of each sphere in the undeformed plate at the end of the step [m]; 0 or less:
            apart. At most its diameter plus the `plate_displacement`.
        step : float
            Length of the step [s]; at most 1e5 contact times of an impact at 1 m/s.

        Returns
        -------
        ndarray, shape (N,)
            Force on each bead, away from its plate [N]; the same array every time.

        Raises
        ------
        ValueError
            If there is not one finite overlap per contact, or an overlap or the step is too large
            for any contact; the contacts are unchanged then.
        """
        # numpy's own arrays only: what a subclass adds, such as a mask, would be lost
        if type(overlap) is not np.ndarray or overlap.dtype != np.float64:
            refuse_units("overlap", overlap, "m")
            raise ArgumentError("overlap", overlap, "expected an array of float64")
        if overlap.shape != self.force.shape:
            reason = f"expected a value per contact, {self.force.shape}, got {overlap.shape}"
            raise ArgumentError("overlap", None, reason)
        step = number("step", step)
        if not 0.0 < step <= self._longest:
            longest = f"{self._longest:.3g} s, far longer than any contact"
            remedy = "contactlaw.softsphere.time_step advises one"
            raise ArgumentError("step", step, f"must be positive and at most {longest}; {remedy}")
        # a sphere is at most as deep as its diameter below where the plate is now
        possible = (overlap > -math.inf) & (overlap <= self._diameters + self.plate_displacement)
        if not possible.all():
            self._refuse(overlap, int(np.argmin(possible)))
        _advance_all(self._batch, overlap, step)
        self._overlap[:], self._step = overlap, step
        return self.force

    def slide(self, normal: ArrayLike, velocity: ArrayLike, friction: float) -> Array:
        """Friction in the step that `advance` has just taken; call it in every step, once.

        Parameters
        ----------
        normal : array_like, shape (N, 3) or (3,)
            Unit vectors from the plates to the beads.
        velocity : array_like, shape (N, 3)
            Of the beads' surfaces at the contacts, ``v - r cross(spin, normal)``, less those of the
            plates [m/s]; with velocity Verlet or leapfrog that half a step before.
        friction : float
            Coulomb's coefficient [-].

        Returns
        -------
        ndarray, shape (N, 3)
            Force on each bead along its plate [N]; the same array every time. The torque is
            ``-r cross(normal, force)``.

        Raises
        ------
        TypeError, ValueError
            If a shape is wrong, or the friction is no finite number of 0 or more.
        """
        check_friction(friction)
        shape = self._sliding.shape
        normals, velocities = (
            np.ascontiguousarray(np.broadcast_to(one, shape), np.float64) for one in (normal, velocity)
        )
        _slide_all(self._batch, float(friction), self._overlap, normals, velocities, self._step, self._sliding)
        for n in np.flatnonzero(~np.isfinite(self._sliding.sum(axis=1))):
            reason = f"no finite friction at {velocities[n]} m/s, {self._pair}"
            raise ArgumentError("velocity", None, reason)
        return self._sliding

    def _refuse(self, overlap: Array, n: int) -> NoReturn:
        depth, displacement = self._diameters[n], self.plate_displacement[n]
        most = f"the diameter {depth:.6g} m and the plate's displacement {displacement:.3g} m"
        what = f"must be at most {most}" if math.isfinite(overlap[n]) else "must be finite [m]"
        remedy = "contactlaw.softsphere.time_step advises a step that is short enough"
        raise ArgumentError("overlap", float(overlap[n]), f"{what}; has the simulation blown up? {remedy}", n)


def most_softening(model: ImpactModel, speed: float, radius: float, slowest: float = 0.1, parcel: float = 1.0) -> float:
    """Most by which contacts may be softened at these speeds.

    Parameters
    ----------
    model : ImpactModel
        Materials and law.
    speed, slowest : float
        Of the fastest and the slowest impact that matter [m/s].
    radius : float
        Of the largest bead [m].
    parcel : float, optional
        Its radius over that of the true beads for which it stands.

    Returns
    -------
    float
        Number by which the modulus may be divided [-], at least 1: overlaps at `speed` are below
        2 % of the radius; and at `slowest` the weight changes the COR by about
        0.005 (1 - e^2)/e at most, because a bead leaves the wall from so far below its surface.

    Raises
    ------
    ValueError
        If a number is not positive, or `slowest` above `speed`.

    Examples
    --------
    >>> import contactlaw as cl
    >>> from contactlaw.softsphere import most_softening
    >>> model = cl.ImpactModel(cl.Pair("bearing-steel-52100", "steel-s235"))
    >>> f"{most_softening(model, speed=0.5, radius=1e-3):.0f}"
    '677'
    """
    v, r, slow = (float(one[0]) for one in scalars(speed=speed, radius=radius, slowest=slowest))
    if slow > v:
        raise ArgumentError("slowest", slow, f"must be at most the fastest speed, {v:g} m/s")
    check_softening(1.0, parcel)
    law, spring = law_of(model), resized(unit_spring(model, 1.0), r / parcel)
    deepest = [DEEPEST * impact(law, spring, one).compression for one in (v, slow)]
    limits = DEEPEST_OVERLAP * r, _WEIGHT * slow * slow / GRAVITY
    least = min(limit / depth for limit, depth in zip(limits, deepest, strict=True))
    return max(1.0, float(f"{least**2.5:.6g}"))


def time_step(
    model: ImpactModel,
    speed: float,
    radius: float,
    thickness: float,
    error: float = 5e-4,
    mass: float | None = None,
    softening: float = 1.0,
    parcel: float = 1.0,
) -> float:
    """Step with which velocity Verlet meets a wanted error of the COR.

    Parameters
    ----------
    model : ImpactModel
        Materials and law.
    speed, radius, thickness : float
        Of the fastest impact of the smallest bead on the thickest plate [m/s, m, m].
    error : float, optional
        Largest error of the COR [-], between 2e-5 (to which the plate's relaxation may add up) and
        1e-2.
    mass : float, optional
        Mass of that bead [kg], as in `ImpactModel.restitution`.
    softening : float, optional
        Number by which the modulus of the contacts is divided, as `most_softening` gives it. The
        step is then 1/30 of a contact, whatever the error, because the COR does not depend on it.
    parcel : float, optional
        Radius of that bead over that of the true beads for which it stands.

    Returns
    -------
    float
        Step [s]: the contact, or an elastic one with a half-space if that is shorter, in
        (0.9/error)^0.4 steps and at least 20. Measured for lambda to 2 and speeds to 7 times the
        yield speed; other laws have corners in their force, by which the error may be 1.3 times
        that (``"jackson_green"``, ``"kogut_etsion"``). Bodies with losses that flow keep the yield
        compression of an impact at 3 m/s: at other speeds their COR errs by up to 0.04 tan delta
        more from 1 to 10 m/s.

    Raises
    ------
    ValueError
        If the plate is too thin, as in `ImpactModel.lookup`, or `error` is out of its range.

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
        raise ArgumentError("error", error, "must lie between 2e-5 and 1e-2")
    v, r, h = scalars(speed=speed, radius=radius, thickness=thickness)
    check_softening(softening, parcel)
    r = r / parcel
    bodies = SphereOnPlate(model.pair, model.force_law)
    given = bodies.given(v, r, h, mass=None if mass is None else number("mass", mass))
    # too thin a plate is refused as by a lookup, but without a table
    thinnest = Settings(largest_inelasticity=model.largest_inelasticity, largest_overload=1e20)
    (found,) = Solver(bodies, extent=thinnest if model.outside == "raise" else None).far(given)
    unit = float(found.time[0])
    time = min(float(found.outcome.contact_time[0]), CONTACT_TIME) * unit
    steps: float = max(FEWEST_STEPS, (_ERROR / error) ** 0.4)
    if softening > 1.0:
        steps, time = _SOFTENED_STEPS, CONTACT_TIME * unit * softening**0.4
    # Six digits only, so that a script has the same steps whether or not the kernels were compiled.
    return float(f"{time / steps:.6g}")
