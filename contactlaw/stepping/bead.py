"""Contacts of a bead with walls in one time step: which go on, which end and which begin."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from contactlaw._arrays import Rows
from contactlaw._errors import ArgumentError
from contactlaw._jit import kernel, tuple_of
from contactlaw.physical.vectors import dot, norm, plus, vector
from contactlaw.record.file import Record, Surface, bodies_of, flagged
from contactlaw.stepping.contact import (
    ALONE,
    AT_REST,
    CONTACT,
    SHARING,
    STATUS,
    UNEVEN,
    Bead,
    Clock,
    Contact,
    WallScene,
    apply_contact,
    clear_contact,
    contact_of,
    report_trouble,
)
from contactlaw.stepping.friction import FRICTION, check_friction
from contactlaw.stepping.loads import LOAD
from contactlaw.stepping.plate_rows import plate_rows
from contactlaw.stepping.softened import DEEPEST_OVERLAP, check_softening
from contactlaw.stepping.trouble import Trouble, explain
from contactlaw.walls.facet import Touch, nearest, touch_in_space
from contactlaw.walls.frame import Wall, framed
from contactlaw.walls.plate import Models, by_type, check_models
from contactlaw.walls.rest import at_rest
from contactlaw.walls.surface import OVERLAP, ROOM, group_surfaces, on_listed_facet, overlaps, pass_gradient, touch_of

# Most contacts of a bead at once: three in a corner; in a hole one for each edge.
MOST_CONTACTS = 8
# Two forces count as perpendicular if the cosine of their angle is at most this.
_PERPENDICULAR = 1e-6


class WallContacts:
    """Contacts of beads with walls, for a time-stepping loop of your own.

    `contactlaw.walls.move` puts moving walls in place: call it with ``scene.frames``, the time and
    the step before the first step, and then in each step before `interact`. A scene is for one
    thread, because all beads share its scratch memory.

    Parameters
    ----------
    walls : sequence or dict of Plate, Mesh, Cylinder, Cone, Sphere, Disc and Ring
        Walls of `contactlaw.walls` that the beads may hit; a dict has them by name, for records.
    models : ImpactModel or dict of int to ImpactModel
        Materials and law, one model for all beads or one for each type of beads, from 1; None for
        beads that fly through the walls. A wall may have models of its own.
    largest : float
        Radius of the largest bead [m].
    impacts : structured array
        Rows for the record of impacts, with the columns of `contactlaw.engines.record.IMPACT`.
    friction : float, optional
        Coulomb's coefficient of friction between beads and walls [-].
    types : int, optional
        Number of types of beads.
    softening, parcel : float, optional
        As in `contactlaw.engines.lammps.attach`: divisor of the modulus of the contacts, and radius
        of the beads over that of the true ones for which they stand.

    Attributes
    ----------
    scene : WallScene
        Argument of the kernel `interact`, valid as long as this object lives.
    places : int
        Most contacts that a bead may have at once.

    Raises
    ------
    TypeError, ValueError
        If the friction is no finite number of 0 or more, or `models` has a type beyond `types`.
    """

    def __init__(
        self,
        walls: Sequence[Wall] | Mapping[str, Wall],
        models: Models,
        largest: float,
        impacts: Rows,
        *,
        friction: float = 0.0,
        types: int = 1,
        softening: float = 1.0,
        parcel: float = 1.0,
    ) -> None:
        check_friction(friction)
        check_softening(softening, parcel)
        check_models(models)
        self.names = [*walls] if isinstance(walls, Mapping) else [getattr(wall, "name", "") for wall in walls]
        walls = [*walls.values()] if isinstance(walls, Mapping) else walls
        kinds = sorted(set().union(*(by_type(one, types) for one in (models, *(wall.model for wall in walls)))))
        if kinds and not 1 <= kinds[0] <= kinds[-1] <= types:
            raise ArgumentError("models", None, f"the types of beads are 1 to {types}, got {kinds}")
        own = by_type(models, types)
        rows, numbers, self._held = plate_rows(walls, own, types)
        self._models = [{**own, **by_type(wall.model, types)} for wall in walls]
        facets, frames, self._framed = framed(walls, numbers, largest)
        self.places = min(len(facets), MOST_CONTACTS)
        self._warned = 0.0  # the deepest overlap of which a warning told [r]
        self.scene = WallScene(
            rows,
            frames,
            facets,
            np.zeros(ROOM, OVERLAP),
            impacts,
            np.zeros(1, STATUS),
            np.zeros(len(walls), LOAD),
            *map(float, (friction, softening, parcel)),
        )

    def collisions(self) -> Rows:
        """Impacts that have ended, one row each.

        Raises
        ------
        RuntimeError
            If a step met a `Trouble`; the message says on which wall, and what to do.
        """
        status = self.scene.status[0]
        if status["trouble"]:
            raise RuntimeError(explain(*(status[name] for name in ("trouble", "wall", "value", "limit"))))
        self.warn_of_overlap(3)
        hits: Rows = self.scene.impacts[: status["impacts"]]
        return hits

    def warn_of_overlap(self, stacklevel: int = 2) -> None:
        """Warn of an impact for which the contacts are too soft; again if one is twice as deep."""
        soft, status = self.scene.softening, self.scene.status[0]
        if status["overlap"] > max(1.01 * DEEPEST_OVERLAP, 2.0 * self._warned):
            self._warned, most = status["overlap"], soft * (DEEPEST_OVERLAP / status["overlap"]) ** 2.5
            warnings.warn(
                f"softening: an impact at {status['speed']:.3g} m/s had an overlap of {status['overlap']:.1%} of the "
                f"radius with a softening of {soft:g}; for overlaps below {DEEPEST_OVERLAP:.0%} take "
                + (f"at most {most:.3g}" if most > 1.0 else "none"),
                stacklevel=stacklevel,
            )

    def record(self, rows: Rows | None = None, **made: Any) -> Record:
        """Record of impacts, with the materials, law and places of each.

        Parameters
        ----------
        rows : structured array, optional
            Impacts on these walls; by default `collisions`.
        **made
            What else the record shall say, such as the engine; texts and numbers.
        """
        rows = self.collisions() if rows is None else rows
        keys = np.stack([rows["plate"], rows["material"]], axis=1)
        known, which = np.unique(keys, axis=0, return_inverse=True)
        found = [bodies_of(self._models[plate][kind + 1]) for plate, kind in known.tolist()]
        bodies = [one for n, one in enumerate(found) if one not in found[:n]]
        number = np.array([bodies.index(one) for one in found], dtype=np.int64)
        surface = Surface(*at_rest(self.scene.facets, self.scene.frames, rows), self.names)
        made = {name: getattr(self.scene, name) for name in ("friction", "softening", "parcel")} | made
        return flagged(Record(rows.copy(), bodies, number[which.ravel()], surface, made))

    def memory(self, beads: int) -> tuple[Rows, Rows]:
        """Empty rows of CONTACT and of FRICTION for a number of beads, shape (beads, n) each."""
        sliding = self.places if self.scene.friction > 0.0 else 0
        return np.zeros((beads, self.places), CONTACT), np.zeros((beads, sliding), FRICTION)


@kernel
def touches(bead: Bead) -> bool:
    """Whether a bead has a contact."""
    for k in range(len(bead.contacts)):
        if bead.contacts[k].facet != 0.0:
            return True
    return False


@kernel
def _facet_of(row: Any) -> int:
    """Facet's number, or -1 if the row is empty."""
    return int(abs(row.facet)) - 1


