"""The callbacks of contacts: which bead and plate meet, how fast, and with what restitution."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from contactlaw.engines.needs import CorBySpeed
from contactlaw.engines.pymunk.edges import PlateEdges
from contactlaw.engines.pymunk.friction import LOOSE, Rubbing, belt, check_moment, sliding
from contactlaw.engines.pymunk.handlers import Callback, Hook, overridden
from contactlaw.engines.pymunk.lookahead import TunnellingError
from contactlaw.engines.pymunk.record import Record
from contactlaw.engines.pymunk.registry import BeadShape, PlateShape, changed, unregistered
from contactlaw.engines.pymunk.seams import belongs_to_neighbour
from contactlaw.engines.record import Kind
from contactlaw.equation.tangential import POINT
from contactlaw.stepping.loads import NUMBERS

if TYPE_CHECKING:
    import pymunk

# An approach slower than this many times the speed that gravity gives in one step is at rest.
# Otherwise a pile of 120 beads with restitution 0.9 never settles (5000 impacts a bead and second).
RESTING = 2.0
# Speeds below this many smallest radii per step are rounding errors. Without gravity this is the
# only limit.
ROUNDING = 1e-12
IMPACT, STRUCK = int(Kind.IMPACT), int(Kind.STRUCK)


class Contacts:
    """The contacts of one space, answered by two callbacks."""

    def __init__(self) -> None:
        self.beads: dict[int, BeadShape] = {}  # by the id of the shape, as the plates
        self.plates: dict[int, PlateShape] = {}
        self.record = Record()
        self.edges = PlateEdges()
        self.time, self.steps = 0.0, 0  # sum and number of the steps so far
        self.resting = 0  # number of contacts too slow for an impact
        self.error: BaseException | None = None  # the first one in this step, or an interrupt
        self.stranger: str | None = None  # says what bead stopped last at a shape not registered
        self._resting_speed = 0.0
        self._anew = 0.0  # contacts that approach more slowly do not rest [m/s]
        self._fall = 0.0, 0.0  # change of the velocity in free fall in this step [m/s]
        self._rubbing: dict[int, Rubbing] = {}  # by row of the record
        self._pressing: list[tuple[Any, PlateShape, float, float]] = []  # contacts with plates in this step
        self.borne: list[float] = []  # integrals over time of what each plate bears, as in `Loads`

    def begin(self, dt: float, gravity: tuple[float, float], reach: float) -> None:
        """Prepare for a step of length dt [s] under gravity [m/s2]; reach: least radius [m]."""
        gx, gy = gravity
        self._fall = gx * dt, gy * dt
        self._rubbing.clear()
        self._pressing.clear()
        self._resting_speed = max(RESTING * math.hypot(gx, gy) * dt, ROUNDING * reach / dt)
        self._anew = -self._resting_speed if gx or gy else math.inf
        self.time += dt
        self.steps += 1

    def end(self) -> None:
        """Complete the impacts of this step whose sliding the engine decided, and what plates bore."""
        for arbiter, plate, x, y in self._pressing:
            n, (jx, jy), body = NUMBERS * plate.index, arbiter.total_impulse, plate.mount.body()
            if not plate.mount.still and body is not None:
                (hub_x, hub_y), (ux, uy) = body.local_to_world(body.center_of_gravity), body.velocity
                x, y = x - hub_x, y - hub_y
                self.borne[n + 6] += ux * jx + uy * jy + body.angular_velocity * (x * jy - y * jx)
            self.borne[n] -= jx
            self.borne[n + 1] -= jy
            self.borne[n + 5] -= x * jy - y * jx
        for row, rubbing in self._rubbing.items():
            self.record.settle(row, abs(rubbing.before), rubbing.outcome())

    # The two callbacks run for every contact in every step, and a pile has many contacts. So
    # attributes are looked up once, and few functions are called.
    def on_plates(self, hooks: list[Hook]) -> Callback:
        """Make the callback for contacts of beads with plates; it calls those of the user first."""
        bead_of, plate_of, record, press = self.beads.get, self.plates.get, self.record.add, self._pressing.append

        def pre_solve(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
            try:
                circle, shape = arbiter.shapes
                bead, plate = bead_of(id(circle)), plate_of(id(shape))
                if bead is None or plate is None:
                    raise unregistered(circle if bead is None else shape)
                if bead.ceded:
                    self._resume(arbiter, bead, plate)
                friction = plate.friction
                if hooks:
                    _call(hooks, arbiter, space, friction is not None)
                if not arbiter.process_collision or circle.sensor or shape.sensor:
                    return
                body: Any = circle.body
                (x, y), (vx, vy) = body.position, body.velocity
                if plate.joints and belongs_to_neighbour(bead, plate, circle, shape, x, y):
                    self._cede(arbiter, bead, plate)
                    return
                nx, ny = arbiter.normal  # from the bead to the plate
                x, y = x + bead.radius * nx, y + bead.radius * ny
                ux, uy = plate.velocity_at(shape, x, y)
                speed = (vx - ux) * nx + (vy - uy) * ny
                if plate.passed(bead, nx, ny, self.steps):
                    raise TunnellingError(bead.index, plate.index, self.time, abs(speed), None)
                press((arbiter, plate, x, y))
                if speed <= self._resting_speed + RESTING * plate.shake:
                    self._rest(arbiter, speed)
                    if friction is not None:
                        arbiter.friction = friction
                    return
                near = curve = None
                if plate.edge is not None:
                    near = self.edges.near(bead, plate, (x, y), speed)
                    curve = near and plate.models.near(bead.kind, plate.thickness, near)
                cor = self._answer(arbiter, bead, plate, circle, shape, speed, curve)
                kind = IMPACT if arbiter.is_first_contact else STRUCK
                spin = body.angular_velocity
                slip = nx * (vy - uy) - ny * (vx - ux) + bead.radius * spin
                after, work = abs(slip), 0.0
                if friction is not None:
                    gain = (1.0 + cor) / (1.0 + plate.curve(bead, shape)(speed)) if near else 1.0
                    slip, after, spin, work = self._slide(arbiter, bead, plate, body, (nx, ny), speed, slip, gain)
                elif arbiter.friction > 0.0:
                    self._rub(arbiter, circle, shape, len(self.record))
                    after = spin = work = math.nan
                if near:
                    self.record.near[len(self.record)] = near
                record(
                    (self.time, bead.index, plate.index, -1, x, y, 0.0, speed, cor, abs(slip), kind, after, spin, work)
                )
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
                (x, y), (vx, vy), (ux, uy) = body.position, body.velocity, other_body.velocity
                speed = (vx - ux) * nx + (vy - uy) * ny
                if speed <= self._resting_speed:
                    self._rest(arbiter, speed)
                    return
                cor = self._answer(arbiter, bead, other, circle, shape, speed)
                kind = IMPACT if arbiter.is_first_contact else STRUCK
                x, y = x + bead.radius * nx, y + bead.radius * ny
                spin = body.angular_velocity
                turning = bead.radius * spin + other.radius * other_body.angular_velocity
                slip = nx * (vy - uy) - ny * (vx - ux) + turning
                after, work = abs(slip), 0.0
                if arbiter.friction > 0.0:
                    self._rub(arbiter, circle, shape, len(self.record))
                    after = spin = work = math.nan
                record(
                    (self.time, bead.index, -1, other.index, x, y, 0.0, speed, cor, abs(slip), kind, after, spin, work)
                )
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
        """Let a contact rest that is too slow for an impact, or separate.

        The contacts of one step add the energy sum(j (1 - e) u) / 2, with their impulses j >= 0
        and speeds u of separation before. An e of 1 where u > 0 makes that no gain, whatever the
        restitution of the others: neighbours may turn a contact round that separates.
        """
        if speed > 0.0:
            arbiter.restitution = 0.0
            self.resting += 1
        else:
            arbiter.restitution = 1.0
        if speed < self._anew:
            _begin_anew(arbiter)

    def _slide(
        self,
        arbiter: pymunk.Arbiter,
        bead: BeadShape,
        plate: PlateShape,
        body: Any,
        normal: tuple[float, float],
        speed: float,
        along: float,
        gain: float,
    ) -> tuple[float, ...]:
        """Let the model answer for friction: sliding speed before and after, spin, and work.

        The engine's solver gives the contact the ``surface_velocity``, as far as its friction can.
        Gravity moves the bead along the plate as in any step. `along` is without a `belt` [m/s].
        Near an edge the normal impulse is `gain` times that far away, and so is the bead's
        tangential motion at sliding speeds that are as much larger.
        """
        (nx, ny), (gx, gy), mount = normal, self._fall, plate.mount
        friction, carried = plate.friction or 0.0, belt(arbiter, nx, ny)
        slip, change = along - carried, 0.0
        if friction:
            try:
                check_moment(body, bead.radius)
                change = gain * (plate.slide(bead)(speed, slip / gain) - slip / gain)
            except Exception as error:
                error.add_note(self._describe(bead, plate, speed))
                raise
        target = along + change
        if not mount.still:
            target += sliding(arbiter) - along  # between the surfaces, which overlap
        if mount.free:  # it falls as the bead does, and a light one limits the impulses
            arbiter.friction = friction
            self._rubbing[len(self.record)] = Rubbing(body, arbiter.shapes, slip, carried, body.mass)
        else:
            arbiter.friction = LOOSE * friction
            target += nx * gy - ny * gx
        arbiter.surface_velocity = -ny * target, nx * target
        after = math.copysign(1.0, slip) * (slip + change)
        spin = body.angular_velocity + (1.0 - 1.0 / POINT) * change / bead.radius
        return slip, after, spin, -change * (slip + 0.5 * change) / POINT

    def _rub(self, arbiter: pymunk.Arbiter, circle: Any, shape: Any, row: int) -> None:
        """Note an impact with the engine's friction, in a row of the record; see `Rubbing`."""
        carried = belt(arbiter, *arbiter.normal)
        before = sliding(arbiter) - carried
        self._rubbing[row] = Rubbing(circle.body, (circle, shape), before, carried, circle.body.mass)

    def meet_stranger(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        """Note a contact with a shape that nobody registered, if pymunk stops the bead there."""
        circle, shape = arbiter.shapes
        bead = self.beads.get(id(circle))
        if bead is not None and not arbiter.restitution:
            left, bottom, right, top = shape.bb
            self.stranger = (
                f"{bead} hits a {type(shape).__name__} between ({left:.4g}, {bottom:.4g}) and "
                f"({right:.4g}, {top:.4g}) m that nobody registered, and stops dead, because its "
                "restitution in pymunk is 0: call add_plate or add_bead with it; or give both "
                "shapes an elasticity; or let beads pass by a pymunk.ShapeFilter or shape.sensor"
            )

    def is_ours(self, arbiter: pymunk.Arbiter) -> bool:
        """Whether both shapes of a contact are registered."""
        keys = [id(shape) for shape in arbiter.shapes]
        return all(key in self.beads or key in self.plates for key in keys)

    def undo(self, arbiter: pymunk.Arbiter) -> None:
        """Remove the impact of a contact that a user's handler has switched off since."""
        if self._is_last(arbiter):
            self.record.undo()
            self._rubbing.pop(len(self.record), None)

    def rub(self, arbiter: pymunk.Arbiter) -> None:
        """Heed the friction that a user's handler has set since the model's answer."""
        one, two = arbiter.shapes
        for shape in one, two:
            plate = self.plates.get(id(shape))
            if plate is not None and plate.friction is not None:
                raise overridden(_types(arbiter), "friction", arbiter.friction)
        if self._is_last(arbiter):
            bead = self.beads.get(id(one))
            first = bead is not None and bead.index == self.record.last()[1]
            self._rub(arbiter, *((one, two) if first else (two, one)), len(self.record) - 1)

    def _is_last(self, arbiter: pymunk.Arbiter) -> bool:
        """Whether the last impact of the record is in this contact."""
        keys = [id(shape) for shape in arbiter.shapes]  # in the order of that handler's types
        beads = [self.beads[key].index for key in keys if key in self.beads]
        plates = [self.plates[key].index for key in keys if key in self.plates]
        bead, other = beads if len(beads) == 2 else (beads[0], -1)
        plate = plates[0] if plates else -1
        either = (self.time, bead, plate, other), (self.time, other, plate, bead)
        return self.record.last() in either

    def _answer(
        self,
        arbiter: pymunk.Arbiter,
        bead: BeadShape,
        other: BeadShape | PlateShape,
        circle: Any,
        shape: Any,
        speed: float,
        curve: CorBySpeed | None = None,
    ) -> float:
        """Ask the model for the restitution, check it, and give it to the engine.

        `curve` is in place of that of the plate far from its edges.
        """
        if circle.radius != bead.radius:
            raise changed(bead, circle)
        try:
            restitution = (curve or other.curve(bead, shape))(speed)
        except Exception as error:
            error.add_note(self._describe(bead, other, speed))
            raise
        if not 0.0 <= restitution <= 1.0:
            where = self._describe(bead, other, speed)
            raise ValueError(f"restitution must lie in [0, 1], the model gave {restitution!r} {where}")
        arbiter.restitution = restitution
        _begin_anew(arbiter)
        return restitution

    def _describe(self, bead: BeadShape, other: BeadShape | PlateShape, speed: float) -> str:
        return f"for {bead} on {other} at {speed:.9g} m/s, t = {self.time:.9g} s"

    def keep(self, error: BaseException, arbiter: pymunk.Arbiter | None = None) -> None:
        """Keep the first error of a step; an interrupt takes precedence over others."""
        if arbiter is not None:
            arbiter.restitution = 0.0
        if self.error is None or not isinstance(error, Exception):
            self.error = error


def _call(hooks: list[Hook], arbiter: pymunk.Arbiter, space: pymunk.Space, answered: bool = False) -> None:
    """Call the user's ``pre_solve``, before the model sets the restitution.

    `answered` says whether the model answers for friction, too, in place of the engine.
    """
    before, friction = arbiter.restitution, arbiter.friction
    for callback, data in hooks:
        callback(arbiter, space, data)
    if arbiter.restitution != before:
        raise overridden(_types(arbiter), "restitution", arbiter.restitution)
    if answered and arbiter.friction != friction:
        raise overridden(_types(arbiter), "friction", arbiter.friction)


def _begin_anew(arbiter: Any) -> None:
    """Let the solver find the impulse of a contact from 0, in this step and in the next.

    It would begin with that of the step before. That suits a contact that rests, but an impact is
    over then, and what is left of its impulse after the last iteration adds energy.
    """
    contact = arbiter._arbiter.contacts[0]  # a circle has no other
    contact.jnAcc = contact.jtAcc = 0.0
    contact.hash += 1  # the impulse goes to a contact of the same hash


def _types(arbiter: pymunk.Arbiter) -> tuple[int, int]:
    one, two = arbiter.shapes
    return one.collision_type, two.collision_type
