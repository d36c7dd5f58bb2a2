"""The attachment of a model to a pymunk space: registered beads and plates, and the steps."""

from __future__ import annotations

import importlib.metadata
import math
import os
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn
from weakref import WeakKeyDictionary, WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from contactlaw._errors import ArgumentError
from contactlaw.engines.needs import knows
from contactlaw.engines.pymunk.contacts import Contacts
from contactlaw.engines.pymunk.edges import join
from contactlaw.engines.pymunk.handlers import Handlers
from contactlaw.engines.pymunk.lookahead import Motion, check
from contactlaw.engines.pymunk.models import Models
from contactlaw.engines.pymunk.registry import (
    MARK,
    BeadKind,
    BeadShape,
    Mount,
    PlateShape,
    check_bead,
    check_mass,
    ends,
    registered,
)
from contactlaw.physical.arguments import scalars, warn_of_metres
from contactlaw.physical.impacts import check_kind
from contactlaw.physical.plates import Foundation, Shell, check_wall, sheet_of
from contactlaw.physical.scaling import swing_of
from contactlaw.record.file import Record
from contactlaw.reporting.files import report
from contactlaw.stepping.loads import NUMBERS, Loads, means

if TYPE_CHECKING:
    import pymunk

    from contactlaw import Material
    from contactlaw.equation.edge import Edge

# The first collision type, far above those that users choose and below 2**32, pymunk's limit on
# 32-bit machines.
_collision_types = count(0xC0A70000)