@kernel
def _row_of(bead: Bead, facet: int) -> int:
    """Row of the contact with a facet, or an empty one for facet -1; -1 if there is none."""
    for k in range(len(bead.contacts)):
        if abs(bead.contacts[k].facet) == facet + 1:
            return k
    return -1


@kernel
def _index_in_list(found: Any, count: int, facet: int) -> int:
    """Position of a facet in the list of those that a bead overlaps, else -1."""
    for n in range(count):
        if found[n].facet == facet:
            return n
    return -1


@kernel
def _contact_with(scene: WallScene, bead: Bead, body: Any, n: int, touching: bool) -> Contact:
    """Contact with facet n of the list, without the force that it shares with another one.

    Hertz's force is proportional to the overlap to the power 1.5, so the shared part is
    (x_pass/x)^1.5, with the pass of `contactlaw.walls.surface`. Other laws take the same share.
    """
    found = scene.found
    row = found[n]
    along = (row.nx, row.ny, row.nz)
    if row.shared > 0.0:
        share = row.shared / row.x
        share *= math.sqrt(share)
        less = pass_gradient(scene.frames, scene.facets, bead.x, bead.r, found[row.one], found[row.other])
        along = plus(along, -share, less)
    return contact_of(scene, bead, body, row.facet, touch_of(row), along, touching, -1)


