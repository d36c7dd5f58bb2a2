"""Beads and plates in a pymunk space: every impact gets its own restitution and is recorded.

pymunk resolves a collision within one step, with a restitution that may be set per collision. This
adapter sets it from the impact model and keeps a record; it holds no physics. The registered shapes
carry two collision types of the attachment's own; a ``pre_solve`` callback sets
``arbiter.restitution`` from the normal speed at which the bodies approach at the contact point.

Impacts
    Every approach faster than ``2 |g| dt`` is an impact, also a second one within one overlap. A
    hop from a slower one is over within about a step, and a pile would turn into an endless row of
    them; such a contact rests: restitution 0, never passed to the model, not recorded but counted
    in ``resting``. A shaken plate adds its acceleration to ``|g|``. Separation is no impact.
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
    It has two dimensions, and no force history. A bead that touches two plates at once hits both.
    Beads that jump over each other are not detected. The threshold does not know a gravity that a
    ``velocity_func`` makes, nor the look-ahead a motion that a ``position_func`` makes. Handlers of
    the user for any type (``None``) run after the adapter's and can override its restitution.
"""

from contactlaw.engines.pymunk.impacts import PymunkImpacts, attach
from contactlaw.engines.pymunk.lookahead import TunnellingError

__all__ = ["PymunkImpacts", "TunnellingError", "attach"]
