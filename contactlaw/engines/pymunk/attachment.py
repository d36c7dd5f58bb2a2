"""Attach a model to a pymunk space."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from contactlaw.engines.needs import RestitutionModel
from contactlaw.engines.pymunk.impacts import PymunkImpacts
from contactlaw.engines.pymunk.models import Models

if TYPE_CHECKING:
    import pymunk


def attach(space: pymunk.Space, model: RestitutionModel | Sequence[RestitutionModel]) -> PymunkImpacts:
    """Let a model decide how the beads of a pymunk space rebound.

    Parameters
    ----------
    space : pymunk.Space
        A space in metres and seconds. The adapter replaces its ``step`` and ``on_collision`` until
        `PymunkImpacts.detach`; use them as before.
    model : RestitutionModel, or list of them
        An `ImpactModel`, or any object with ``curve(radius, thickness)``, which gives a function of
        speed; where beads meet, also with ``sphere_sphere_curve(radius, other_radius)``. With a
        model without a ``pair`` and ``lookup``, the record has no contact times,
        forces, energies and flags. For beads or plates of several materials, a list with one model
        for each pair that meets; beads and plates without a material have those of the first.

    Returns
    -------
    PymunkImpacts
        Attachment with which beads and plates are registered; then step the space as before.

    Raises
    ------
    ImportError, TypeError, ValueError, RuntimeError
        If pymunk is missing; the space or a model is of another type; two models are for one pair
        of materials, or one of several has no pair; the space has a model attached already.

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
    >>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"), law="myc")
    >>> impacts = attach(space, model)
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
    models = Models(model)
    if isinstance(getattr(vars(space).get("step"), "__self__", None), PymunkImpacts):
        raise RuntimeError("space: a model is attached already; detach() that attachment first")
    return PymunkImpacts(space, models)