@kernel
def _continuing_facet(scene: WallScene, bead: Bead, row: Any, count: int, path: float) -> int:
    """Position in the list of the facet on which a contact goes on, else -1.

    A facet that is suddenly far away was left across a periodic boundary. The contact then goes on
    where the overlap differs the least and by no more than `path`; if there is no such facet: -2.
    """
    found, facet = scene.found, _facet_of(row)
    at = _index_in_list(found, count, facet)
    if at >= 0:
        return int(found[at].representative)
    one = scene.facets[facet]
    touch = touch_in_space(scene.frames[one.frame], one, bead.x, bead.r)
    if touch.x > -bead.r:
        point = nearest(touch, bead.x, bead.r)
        for n in range(count):
            if on_listed_facet(scene.frames, scene.facets, found[n], point, bead.r):
                return int(found[n].representative)
        return -1
    best = -2
    for n in range(count):
        apart = abs(found[n].x - row.overlap)
        if found[n].representative == n and apart <= path:
            best, path = n, apart
    return best


@kernel
def _move_contacts(scene: WallScene, clock: Clock, bead: Bead, count: int) -> None:
    """Move the contacts of a bead to the facets that it has crossed to."""
    found = scene.found
    path = norm(bead.v) * clock.dt + AT_REST * bead.r  # at most, with the overlap of one put down at rest
    for k in range(len(bead.contacts)):
        row = bead.contacts[k]
        if row.facet == 0.0:
            continue
        next_facet = _continuing_facet(scene, bead, row, count, path)
        if next_facet == -2:
            clear_contact(bead, k)
        elif next_facet >= 0 and _row_of(bead, found[next_facet].facet) < 0:
            row.facet = math.copysign(found[next_facet].facet + 1.0, found[next_facet].s)


@kernel
def _end_contact(scene: WallScene, clock: Clock, bead: Bead, body: Any, k: int, count: int) -> None:
    """End a contact whose facet the bead has left, or whose surface has another contact now."""
    facet = _facet_of(bead.contacts[k])
    one, n, merged_into = scene.facets[facet], _index_in_list(scene.found, count, facet), -1
    if n >= 0:
        merged_into = _row_of(bead, scene.found[scene.found[n].representative].facet)
        merged_into = -1 if merged_into == k else merged_into
    if merged_into >= 0:
        bead.contacts[merged_into].disturbance = SHARING
    t = touch_in_space(scene.frames[one.frame], one, bead.x, bead.r)
    if t.x > -bead.r:  # else something has moved the bead far away between two steps
        t = tuple_of(Touch, t, x=min(t.x, 0.0))
        contact = contact_of(scene, bead, body, facet, t, (t.nx, t.ny, t.nz), True, merged_into)
        apply_contact(scene, clock, bead, body, contact, k)
    else:
        clear_contact(bead, k)


