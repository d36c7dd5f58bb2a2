"""The attachment of a model to a pymunk space: what its callbacks and its step do."""

from __future__ import annotations

import math
import sys
import threading
from collections.abc import Callable, Mapping
from functools import lru_cache, partial
from itertools import count
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from contactlaw.engines.needs import RestitutionModel
from contactlaw.engines.pymunk.lookahead import LookAhead, tunnelling
from contactlaw.engines.pymunk.record import Record
from contactlaw.engines.pymunk.registry import (
    Bead,
    Plate,
    body_of,
    checked_model,
    scalar,
    sphere_curve,
    unregistered,
)

if TYPE_CHECKING:
    import pymunk

# An approach slower than this many times the speed that gravity gives in one step rests. Without
# it a pile of 120 beads with restitution 0.9 never settles (5000 impacts per bead and second).
RESTING = 2.0
# Slower than this many smallest radii per step is rounding, and all that rests without gravity.
ROUNDING = 1e-12

# Far from the small numbers that people choose; below 2**32, the limit on 32-bit machines.
_collision_types = count(0xC0A70000)

Callback = Callable[["pymunk.Arbiter", "pymunk.Space", Any], None]


def attach(space: pymunk.Space, model: RestitutionModel) -> PymunkImpacts:
    """Let a model decide how the beads of a pymunk space rebound.

    Parameters
    ----------
    space : pymunk.Space
        In metres and seconds. Its ``step`` is taken over until `PymunkImpacts.detach`.
    model : RestitutionModel
        An `ImpactModel`, or any object with ``curve(radius, thickness)``, which gives a function of
        speed; for bead on bead ``sphere_sphere_curve(radius, other_radius)`` too. One that is no
        `contactlaw.engines.needs.ReboundModel` leaves the record without contact times, forces,
        energies and flags.

    Returns
    -------
    PymunkImpacts
        Register beads and plates with it, then step the space as ever.

    Raises
    ------
    ImportError, TypeError, RuntimeError
        No pymunk; not a space or a model; a space that has a model attached already.

    Examples
    --------
    >>> import pymunk
    >>> import contactlaw as cl
    >>> from contactlaw.engines.pymunk import attach
    >>> space = pymunk.Space()
    >>> body = pymunk.Body(mass=2.7e-6, moment=8.7e-13)
    >>> body.position, body.velocity = (0, 1e-3), (0, -5)
    >>> bead = pymunk.Circle(body, radius=0.9e-3)
    >>> plate = pymunk.Segment(space.static_body, (-1, 0), (1, 0), radius=0)
    >>> space.add(body, bead, plate)
    >>> impacts = attach(space, cl.ImpactModel(cl.Pair("gamma-alumina", "glass")))
    >>> impacts.add_bead(bead), impacts.add_plate(plate, thickness=1e-3)
    (0, 0)
    >>> for _ in range(10):
    ...     space.step(1e-5)
    >>> hit = impacts.collisions()[0]
    >>> f"{hit['restitution']:.4f} at {hit['approach_speed']} m/s, {hit['peak_force']:.1f} N"
    '0.9081 at 5.0 m/s, 9.7 N'
    """
    try:
        import pymunk
    except ImportError as error:
        raise ImportError("this adapter needs pymunk: pip install contactlaw[demo]") from error
    if not isinstance(space, pymunk.Space):
        raise TypeError(f"space: expected a pymunk.Space, got {space!r}")
    checked_model(model)
    if isinstance(getattr(vars(space).get("step"), "__self__", None), PymunkImpacts):
        raise RuntimeError("space: a model is attached already; detach() that attachment first")
    return PymunkImpacts(space, model)


