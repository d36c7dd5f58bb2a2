"""The contacts of a space: who meets whom, how fast, with what restitution, and what came of it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from contactlaw.engines.pymunk.edges import belongs_to_neighbour, near
from contactlaw.engines.pymunk.friction import LOOSE, belt, check_moment, pushed, sliding
from contactlaw.engines.pymunk.handlers import Hook
from contactlaw.engines.pymunk.lookahead import TunnellingError
from contactlaw.engines.pymunk.record import FAR, KnownEdge, Record
from contactlaw.engines.pymunk.registry import MARK, BeadShape, PlateShape, Vector, unregistered
from contactlaw.engines.record import Kind
from contactlaw.stepping.loads import NUMBERS

if TYPE_CHECKING:
    import pymunk

# An approach slower than this many times the speed that gravity gives in one step is at rest.
# Otherwise a pile of 120 beads with restitution 0.9 never settles (5000 impacts a bead and second).
RESTING = 2.0
# Speeds below this many smallest radii per step are rounding errors. Without gravity this is the
# only limit.
ROUNDING = 1e-12
CEDED = 0.0, 0.0  # in place of the normal of a contact that belongs to a neighbour of the plate


class Impact(NamedTuple):
    """An impact of the present step, up to its friction."""

    bead: BeadShape
    other: BeadShape | PlateShape
    body: Any  # of the bead
    at: Vector  # where the bead touches [m]
    normal: Vector  # from the bead to the other
    speed: float  # of approach [m/s]
    kind: Kind
    slip: float  # sliding speed before [m/s]


class Contacts:
    """The contacts of one space, answered by one callback."""

    def __init__(self) -> None:
        self.record = Record()
        self.time = 0.0  # sum of the steps so far
        self.resting = 0  # number of contacts too slow for an impact
        self.error: BaseException | None = None  # the first one in this step, or an interrupt
        self.stranger = ""  # says what bead stopped first at a shape not registered
        self.borne: list[float] = []  # integrals over time of what each plate bears, as in `Loads`
        self._resting_speed = 0.0
        self._anew = 0.0  # contacts that approach more slowly do not rest [m/s]
        self._fall = 0.0, 0.0  # change of the velocity in free fall in this step [m/s]
        # Normals of contacts with plates in the last step and in this one, by bead and plate.
        self._last: dict[tuple[int, int], Vector] = {}
        self._now: dict[tuple[int, int], Vector] = {}
        # Of this step: the contact, its plate, point and restitution, and its impact and edge if it does not rest.
        self._met: list[tuple[Any, PlateShape | None, Vector, float, Impact | None, KnownEdge]] = []

    def begin(self, dt: float, gravity: tuple[float, float], reach: float) -> None:
        """Prepare for a step of length dt [s] under gravity [m/s2]; reach: least radius [m]."""
        gx, gy = gravity
        self._fall = gx * dt, gy * dt
        self._last, self._now = self._now, {}
        self._met.clear()
        self._resting_speed = max(RESTING * math.hypot(gx, gy) * dt, ROUNDING * reach / dt)
        self._anew = -self._resting_speed if gx or gy else math.inf
        self.time += dt

    # This callback runs for every contact in every step, and a pile has many contacts.
    def pre_solve(self, arbiter: pymunk.Arbiter, space: pymunk.Space, hooks: list[Hook]) -> None:
        """Answer the contact of a bead with a plate or a bead, after the user's own handler."""
        impact = None
        try:
            circle, shape = arbiter.shapes
            bead, other = getattr(circle, MARK, None), getattr(shape, MARK, None)
            if bead is None or other is None:
                raise unregistered(circle if bead is None else shape)
            radius, key = bead.kind.radius, (bead.index, other.index)
            plate = other if isinstance(other, PlateShape) else None
            if plate and self._last.get(key) == CEDED:
                arbiter.process_collision = True  # pymunk would go on to ignore it
            for callback, data in hooks:
                before = arbiter.restitution
                callback(arbiter, space, data)
                check_restitution(arbiter, before)
            if not arbiter.process_collision or circle.sensor or shape.sensor:
                return
            body: Any = circle.body
            (x, y), (vx, vy) = body.position, body.velocity
            if plate and plate.joints and belongs_to_neighbour(radius, plate, circle, shape, x, y):
                arbiter.process_collision, self._now[key] = False, CEDED
                return
            nx, ny = normal = arbiter.normal  # from the bead to the other
            at = x, y = x + radius * nx, y + radius * ny
            ux, uy = other.velocity_at(shape, at, normal)
            speed = (vx - ux) * nx + (vy - uy) * ny
            if plate:
                ox, oy = self._last.get(key, CEDED)
                if ox * nx + oy * ny < 0.0:
                    raise TunnellingError(bead.index, plate.index, self.time, abs(speed), None)
                self._now[key] = normal
            if speed <= self._resting_speed + RESTING * other.shake:
                cor, edge = self._rest(arbiter, speed), FAR
                if plate and plate.friction is not None:
                    arbiter.friction = plate.friction
            else:
                bead.check(circle)
                if plate is None:
                    other.check(shape)
                kind = Kind.IMPACT if arbiter.is_first_contact else Kind.STRUCK
                slip = nx * (vy - uy) - ny * (vx - ux) + radius * body.angular_velocity
                slip -= belt(arbiter, normal)
                impact = Impact(bead, other, body, at, normal, speed, kind, slip)
                cor, edge = self._answer(arbiter, impact)
            self._met.append((arbiter, plate, at, cor, impact, edge))
        except BaseException as error:
            if impact:
                error.add_note(f"for {impact.bead} on {impact.other} at {impact.speed:.9g} m/s, t = {self.time:.9g} s")
            self.keep(error)
            arbiter.restitution = 0.0

    def _rest(self, arbiter: pymunk.Arbiter, speed: float) -> float:
        """Let a contact rest that is too slow for an impact, or separate.

        The contacts of one step add the energy sum(j (1 - e) u) / 2, with their impulses j >= 0
        and speeds u of separation before. An e of 1 where u > 0 makes that no gain, whatever the
        restitution of the others: neighbours may turn a contact round that separates.
        """
        cor = arbiter.restitution = 0.0 if speed > 0.0 else 1.0
        self.resting += speed > 0.0
        if speed < self._anew:
            begin_anew(arbiter)
        return cor

    def _answer(self, arbiter: pymunk.Arbiter, impact: Impact) -> tuple[float, KnownEdge]:
        """Give the model's restitution and friction to the engine; return the former and the edge that counts."""
        bead, other, speed, edge, gain = impact.bead, impact.other, impact.speed, FAR, 1.0
        cor = other.curve(bead)(speed)
        if isinstance(other, PlateShape):
            answers = other.answers(bead)
            if other.edge is not None and (found := near(other, impact.at))[1] < answers.reach(speed):
                edge, far = found, cor
                cor = answers.near(speed, *edge)
                gain = (1.0 + cor) / (1.0 + far)
        if not 0.0 <= cor <= 1.0:
            raise ValueError(f"restitution must lie in [0, 1], the model gave {cor!r}")
        if isinstance(other, PlateShape) and other.friction is not None:
            self._slide(arbiter, impact, other, gain)
        arbiter.restitution = cor
        begin_anew(arbiter)
        return cor, edge

    def _slide(self, arbiter: pymunk.Arbiter, impact: Impact, plate: PlateShape, gain: float) -> None:
        """Let the model answer for friction.

        The engine's solver gives the contact the ``surface_velocity``, as far as its friction can.
        Gravity moves the bead along the plate as in any step. Near an edge the normal impulse is
        `gain` times that far away, and so is the bead's tangential motion at sliding speeds that
        are as much larger.
        """
        (nx, ny), slip, friction = impact.normal, impact.slip, plate.friction or 0.0
        target = sliding(arbiter)
        if friction:
            check_moment(impact.body, impact.bead.kind.radius)
            target += gain * (plate.answers(impact.bead).slide(impact.speed, slip / gain) - slip / gain)
        arbiter.friction = friction
        if not plate.mount.free:  # else the plate falls as the bead does, and a light one limits the impulses
            arbiter.friction *= LOOSE
            target += nx * self._fall[1] - ny * self._fall[0]
        arbiter.surface_velocity = -ny * target, nx * target

    def end(self) -> None:
        """Record the impacts of this step, and what plates bore."""
        for arbiter, plate, at, cor, impact, edge in self._met:
            if not arbiter.process_collision:
                continue  # a handler of the user has switched the contact off since
            try:
                check_restitution(arbiter, cor)
            except RuntimeError as error:
                self.keep(error)
                continue
            impulse = arbiter.total_impulse  # on the bead
            if plate:
                self._bear(plate, at, impulse)
            if impact:
                self._record(arbiter, impact, cor, impulse, edge)

    def _bear(self, plate: PlateShape, at: Vector, impulse: Vector) -> None:
        n, (x, y), (jx, jy), body = NUMBERS * plate.index, at, impulse, plate.mount.body()
        if not plate.mount.static and body is not None:
            (hub_x, hub_y), (ux, uy) = body.local_to_world(body.center_of_gravity), body.velocity
            x, y = x - hub_x, y - hub_y
            self.borne[n + 6] += ux * jx + uy * jy + body.angular_velocity * (x * jy - y * jx)
        self.borne[n] -= jx
        self.borne[n + 1] -= jy
        self.borne[n + 5] -= x * jy - y * jx

    def _record(self, arbiter: pymunk.Arbiter, impact: Impact, cor: float, impulse: Vector, edge: KnownEdge) -> None:
        bead, other, body, at, (nx, ny), speed, kind, slip = impact
        change = work = 0.0
        if arbiter.friction > 0.0:
            if None in [shape.space for shape in arbiter.shapes]:  # the impulse of what has left the space is lost
                change = work = math.nan
            else:
                (touch,) = arbiter.contact_point_set.points
                for pushed_body, place in zip(arbiter.bodies, (touch.point_a, touch.point_b), strict=True):
                    jx, jy = pushed(pushed_body, place, impulse)
                    change += nx * jy - ny * jx
                work = -(nx * impulse[1] - ny * impulse[0]) * (slip + 0.5 * change) / body.mass
        after = math.copysign(1.0, slip) * (slip + change)
        plate, partner = (-1, other.index) if isinstance(other, BeadShape) else (other.index, -1)
        seen = self.time, bead.index, plate, partner, *at, 0.0, speed, cor, abs(slip), kind
        self.record.add((*seen, after, body.angular_velocity, work), edge)

    def meet_stranger(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        """Note a contact with a shape that nobody registered, if pymunk stops the bead there."""
        circle, shape = arbiter.shapes
        bead = getattr(circle, MARK, None)
        if bead is not None and not arbiter.restitution and not self.stranger:
            left, bottom, right, top = shape.bb
            self.stranger = (
                f"{bead} hits a {type(shape).__name__} between ({left:.4g}, {bottom:.4g}) and "
                f"({right:.4g}, {top:.4g}) m that nobody registered, and stops dead, because its "
                "restitution in pymunk is 0: call add_plate or add_bead with it; or give both "
                "shapes an elasticity; or let beads pass by a pymunk.ShapeFilter or shape.sensor"
            )

    def keep(self, error: BaseException) -> None:
        """Keep the first error of a step; an interrupt takes precedence over others."""
        if self.error is None or not isinstance(error, Exception):
            self.error = error


def check_restitution(arbiter: pymunk.Arbiter, answer: float) -> None:
    """Refuse the restitution that a user's handler has set in place of an answer."""
    if arbiter.restitution != answer:
        raise RuntimeError(
            f"a pre_solve sets arbiter.restitution to {arbiter.restitution!r} where a bead hits, but there the model "
            "answers; do not set it, and give a plate that differs a model of its own: add_plate(..., model=...), any "
            "object with curve()"
        )


def begin_anew(arbiter: Any) -> None:
    """Let the solver find the impulse of a contact from 0, in this step and in the next.

    It would begin with that of the step before. That suits a contact that rests, but an impact is
    over then, and what is left of its impulse after the last iteration adds energy. pymunk has no
    public name for the impulse.
    """
    contact = arbiter._arbiter.contacts[0]  # a circle has no other
    contact.jnAcc = contact.jtAcc = 0.0
    contact.hash += 1  # the impulse goes to a contact of the same hash