class PymunkImpacts:
    """The beads, plates and impacts of one space; made by `attach`.

    Attributes
    ----------
    bead_type, plate_type : int
        Collision types of the registered shapes, for handlers of your own:
        ``space.on_collision(impacts.bead_type, my_type, begin=...)``, in any phase. A ``pre_solve``
        for both of them is called after the model has set the restitution.
    """

    def __init__(self, space: pymunk.Space, models: Models) -> None:
        self.bead_type = next(_collision_types)
        self.plate_type = next(_collision_types)
        self._space = space
        self._models = models
        self._contacts = Contacts(models)
        self._asked = 0.0  # time at which loads were asked [s]
        self._attached = True
        # Bodies keep their mounts, and beads their kinds, alive.
        self._mounts: WeakKeyDictionary[pymunk.Body, Mount] = WeakKeyDictionary()
        self._kinds: WeakValueDictionary[tuple[float, int], BeadKind] = WeakValueDictionary()
        self._least = math.inf  # radius of the smallest bead [m]
        self._joined = True  # whether the plates know which ends they share
        self._slop, self._motion = space.collision_slop, Motion(space)
        self._engine_step = space.step
        self._handlers = Handlers(space, self._contacts, self.bead_type, self.plate_type)
        self._own = {"step": self._step, "on_collision": self._handlers.on_collision}
        self._replaced = {name: vars(space).get(name) for name in self._own}
        vars(space).update(self._own)

    @property
    def time(self) -> float:
        """Sum of the steps so far [s]."""
        return self._contacts.time

    @property
    def resting(self) -> int:
        """Number of contacts too slow for an impact, one per contact and step."""
        return self._contacts.resting

    def add_bead(self, circle: pymunk.Circle, *, material: Material | str | None = None) -> int:
        """Register a sphere; its radius is the circle's.

        Parameters
        ----------
        circle : pymunk.Circle
            A circle of collision type 0, centred on a dynamic body of its own. The body's mass
            should be the sphere's, ``4/3 pi radius**3 density`` [kg]; a warning says if it is not.
            Its moment must be ``2/5 mass radius**2`` where the bead meets plates with friction.
        material : Material or str, optional
            Material of spheres in one of the attached models; by default that of the first model.

        Returns
        -------
        int
            Index of the bead in the record, never given to another one.

        Raises
        ------
        TypeError, ValueError, RuntimeError
            If the circle is no such circle, is a part of a rigid body, is registered already, or
            has a radius above 1 m, as in pixels; if no attached model is for the material; after
            `detach`.

        Examples
        --------
        >>> import math
        >>> import pymunk
        >>> import contactlaw as cl
        >>> from contactlaw.engines.pymunk import attach
        >>> space = pymunk.Space()
        >>> materials = [cl.material(name) for name in ("gamma-alumina", "carbon-steel")]
        >>> models = [cl.ImpactModel(cl.Pair(bead, "glass"), law="myc") for bead in materials]
        >>> impacts = attach(space, models)
        >>> plate = pymunk.Segment(space.static_body, (-1, 0), (1, 0), radius=0)
        >>> space.add(plate)
        >>> impacts.add_plate(plate, thickness=1e-3)
        0
        >>> for x, material in enumerate(materials):
        ...     body = pymunk.Body(4 / 3 * math.pi * 0.9e-3**3 * material.density, 1e-12)
        ...     body.position, body.velocity = (0.1 * x, 1e-3), (0, -1)
        ...     bead = pymunk.Circle(body, radius=0.9e-3)
        ...     space.add(body, bead)
        ...     impacts.add_bead(bead, material=material)
        0
        1
        >>> for _ in range(50):
        ...     space.step(1e-5)
        >>> hits = np.sort(impacts.collisions(), order="bead")
        >>> impacts.beads()["material"][hits["bead"]].tolist()
        ['gamma-alumina', 'carbon-steel-1020']
        >>> hits["restitution"].round(2).tolist()
        [0.93, 0.34]
        """
        import pymunk

        body = self._admit(circle, pymunk.Circle)
        radius, number = float(scalars(radius=circle.radius)[0][0]), self._models.find("spheres", material)
        check_bead(circle, body, radius)
        warn_of_metres("radius", radius, stacklevel=2)
        check_mass(body.mass, radius, self._models.spheres[number])
        kind = self._kinds.setdefault((radius, number), BeadKind(radius, number))
        index = self._contacts.record.add_bead(radius, number)
        setattr(circle, MARK, BeadShape(index, kind))
        circle.collision_type = self.bead_type
        self._least = min(self._least, radius)
        self._space.collision_slop = min(self._space.collision_slop, 0.1 * radius)
        return index

    def add_plate(
        self,
        shape: pymunk.Segment | pymunk.Poly,
        thickness: float | Foundation | Shell,
        *,
        material: Material | str | None = None,
        friction: float | None = None,
        edge: Edge | None = None,
    ) -> int:
        """Register a plate; its body may be static, kinematic (a sieve) or dynamic.

        Parameters
        ----------
        shape : pymunk.Segment or pymunk.Poly
            A shape of collision type 0. A polygon or box is solid, and each side is a face of the
            plate. Its size and radius are geometry only. Move it by its body's velocity: the engine
            sees no motion in a position that is set. Where plates on the same body, or on bodies
            that never move, share an end or a corner, a bead hits one of them.
        thickness : float, Foundation or Shell
            Thickness in the model [m]; ``inf`` is the half-space.
        material : Material or str, optional
            Material of plates in one of the attached models; by default that of the first model.
        friction : float, optional
            Coulomb's coefficient between beads and this plate [-]: tangential rebound and spin are
            the model's. By default pymunk's own friction acts, as on other shapes: of rigid bodies,
            with the product of the two shapes' ``friction``, which is 0 unless set.
        edge : {"free", "supported", "clamped"}, optional
            What holds the plate at its edges, the ends of a segment or of a polygon's sides. By
            default the plate has no edges.

        Returns
        -------
        int
            Index of the plate in the record, never given to another one.

        Raises
        ------
        TypeError, ValueError, RuntimeError
            As `add_bead`; also if the shape has no length, the thickness is no positive number, or
            a model without ``oblique`` is asked for friction, or one without ``edge_kernel`` for
            edges.
        """
        import pymunk

        body = self._admit(shape, pymunk.Segment, pymunk.Poly)
        wall, thickness = thickness, float(scalars(thickness=sheet_of(thickness))[0][0])
        warn_of_metres("thickness", thickness, stacklevel=2)
        friction = friction if friction is None else float(scalars(friction=friction)[0][0])
        corners = ends(shape)
        if len(set(corners)) < 2:
            reason = f"has no length, all of it is at {tuple(corners[0])}"
            raise ArgumentError("shape", None, reason)
        number = self._models.find("plates", material)
        models = [one for (_, plate), one in self._models.by_pair.items() if plate == number]
        if edge is not None:
            check_kind(edge)
        bare = sheet_of(wall) is wall
        needed = {"pair": not bare, "oblique": friction is not None, "edge_kernel": edge}
        for one in models:
            check_wall(wall, one, edge)
            if not bare and knows(one, "pair"):
                swing_of(one.pair.plate, wall)  # refuses a stiffness or a radius that cannot be
            for method, is_needed in needed.items():
                if is_needed and not knows(one, method):
                    raise TypeError(f"{one!r} has no {method}, which this thickness, friction or edge takes")
        mount = self._mounts.setdefault(body, Mount())
        mount.extent = max(mount.extent, *((end - body.center_of_gravity).length for end in corners))
        index = self._contacts.record.add_plate(number, wall)
        edge = edge if thickness < math.inf else None  # no wave returns in a half-space
        setattr(shape, MARK, PlateShape(index, shape, mount, thickness if bare else wall, number, friction, edge))
        self._joined = False
        self._contacts.borne.extend([0.0] * NUMBERS)
        shape.collision_type = self.plate_type
        return index

    def remove_bead(self, circle: pymunk.Circle) -> None:
        """Forget a bead: its circle is an ordinary one again, its impacts stay in the record.

        Beads need not be removed to save memory. The attachment does not keep their circles alive,
        and forgets those that are neither in the space nor held by anyone else.

        Parameters
        ----------
        circle : pymunk.Circle
            Circle that `add_bead` was given, else a ValueError; it stays in the space if there.
        """
        self._forget(circle, self.bead_type)

    def remove_plate(self, shape: pymunk.Segment | pymunk.Poly) -> None:
        """Forget a plate, as `remove_bead` forgets a bead.

        Parameters
        ----------
        shape : pymunk.Segment or pymunk.Poly
            Shape that `add_plate` was given, else a ValueError; it stays in the space if there.
        """
        self._forget(shape, self.plate_type)
        self._joined = False

    def beads(self) -> NDArray[np.void]:
        """All beads that were ever registered, by their index in the record.

        Returns
        -------
        structured array
            Columns radius [m] and material, a name, or "" if the model has no pair. In an impact
            record `rows`, the materials of the beads are ``beads()["material"][rows["bead"]]``, and
            those of the plates ``plates()["material"][rows["plate"]]``.
        """
        return self._contacts.record.beads()

    def plates(self) -> NDArray[np.void]:
        """All plates that were ever registered, by their index in the record.

        Returns
        -------
        structured array
            Columns thickness [m] and material, a name, or "" if the model has no pair.
        """
        return self._contacts.record.plates()

    def collisions(self) -> NDArray[np.void]:
        """Every impact so far, one row each, in SI units.

        Returns
        -------
        structured array
            A copy with columns of `contactlaw.engines.record.COLUMNS`, where their units are: time,
            bead, plate, other, x, y, z (0), approach_speed, restitution, sliding_speed and kind (an
            impact, or 3 if the bead was struck while it touched); if every model has a pair and
            ``lookup``, also sliding_speed_after, spin_x and spin_y (0), spin_z, contact_time,
            peak_force, plastic_energy, wave_energy, other_energy, scheme_energy (0),
            friction_energy, wall_work (0, unknown to the engine), radius, mass, parcel (1),
            material, thickness, triangle (-1), wall_start, run, run_start (0) and flags.
            Energies are those of solid spheres, bead on bead of the relative motion. What friction
            took of a bead that has left the space within the step, and how it slides on, is NaN
            where the engine's friction acted.
        """
        return self._contacts.record.read()

    def loads(self) -> Loads:
        """Average what each plate ever registered bore since the last call, or since `attach`.

        The torque is about the centre of gravity of the plate's body, of a static one about the
        origin. Beads at rest count; one that leaves the space in the step of its impact does not.
        An error says that no step was simulated, or that the plates were detached.
        """
        if not self._attached:
            raise RuntimeError("loads: the plates were detached, and bear nothing; ask before detach()")
        sums = np.array(self._contacts.borne).reshape(-1, NUMBERS)
        found = means(sums, self.time - self._asked)
        self._asked, self._contacts.borne[:] = self.time, [0.0] * sums.size
        return found

    def record(self) -> Record:
        """Every impact so far, with the materials and law of each."""
        rows = self.collisions()
        made = {"engine": "pymunk", "version_engine": importlib.metadata.version("pymunk")}
        return Record(rows, *self._contacts.record.bodies(rows), None, made)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the record to a file, see `contactlaw.Record.save`."""
        self.record().save(path)

    def report(self, out: str | os.PathLike[str]) -> Path:
        """Write a page about the impacts so far into a folder, see `contactlaw.report`."""
        return report(self.record(), out)

    def detach(self) -> None:
        """Restore the space as it was at `attach`; the record stays readable. A second call has no effect."""
        state = vars(self._space)
        if not self._attached:
            return
        for name, replaced in self._replaced.items():
            del state[name]
            if replaced:
                state[name] = replaced
        self._handlers.detach()
        for shape, _ in registered(self._space.shapes):
            self._forget(shape, shape.collision_type)
        self._space.collision_slop = self._slop
        self._attached = False

    def __reduce_ex__(self, protocol: Any) -> NoReturn:
        raise TypeError(
            "a space with an impact model cannot be copied or pickled: detach() first, and attach to the copy"
        )

    def _admit(self, shape: Any, *kinds: Any) -> Any:
        """Body of a shape that may be registered."""
        if not self._attached:
            raise RuntimeError("this attachment is detached: call attach(space, model) again")
        if not isinstance(shape, kinds):
            expected = " or ".join(f"pymunk.{kind.__name__}" for kind in kinds)
            raise TypeError(f"expected a {expected}, got {shape!r}")
        if shape.collision_type in (self.bead_type, self.plate_type) and hasattr(shape, MARK):
            raise ValueError(f"{shape!r} is registered already")
        if shape.body is None or shape.sensor:
            raise ValueError(f"{shape!r} has no body, or is a sensor: it would never rebound")
        if shape.collision_type not in (0, self.bead_type, self.plate_type):  # a copied shape has the adapter's type
            remedy = "leave it 0 and make handlers for impacts.bead_type and impacts.plate_type"
            reason = f"the attachment needs its own for {shape!r}; {remedy}"
            raise ArgumentError("collision_type", shape.collision_type, reason)
        return shape.body

    def _forget(self, shape: Any, kind: int) -> None:
        if shape.collision_type != kind:
            raise ValueError(f"{shape!r} is no such bead or plate of this attachment")
        delattr(shape, MARK)
        shape.collision_type = 0

    def _step(self, dt: float) -> None:
        """Replace ``space.step``: check, step, and raise the errors of callbacks."""
        if not 0.0 < dt < math.inf:
            raise ArgumentError("dt", dt, "must be positive and finite [s]")
        check(self._space, self._motion, self._mounts, self._least, dt, self._contacts.time)
        if not self._joined:
            plates = registered(shape for body in self._mounts for shape in body.shapes)
            join(plate for _, plate in plates if isinstance(plate, PlateShape))
            self._joined = True
        self._contacts.begin(dt, self._space.gravity, self._least)
        self._engine_step(dt)
        self._contacts.end()
        error, self._contacts.error = self._contacts.error, None
        if error is not None:
            raise error