class PymunkImpacts:
    """The beads, plates and impacts of one space; made by `attach`.

    Attributes
    ----------
    bead_type, plate_type : int
        Collision types of the registered shapes, for handlers of your own:
        ``space.on_collision(impacts.bead_type, my_type, begin=...)``.
    time : float
        Sum of the steps so far [s].
    resting : int
        Contacts too slow for an impact, one per contact and step.
    """

    def __init__(self, space: pymunk.Space, model: RestitutionModel) -> None:
        self.bead_type = next(_collision_types)
        self.plate_type = next(_collision_types)
        self.time = 0.0
        self.resting = 0
        self._space = space
        self._model = model
        self._beads: dict[Any, Bead] = {}  # by shape
        self._bodies: dict[int, Bead] = {}  # by id of the body
        self._plates: dict[Any, Plate] = {}
        self._record = Record()
        self._steps = 0
        self._resting_speed = 0.0
        self._attached = True
        self._error: BaseException | None = None
        self._lookahead = LookAhead(space, self._bodies, self._plates)
        self._slop = space.collision_slop
        # Bounded: a thousand different beads make half a million pairs.
        self._sphere_curve = lru_cache(maxsize=65536)(partial(sphere_curve, model))
        self._replaced = vars(space).get("step")
        self._engine_step = space.step
        vars(space)["step"] = self._step
        for kind, others in ((self.plate_type, self._plates), (self.bead_type, self._beads)):
            space.on_collision(self.bead_type, kind, pre_solve=self._callback(others))

    def add_bead(self, circle: pymunk.Circle) -> int:
        """Register a sphere; its radius is the circle's.

        Parameters
        ----------
        circle : pymunk.Circle
            Centred on a dynamic body of its own, with collision type 0. Where beads meet, the
            body's mass should be the sphere's, ``4/3 pi radius**3 density`` [kg].

        Returns
        -------
        int
            Index of the bead in the record.
        """
        import pymunk

        body = self._admit(circle, pymunk.Circle, self.bead_type)
        radius = scalar(radius=circle.radius)
        if body.body_type != pymunk.Body.DYNAMIC:
            raise ValueError(f"circle.body: a bead needs a dynamic body, got {body!r}")
        if circle.offset != (0, 0) or body.center_of_gravity != (0, 0):
            raise ValueError(
                "circle: a bead is a sphere centred on its body; set circle.offset and "
                f"body.center_of_gravity to (0, 0), got {circle.offset}, {body.center_of_gravity}"
            )
        if body.id in self._bodies:
            raise ValueError(f"circle.body: carries bead {self._bodies[body.id].index} already")
        bead = Bead(len(self._beads), circle, body, radius, self._sphere_curve)
        self._beads[circle] = self._bodies[body.id] = bead
        circle.collision_type = self.bead_type
        self._lookahead.reach = min(self._lookahead.reach, radius)
        self._space.collision_slop = min(self._space.collision_slop, 0.1 * radius)
        return bead.index

    def add_plate(
        self,
        segment: pymunk.Segment,
        thickness: float,
        *,
        model: RestitutionModel | None = None,
    ) -> int:
        """Register a plate; its body may be static, kinematic (a sieve) or dynamic.

        Parameters
        ----------
        segment : pymunk.Segment
            With collision type 0. Its radius is geometry only. If it moves, then by its body's
            velocity: an engine takes no notice of a position that is set.
        thickness : float
            Thickness for the model [m]; ``inf`` is the half-space.
        model : RestitutionModel, optional
            For a plate of another material than that of the attached model.

        Returns
        -------
        int
            Index of the plate in the record.
        """
        import pymunk

        body = self._admit(segment, pymunk.Segment, self.plate_type)
        thickness = scalar(thickness=thickness)
        if segment.a == segment.b:
            raise ValueError(f"segment: has no length, both ends are at {tuple(segment.a)}")
        model = self._model if model is None else checked_model(model, beads=self._model)
        plate = Plate(len(self._plates), segment, body, thickness, model)
        self._plates[segment] = plate
        segment.collision_type = self.plate_type
        return plate.index

    def collisions(self) -> NDArray[np.void]:
        """Every impact so far, one row each, in SI units.

        Returns
        -------
        structured array
            A copy with the columns of `contactlaw.engines.record.COLUMNS`, which have their units
            there: time, bead, plate, other, x, y, z (0), approach_speed, restitution; if every
            model is a `ReboundModel` also contact_time, peak_force, plastic_energy, wave_energy and
            flags. Energies are those of solid spheres (bead on bead: of the relative motion, with
            the reduced mass).
        """
        radii = [bead.radius for bead in self._beads.values()]
        plates = [(plate.model, plate.thickness) for plate in self._plates.values()]
        return self._record.read(self._model, radii, plates)

    def detach(self) -> None:
        """Give the space back as it was; the record stays readable. Again: nothing happens.

        Raises
        ------
        RuntimeError
            If ``space.step`` has been replaced since; detaching would undo that too.
        """
        import pymunk

        state = vars(self._space)
        if not self._attached:
            return
        if state.get("step") != self._step:
            raise RuntimeError("space.step has been replaced since attach(); undo that first")
        del state["step"]
        if self._replaced:
            state["step"] = self._replaced
        for other in (self.plate_type, self.bead_type):
            self._space.on_collision(self.bead_type, other, pre_solve=pymunk.empty_callback)
        for shape in (*self._beads, *self._plates):
            shape.collision_type = 0
        self._space.collision_slop = self._slop
        self._attached = False

    def __reduce_ex__(self, protocol: Any) -> NoReturn:
        raise TypeError(
            "a space with an impact model cannot be copied or pickled: detach() first, and attach "
            "to the copy"
        )

    def _admit(self, shape: Any, kind: type, collision_type: int) -> pymunk.Body:
        if not self._attached:
            raise RuntimeError("this attachment is detached: call attach(space, model) again")
        if shape in self._beads or shape in self._plates:
            raise ValueError(f"{shape!r} is registered already")
        return body_of(shape, kind, self._space, collision_type)

    def _step(self, dt: float) -> None:
        """Stand in for ``space.step``."""
        if not 0.0 < dt < math.inf:
            raise ValueError(f"dt: must be positive and finite [s], got {dt!r}")
        self._error = None
        self._lookahead.check(dt, self.time)
        rounding = ROUNDING * self._lookahead.reach / dt
        self._resting_speed = max(RESTING * self._space.gravity.length * dt, rounding)
        self.time += dt
        self._steps += 1
        # cffi hands exceptions in callbacks to this hook: those of the user's own handlers, and a
        # Ctrl-C, which as a rule arrives in pymunk's Python code around a callback and not in ours.
        # The hook is for all threads, signals are for the main thread: so only there.
        if threading.current_thread() is threading.main_thread():
            self._hook, sys.unraisablehook = sys.unraisablehook, self._unraisable
            try:
                self._engine_step(dt)
            finally:
                sys.unraisablehook = self._hook
        else:
            self._engine_step(dt)
        if self._error is not None:
            error, self._error = self._error, None
            raise error

    def _unraisable(self, report: sys.UnraisableHookArgs) -> None:
        here = threading.current_thread() is threading.main_thread()
        if here and report.exc_value and "cffi callback" in (report.err_msg or ""):
            self._keep(report.exc_value)
        else:
            self._hook(report)

    def _callback(self, others: Mapping[Any, Bead | Plate]) -> Callback:
        """Make the callback for contacts of beads with plates, or with each other."""
        # Found beforehand: it is called for every contact in every step, and a pile has many.
        on_plate = others is self._plates
        bead_of, other_of, record = self._beads.get, others.get, self._record.add

        def pre_solve(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
            try:
                circle, shape = arbiter.shapes
                bead, other = bead_of(circle), other_of(shape)
                if bead is None or other is None:
                    raise unregistered(circle if bead is None else shape)
                if not arbiter.process_collision:  # switched off by a user's `begin`
                    return
                nx, ny = arbiter.normal  # from the bead to the other
                vx, vy = bead.body.velocity
                (ux, uy), point = other.motion(bead, nx, ny)
                speed = (vx - ux) * nx + (vy - uy) * ny
                if other.passed(bead, nx, ny, self._steps):
                    raise tunnelling(bead.index, other.index, self.time, abs(speed), None)
                if speed <= self._resting_speed + RESTING * other.shake:
                    arbiter.restitution = 0.0
                    if speed > 0.0:  # or else they separate, or stay together
                        self.resting += 1
                    return
                arbiter.restitution = restitution = self._restitution(bead, other, speed)
                x, y = point or bead.contact(nx, ny)
                plate, target = (other.index, -1) if on_plate else (-1, other.index)
                record((self.time, bead.index, plate, target, x, y, 0.0, speed, restitution))
            except BaseException as error:
                self._keep(error, arbiter)

        return pre_solve

    def _restitution(self, bead: Bead, other: Bead | Plate, speed: float) -> float:
        """Ask the model, and check for the engine, which checks nothing."""
        try:
            restitution = other.curve(bead.radius)(speed)
        except Exception as error:
            error.add_note(self._describe(bead, other, speed))
            raise
        if not 0.0 <= restitution <= 1.0:
            where = self._describe(bead, other, speed)
            raise ValueError(
                f"restitution must lie in [0, 1], the model gave {restitution!r} {where}"
            )
        return restitution

    def _describe(self, bead: Bead, other: Bead | Plate, speed: float) -> str:
        return f"for {bead} on {other} at {speed:.9g} m/s, t = {self.time:.9g} s"

    def _keep(self, error: BaseException, arbiter: pymunk.Arbiter | None = None) -> None:
        """Keep the first error of a step; an interrupt goes before everything."""
        if arbiter is not None:
            arbiter.restitution = 0.0
        if self._error is None or not isinstance(error, Exception):
            self._error = error