@kernel
def _deepest_new(found: Any, count: int, bead: Bead) -> int:
    """Position in the list of the deepest facet that has no contact yet, else -1."""
    new = -1
    for n in range(count):
        row = found[n]
        if row.representative == n and (new < 0 or row.x > found[new].x) and _row_of(bead, row.facet) < 0:
            new = n
    return new


@kernel
def _begin_all(scene: WallScene, clock: Clock, bead: Bead, body: Any, count: int, touching: bool) -> None:
    """Begin contacts, the deepest first; if no row is empty, a shallower contact is replaced.

    The two overlaps are nearly equal when one replaces the other, so the force does not jump.
    """
    found = scene.found
    for _ in range(count):
        new = _deepest_new(found, count, bead)
        if new < 0:
            return
        at = _row_of(bead, -1)
        if at < 0:
            least = math.inf
            for k in range(len(bead.contacts)):
                n = _index_in_list(found, count, _facet_of(bead.contacts[k]))
                x = found[n].x if n >= 0 else 0.0  # 0: this contact has ended in this step
                if x < least:
                    least, at = x, k
            if not found[new].x > least:
                scene.status[0].left_out += 1
                return
            _end_contact(scene, clock, bead, body, at, count)
            clear_contact(bead, at)
        apply_contact(scene, clock, bead, body, _contact_with(scene, bead, body, new, touching), at)
        if found[new].shared > 0.0:
            bead.contacts[at].disturbance = SHARING


@kernel
def _disturbance_of(bead: Bead) -> float:
    """UNEVEN if two contacts press the bead and are not at right angles, else ALONE.

    The energy account of a contact assumes that no other force acts along its normal.
    """
    for k in range(len(bead.contacts)):
        one = bead.contacts[k]
        if not one.force > 0.0:
            continue
        for j in range(k):
            other = bead.contacts[j]
            cosine = dot(vector(one.push), vector(other.push))
            if other.force > 0.0 and abs(cosine) > _PERPENDICULAR * one.force * other.force:
                return UNEVEN
    return ALONE


# Inlined, because a call would write its arguments, some 70 numbers, to memory for each bead.
@kernel(inline=True)
def apply_walls(scene: WallScene, clock: Clock, bead: Bead, body: Any) -> None:
    """Do as `interact`, for kernels: numba counts the users of arrays in those that Python may call."""
    if not 0 <= bead.kind < len(scene.plate_rows):
        report_trouble(scene, Trouble.NO_MODEL, -1, bead.kind + 1.0, 0.0)
        return
    found = scene.found
    count = overlaps(scene.frames, scene.facets, bead.x, bead.r, found, scene.plate_rows[bead.kind])
    if count == 0 and not touches(bead):
        return
    sharing = group_surfaces(bead.r, found, count)
    if clock.advancing:
        _move_contacts(scene, clock, bead, count)
    touching, disturbance, kept = touches(bead), ALONE, 0
    if count > 1:  # most beads have one contact: they need no search, which is slow in memory
        disturbance = SHARING if sharing else _disturbance_of(bead)
    for k in range(len(bead.contacts)):
        row = bead.contacts[k]
        if row.facet == 0.0:
            continue
        n = _index_in_list(found, count, _facet_of(row))
        if n >= 0 and found[n].representative == n:
            row.disturbance = max(row.disturbance, disturbance)
            apply_contact(scene, clock, bead, body, _contact_with(scene, bead, body, n, touching), k)
            kept += 1
        elif clock.advancing or row.extra_force != 0.0:
            _end_contact(scene, clock, bead, body, k, count)
    if clock.advancing and kept < count:
        _begin_all(scene, clock, bead, body, count, touching)


@kernel(cache=True, inline=True)
def interact(scene: WallScene, clock: Clock, bead: Bead, body: Rows | None = None) -> None:
    """Add the walls' force [N] and torque [N m] to a bead's; errors go to ``scene.status``.

    Of a bead that is a part of a rigid body, `body` is a row of `contactlaw.stepping.rigid.BODY`.
    """
    apply_walls(scene, clock, bead, body)
