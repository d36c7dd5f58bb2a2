"""The contacts of a space: who meets whom, how fast, with what restitution, and what came of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from contactlaw.engines.pymunk.edges import belongs_to_neighbour, near
from contactlaw.engines.pymunk.friction import LOOSE, change_of_sliding, check_moment, sliding
from contactlaw.engines.pymunk.lookahead import TunnellingError
from contactlaw.engines.pymunk.models import Answers, Models
from contactlaw.engines.pymunk.record import FAR, KnownEdge, Record
from contactlaw.engines.pymunk.registry import MARK, BeadShape, PlateShape, Vector, is_static
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


@dataclass(slots=True)
class Contact:
    """A contact of the present step, and what was answered."""

    arbiter: pymunk.Arbiter
    bead: BeadShape
    other: BeadShape | PlateShape
    body: Any  # of the bead
    at: Vector  # where the bead touches [m]
    normal: pymunk.Vec2d  # from the bead to the other
    speed: float  # of approach [m/s]
    slip: float = 0.0  # sliding speed before [m/s]
    cor: float = 0.0
    edge: KnownEdge = FAR  # the one that counts
    kind: Kind | None = None  # None: no impact


class Contacts:
    """The contacts of one space, answered by one callback."""

    def __init__(self, models: Models) -> None:
        self.record = Record(models)
        self.time = 0.0  # sum of the steps so far
        self.resting = 0  # number of contacts too slow for an impact
        self.error: BaseException | None = None  # the first one in this step, or an interrupt
        self.borne: list[float] = []  # integrals over time of what each plate bears, as in `Loads`
        self._models = models
        self._resting_speed = 0.0
        self._anew = 0.0  # contacts that approach more slowly do not rest [m/s]
        self._fall = 0.0, 0.0  # change of the velocity in free fall in this step [m/s]
        # Normals of contacts with plates in the last step and in this one, by bead and plate.
        self._last: dict[tuple[int, int], Vector] = {}
        self._now: dict[tuple[int, int], Vector] = {}
        self._met: list[Contact] = []

    def begin(self, dt: float, gravity: Vector, reach: float) -> None:
        """Prepare for a step of length dt [s] under gravity [m/s2]; reach: least radius [m]."""
        gx, gy = gravity
        self._fall = gx * dt, gy * dt
        self._last, self._now = self._now, {}
        self._met.clear()
        self._resting_speed = max(RESTING * math.hypot(gx, gy) * dt, ROUNDING * reach / dt)
        self._anew = -self._resting_speed if gx or gy else math.inf
        self.time += dt

    # This runs for every contact in every step, and a pile has many contacts.
    def answer(self, arbiter: pymunk.Arbiter) -> None:
        """Answer the contact of a bead with a plate or a bead."""
        contact = None
        circle: Any
        shape: Any
        try:
            circle, shape = arbiter.shapes
            bead, other = getattr(circle, MARK, None), getattr(shape, MARK, None)
            if bead is None or other is None:
                raise ValueError(
                    f"{circle if bead is None else shape!r} has the collision type of this attachment, but was never "
                    "registered (a copy of a bead?): call add_bead or add_plate"
                )
            radius, key = bead.kind.radius, (bead.index, other.index)
            plate = other if isinstance(other, PlateShape) else None
            if plate and self._last.get(key) == CEDED:
                arbiter.process_collision = True  # pymunk would go on to ignore it
            if not arbiter.process_collision or circle.sensor or shape.sensor:
                return
            body = circle.body
            (x, y), (vx, vy) = body.position, body.velocity
            if plate and plate.joints and belongs_to_neighbour(radius, plate, x, y):
                arbiter.process_collision, self._now[key] = False, CEDED
                return
            nx, ny = normal = arbiter.normal  # from the bead to the other
            at = x, y = x + radius * nx, y + radius * ny
            if plate is None:
                (ux, uy), turning = shape.body.velocity, other.kind.radius * shape.body.angular_velocity
                ux, uy = ux + turning * ny, uy - turning * nx
            else:
                ux, uy = (0.0, 0.0) if plate.mount.still else shape.body.velocity_at_world_point(at)
            speed = (vx - ux) * nx + (vy - uy) * ny
            if plate:
                ox, oy = self._last.get(key, CEDED)
                if ox * nx + oy * ny < 0.0:
                    raise TunnellingError(bead.index, plate.index, self.time, abs(speed), None)
                self._now[key] = normal
            contact = Contact(arbiter, bead, other, body, at, normal, speed)
            if speed > self._resting_speed + (RESTING * plate.mount.shake if plate else 0.0):
                contact.kind = Kind.IMPACT if arbiter.is_first_contact else Kind.STRUCK
                contact.slip = nx * (vy - uy) - ny * (vx - ux) + radius * body.angular_velocity
                contact.slip -= normal.cross(arbiter.surface_velocity)
                self._hit(contact)
            else:
                # The contacts of one step add the energy sum(j (1 - e) u) / 2, with their impulses j >= 0 and
                # speeds u of separation before. An e of 1 where u > 0 makes that no gain, whatever the
                # restitution of the others: neighbours may turn a contact round that separates.
                contact.cor = 0.0 if speed > 0.0 else 1.0
                self.resting += speed > 0.0
                if plate and plate.friction is not None:
                    arbiter.friction = plate.friction
            if contact.kind is not None or speed < self._anew:
                begin_anew(arbiter)
            arbiter.restitution = contact.cor
            self._met.append(contact)
        except BaseException as error:
            if contact:
                error.add_note(f"for {bead} on {other} at {contact.speed:.9g} m/s, t = {self.time:.9g} s")
            self.keep(error)
            arbiter.restitution = 0.0

    def _hit(self, contact: Contact) -> None:
        """Find the model's restitution, and give its friction to the engine."""
        kind, other, speed, gain = contact.bead.kind, contact.other, contact.speed, 1.0
        if isinstance(other, BeadShape):
            cor = self._models.sphere_curve(*sorted((one.radius, one.material) for one in (kind, other.kind)))(speed)
        else:
            if other.index not in kind.answers:
                model = self._models.of_pair(kind.material, other.material)
                kind.answers[other.index] = Answers(model, kind.radius, other.wall, other.friction)
            answers = kind.answers[other.index]
            cor = answers.cor(speed)
            if other.edge and (edge := near(other, contact.at))[1] < answers.reach(speed):
                contact.edge, far = edge, cor
                cor = answers.near(speed, *edge)
                gain = (1.0 + cor) / (1.0 + far)
            if other.friction is not None:
                self._slide(contact, other, other.friction, gain)
        if not 0.0 <= cor <= 1.0:
            raise ValueError(f"restitution must lie in [0, 1], the model gave {cor!r}")
        contact.cor = cor

    def _slide(self, contact: Contact, plate: PlateShape, friction: float, gain: float) -> None:
        """Let the model answer for friction.

        The engine's solver gives the contact the ``surface_velocity``, as far as its friction can.
        Gravity moves the bead along the plate as in any step. Near an edge the normal impulse is
        `gain` times that far away, and so is the bead's tangential motion at sliding speeds that
        are as much larger.
        """
        arbiter, kind, slip = contact.arbiter, contact.bead.kind, contact.slip
        target = sliding(arbiter)
        if friction:
            check_moment(contact.body, kind.radius)
            target += gain * (kind.answers[plate.index].slide(contact.speed, slip / gain) - slip / gain)
        arbiter.friction = friction
        if not plate.mount.free:  # else the plate falls as the bead does, and a light one limits the impulses
            arbiter.friction *= LOOSE
            target += contact.normal.cross(self._fall)
        arbiter.surface_velocity = contact.normal.perpendicular() * target

    def end(self) -> None:
        """Record the impacts of this step, and what plates bore."""
        for contact in self._met:
            arbiter = contact.arbiter
            if not arbiter.process_collision:
                continue  # a handler of the user has switched the contact off since
            if arbiter.restitution != contact.cor:
                reason = f"sets arbiter.restitution to {arbiter.restitution!r} where a bead hits, but there the model"
                self.keep(RuntimeError(f"a pre_solve {reason} answers; do not set it"))
                continue
            if isinstance(contact.other, PlateShape):
                self._bear(contact.other, contact.at, arbiter.total_impulse)
            if contact.kind is not None:
                self._record(contact)

    def _bear(self, plate: PlateShape, at: Vector, impulse: pymunk.Vec2d) -> None:
        n, body, turning = NUMBERS * plate.index, plate.shape.body, impulse.cross(at)
        if not is_static(body):
            turning = impulse.cross(at - body.local_to_world(body.center_of_gravity))
            self.borne[n + 6] += impulse.dot(body.velocity) - body.angular_velocity * turning
        self.borne[n] -= impulse.x
        self.borne[n + 1] -= impulse.y
        self.borne[n + 5] += turning

    def _record(self, contact: Contact) -> None:
        arbiter, body, slip, other, change, work = contact.arbiter, contact.body, contact.slip, contact.other, 0.0, 0.0
        if arbiter.friction > 0.0:
            if None in [shape.space for shape in arbiter.shapes]:  # a bead that left the space keeps no impulse
                change = work = math.nan
            else:
                change, impulse = change_of_sliding(arbiter, contact.normal), arbiter.total_impulse
                work = -contact.normal.cross(impulse) * (slip + 0.5 * change) / body.mass
        after = math.copysign(1.0, slip) * (slip + change)
        plate, partner = (-1, other.index) if isinstance(other, BeadShape) else (other.index, -1)
        seen = self.time, contact.bead.index, plate, partner, *contact.at, 0.0, contact.speed, contact.cor, abs(slip)
        self.record.add((*seen, contact.kind, after, body.angular_velocity, work), contact.edge)

    def keep(self, error: BaseException) -> None:
        """Keep the first error of a step; an interrupt takes precedence over others."""
        if self.error is None or not isinstance(error, Exception):
            self.error = error


def begin_anew(arbiter: Any) -> None:
    """Let the solver find the impulse of a contact from 0, in this step and in the next.

    It would begin with that of the step before. That suits a contact that rests, but an impact is
    over then, and what is left of its impulse after the last iteration adds energy. pymunk has no
    public name for the impulse.
    """
    contact = arbiter._arbiter.contacts[0]  # a circle has no other
    contact.jnAcc = contact.jtAcc = 0.0
    contact.hash += 1  # the impulse goes to a contact of the same hash
