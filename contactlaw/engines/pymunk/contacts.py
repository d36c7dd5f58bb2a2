"""The callbacks of contacts: which bead and plate meet, how fast, and with what restitution."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from contactlaw.engines.pymunk.handlers import Callback, Hook, overridden
from contactlaw.engines.pymunk.lookahead import tunnelling
from contactlaw.engines.pymunk.record import Record
from contactlaw.engines.pymunk.registry import BeadShape, PlateShape, changed, unregistered
from contactlaw.engines.pymunk.seams import belongs_to_neighbour

if TYPE_CHECKING:
    import pymunk

# An approach slower than this many times the speed that gravity gives in one step is at rest.
# Otherwise a pile of 120 beads with restitution 0.9 never settles (5000 impacts a bead and second).
RESTING = 2.0
# Speeds below this many smallest radii per step are rounding errors. Without gravity this is the
# only limit.
ROUNDING = 1e-12


class Contacts:
    """The contacts of one space, answered by two callbacks.

    Attributes
    ----------
    beads, plates : dict
        Registered beads and plates by the id of their shape.
    record : Record
        Record of all impacts.
    time, steps : float, int
        Sum [s] and number of the steps so far.
    resting : int
        Number of contacts too slow for an impact.
    error : BaseException or None
        The first error in this step; an interrupt takes precedence over others.
    """

    def __init__(self) -> None:
        self.beads: dict[int, BeadShape] = {}
        self.plates: dict[int, PlateShape] = {}
        self.record = Record()
        self.time = 0.0
        self.steps = 0
        self.resting = 0
        self.error: BaseException | None = None
        self._resting_speed = 0.0

    def begin(self, dt: float, gravity: float, reach: float) -> None:
        """Prepare for a step of length dt [s] under gravity [m/s2]; reach: least radius [m]."""
        self._resting_speed = max(RESTING * gravity * dt, ROUNDING * reach / dt)
        self.time += dt
        self.steps += 1

    # The two callbacks run for every contact in every step, and a pile has many contacts. So
    # attributes are looked up once, and few functions are called.
    def on_plates(self, hooks: list[Hook]) -> Callback:
        """Make the callback for contacts of beads with plates; it calls those of the user first."""
        bead_of, plate_of, record = self.beads.get, self.plates.get, self.record.add

        def pre_solve(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
            try:
                circle, shape = arbiter.shapes
                bead, plate = bead_of(id(circle)), plate_of(id(shape))
                if bead is None or plate is None:
                    raise unregistered(circle if bead is None else shape)
                if bead.ceded:
                    self._resume(arbiter, bead, plate)
                if hooks:
                    _call(hooks, arbiter, space)
                if not arbiter.process_collision or circle.sensor or shape.sensor:
                    return
                body: Any = circle.body
                x, y = body.position
                if plate.joints and belongs_to_neighbour(bead, plate, circle, shape, x, y):
                    self._cede(arbiter, bead, plate)
                    return
                nx, ny = arbiter.normal  # from the bead to the plate
                x, y = x + bead.radius * nx, y + bead.radius * ny
                vx, vy = body.velocity
                ux, uy = plate.velocity_at(shape, x, y)
                speed = (vx - ux) * nx + (vy - uy) * ny
                if plate.passed(bead, nx, ny, self.steps):
                    raise tunnelling(bead.index, plate.index, self.time, abs(speed), None)
                if speed <= self._resting_speed + RESTING * plate.shake:
                    self._rest(arbiter, speed)
                    return
                cor = self._answer(arbiter, bead, plate, circle, shape, speed)
                record((self.time, bead.index, plate.index, -1, x, y, 0.0, speed, cor))
            except BaseException as error:
                self.keep(error, arbiter)

        return pre_solve

    def on_beads(self, hooks: list[Hook]) -> Callback:
        """Make the callback for contacts of beads with each other."""
        bead_of, record = self.beads.get, self.record.add

        def pre_solve(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
            try:
                circle, shape = arbiter.shapes
                bead, other = bead_of(id(circle)), bead_of(id(shape))
                if bead is None or other is None:
                    raise unregistered(circle if bead is None else shape)
                if hooks:
                    _call(hooks, arbiter, space)
                if not arbiter.process_collision or circle.sensor or shape.sensor:
                    return
                body: Any = circle.body
                other_body: Any = shape.body
                nx, ny = arbiter.normal  # through both centres, so that spin has no part
                (vx, vy), (ux, uy) = body.velocity, other_body.velocity
                speed = (vx - ux) * nx + (vy - uy) * ny
                if speed <= self._resting_speed:
                    self._rest(arbiter, speed)
                    return
                cor = self._answer(arbiter, bead, other, circle, shape, speed)
                x, y = body.position
                x, y = x + bead.radius * nx, y + bead.radius * ny
                record((self.time, bead.index, -1, other.index, x, y, 0.0, speed, cor))
            except BaseException as error:
                self.keep(error, arbiter)

        return pre_solve

    def _resume(self, arbiter: pymunk.Arbiter, bead: BeadShape, plate: PlateShape) -> None:
        """Process a contact again that was ceded to a neighbour, as pymunk does not by itself."""
        if bead.ceded.pop(plate.index, None) == self.steps - 1:
            arbiter.process_collision = True

    def _cede(self, arbiter: pymunk.Arbiter, bead: BeadShape, plate: PlateShape) -> None:
        """Cede a contact to the plate's neighbour, for this step."""
        arbiter.process_collision = False
        bead.ceded[plate.index] = self.steps

    def _rest(self, arbiter: pymunk.Arbiter, speed: float) -> None:
        """Let a contact rest that is too slow for an impact."""
        arbiter.restitution = 0.0
        if speed > 0.0:  # at other speeds the bodies separate or stay together
            self.resting += 1

    def is_ours(self, arbiter: pymunk.Arbiter) -> bool:
        """Whether both shapes of a contact are registered."""
        keys = [id(shape) for shape in arbiter.shapes]
        return all(key in self.beads or key in self.plates for key in keys)

    def undo(self, arbiter: pymunk.Arbiter) -> None:
        """Remove the impact of a contact that a user's handler has switched off since."""
        keys = [id(shape) for shape in arbiter.shapes]  # in the order of that handler's types
        beads = [self.beads[key].index for key in keys if key in self.beads]
        plates = [self.plates[key].index for key in keys if key in self.plates]
        bead, other = beads if len(beads) == 2 else (beads[0], -1)
        plate = plates[0] if plates else -1
        for one, two in ((bead, other), (other, bead)):
            self.record.undo(self.time, one, plate, two)

    def _answer(
        self,
        arbiter: pymunk.Arbiter,
        bead: BeadShape,
        other: BeadShape | PlateShape,
        circle: Any,
        shape: Any,
        speed: float,
    ) -> float:
        """Ask the model for the restitution, check it, and give it to the engine."""
        if circle.radius != bead.radius:
            raise changed(bead, circle)
        try:
            restitution = other.curve(bead, shape)(speed)
        except Exception as error:
            error.add_note(self._describe(bead, other, speed))
            raise
        if not 0.0 <= restitution <= 1.0:
            where = self._describe(bead, other, speed)
            raise ValueError(
                f"restitution must lie in [0, 1], the model gave {restitution!r} {where}"
            )
        arbiter.restitution = restitution
        return restitution

    def _describe(self, bead: BeadShape, other: BeadShape | PlateShape, speed: float) -> str:
        return f"for {bead} on {other} at {speed:.9g} m/s, t = {self.time:.9g} s"

    def keep(self, error: BaseException, arbiter: pymunk.Arbiter | None = None) -> None:
        """Keep the first error of a step; an interrupt takes precedence over others."""
        if arbiter is not None:
            arbiter.restitution = 0.0
        if self.error is None or not isinstance(error, Exception):
            self.error = error


def _call(hooks: list[Hook], arbiter: pymunk.Arbiter, space: pymunk.Space) -> None:
    """Call the user's ``pre_solve``, before the model sets the restitution."""
    before = arbiter.restitution
    for callback, data in hooks:
        callback(arbiter, space, data)
    if arbiter.restitution != before:
        one, two = arbiter.shapes
        raise overridden((one.collision_type, two.collision_type), arbiter.restitution)
