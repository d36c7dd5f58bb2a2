"""Beads and plates in a pymunk space: every impact gets its own restitution and is recorded.

pymunk resolves a collision within one step, with a restitution that may be set per collision. This
adapter sets it from the impact model and keeps a record; it holds no physics. The registered shapes
carry two collision types of the attachment's own; a ``pre_solve`` callback sets
``arbiter.restitution`` from the normal speed at which the bodies approach at the contact point.

Impacts
    Every approach faster than ``2 |g| dt`` is an impact, also a second one within one overlap. A
    hop from a slower one is over within about a step, and a pile would turn into an endless row of
    them; such a contact rests: restitution 0, never passed to the model, not recorded but counted
    in ``resting``. A shaken plate adds its acceleration to ``|g|``. Separation is no impact, nor
    does a bead or a plate hit anything while it is a ``sensor``.
Beads and plates
    A bead is a circle, a plate a segment or a polygon, whose sides are faces of one plate. Where
    plates share an end or a corner, a bead hits the nearest of them, or of equally near ones the
    first registered: a floor of many pieces is one surface. The attachment keeps no shape alive: it
    forgets those that the space and the user have let go, and `remove_bead` or `remove_plate` the
    others. Their indices in the record are never given again.
Materials
    ``attach(space, [model, ...])`` takes a model for each pair of materials; ``material=`` says
    which bead and plate are of which. `beads` and `plates` tell by index.
Handlers of the user
    Those for `bead_type` and `plate_type`, for any type (``None``), and for any other are called as
    ever. A ``pre_solve`` may change friction or switch a contact off, which then is no impact. The
    restitution is the model's: a handler that sets it is an error.
Time
    The attachment's own clock: the sum of its steps, with the one that resolves the impact.
Errors
    What a callback raises is raised by ``space.step`` after the step: the engine has finished that
    step, with restitution 0 in the contact that failed, and may be stepped on. Tunnelling, and
    numbers that are not finite, are found before the step: the space and the clock are as they
    were. Copying or pickling the space is refused until ``detach``.
Settings
    A step is safe while the largest speed times dt is below the smallest bead radius. Keep 10
    iterations or more where several beads touch. ``collision_slop`` is a length, 0.1 by default:
    above a tenth of a bead's radius it is lowered to that until ``detach``, or else beads stay
    in each other where they came to rest. With a thousand falling beads pymunk's default tree
    takes 0.5 to 6 ms a step, ``space.use_spatial_hash`` (cells of some radii) 0.14 ms.
What pymunk cannot express
    It has two dimensions, and no force history. A bead in a corner hits both plates.
    Beads that jump over each other are not detected. The threshold does not know a gravity that a
    ``velocity_func`` makes, nor the look-ahead a motion that a ``position_func`` makes. Plates that
    overlap, or end in the middle of each other, are hit each for itself.
"""

from contactlaw.engines.pymunk.attachment import attach
from contactlaw.engines.pymunk.impacts import PymunkImpacts
from contactlaw.engines.pymunk.lookahead import TunnellingError

__all__ = ["PymunkImpacts", "TunnellingError", "attach"]
