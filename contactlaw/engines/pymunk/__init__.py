"""Beads and plates in a pymunk space: every impact gets its own restitution and is recorded.

pymunk resolves a collision within one step, with a restitution that may be set per collision. This
adapter sets it from the impact model and records the impact; the physics is in the model. The
registered shapes get two collision types of the attachment's own; a ``pre_solve`` callback sets
``arbiter.restitution`` from the normal speed at which the bodies approach at the contact point.

Impacts
    Every approach faster than ``2 |g| dt`` is an impact, also a second one within one overlap. A
    bead that hits more slowly is back within about a step, and a pile would give an endless series
    of such hops; their contacts rest: restitution 0, never passed to the model, not recorded but
    counted in ``resting``. A shaken plate adds its acceleration to ``|g|``. Separation is no
    impact, nor is a contact of a ``sensor``. Where beads touch, a contact that
    separates while its neighbours hit has a restitution of 1, as less could add energy.
Beads and plates
    A bead is a circle, a plate a segment or a polygon, whose sides are faces of one plate. Where
    plates share an end or a corner, a bead hits the nearest of them, or of equally near ones the
    first registered: a floor of many pieces is one surface, where the pieces have the same filter.
    The attachment keeps no shape alive. `remove_bead` and `remove_plate` make registered shapes
    ordinary ones: call `remove_plate` also for a plate that leaves others for good, `remove_bead`
    before ``unsafe_set_radius``. An index in the record is never given again.
Friction and edges
    docs/pymunk.md describes ``friction=`` and ``edge=``. Friction near an edge is that far away,
    scaled with the normal impulse: within 0.06 of friction times speed at R/H = 0.9, 0.19 at
    R/H = 1.8.
Materials
    ``attach(space, [model, ...])`` takes a model for each pair of materials; ``material=`` gives
    the material of a bead or a plate. `beads` and `plates` list the materials by index.
Handlers of the user
    Handlers for `bead_type` and `plate_type`, for any type (``None``) and for other types are
    called as before; phases are keywords. A ``pre_solve`` is called after the model's answer. It
    may change the engine's friction, or switch a contact off so that it is no impact. The
    restitution is the model's: a handler that sets it is an error. On a
    plate with ``friction=`` the friction is the model's, too: leave ``arbiter.friction`` alone
    there. Contacts of two plates are the user's.
Strangers
    A bead that hits a shape nobody registered stops dead unless both have an elasticity or a
    handler sets a restitution.
Time
    The time in the record is the sum of all steps since `attach`, including that of the impact.
Errors
    ``space.step`` raises an error of a callback after the step: the engine has finished that step,
    with restitution 0 in the contact that failed, and may be stepped on. That holds for handlers
    that were set after `attach`. pymunk prints the errors of earlier ones. It also prints a Ctrl-C
    that comes while it prepares a callback, and goes on: press it again. Tunnelling and numbers
    that are not finite are found before the step, and the space and the clock are unchanged.
    Copying or pickling the space is refused until ``detach``.
Settings
    A step is safe while the largest speed times dt is below the smallest bead radius. In longer
    steps the adapter looks for plates on the path of each fast bead, and refuses the step where it
    finds one. Keep 10 iterations or more where several beads touch. ``collision_slop`` is a length,
    0.1 by default: a value above a tenth of a bead's radius is lowered to that until ``detach``,
    because beads that come to rest stay in each other by that length. With a thousand falling beads
    pymunk's default tree takes 0.5 to 6 ms a step, ``space.use_spatial_hash`` (cells of some radii)
    0.14 ms.
What pymunk cannot express
    The simulation is two-dimensional and has no force history. A circle of a rigid body with other
    shapes is no bead. A bead in a corner hits both plates, and each row of the record is about one
    of them. A step's gravity has no part in a rebound.
    Beads that jump over each other are not detected. Gravity by a ``velocity_func`` does not count
    in the speed of resting contacts, nor motion by a ``position_func`` in the search for
    tunnelling. Plates that overlap, or meet elsewhere than at their ends, are hit separately.
"""

from contactlaw.engines.pymunk.attachment import attach
from contactlaw.engines.pymunk.impacts import PymunkImpacts
from contactlaw.engines.pymunk.lookahead import TunnellingError

__all__ = ["PymunkImpacts", "TunnellingError", "attach"]
