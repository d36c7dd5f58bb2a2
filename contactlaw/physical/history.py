"""Force over time of single contacts, in SI units."""

from typing import NamedTuple

from contactlaw._arrays import Array, Integers
from contactlaw.equation.numbers import Numbers
from contactlaw.equation.outcome import History
from contactlaw.physical.validity import Validity


class _Samples(NamedTuple):
    time: Array
    force: Array
    compression: Array
    impulse: Array
    plate_displacement: Array


class ForceHistory(_Samples):
    """Contacts at even times from first touch to separation.

    Arrays of one shape: the broadcast shape of the arguments, and the samples along a last axis.

    Attributes
    ----------
    time
        Since first touch [s].
    force
        Contact force [N]; 0 at either end.
    compression
        Relative compression of the bodies [m]; at the end the residual one.
    impulse
        Integral of the force since first touch [N s]; at the end m V0 (1 + e). It is exact, unlike
        a sum over the samples: above lambda = 3 the force has a long tail behind its peak.
    plate_displacement
        Displacement of the plate at the contact point [m]: its mobility times the impulse, with the
        mobility that the law has for this impact. An endless plate does not come back; one with an
        edge does when the bending wave returns.
    flags
        `Validity` limits that an impact exceeds, as in `Rebound`; no member of the tuple, since
        they have no samples.
    """

    flags: Validity | Integers


def with_units(
    contacts: History, units: Numbers, inelasticity: Array, shape: tuple[int, ...] | None, path: Array | None = None
) -> ForceHistory:
    """Give contacts (n, samples) their units and the shape of the answer.

    The inelasticity is that of the contacts, which at a table's border is not the impact's. Near
    edges the displacement of the plate is given on Hertz's scale, by `path`.
    """
    scales = units.time, units.force, units.compression, units.force * units.time
    time, force, compression, impulse = (
        values * scale[:, None] for values, scale in zip(contacts, scales, strict=True)
    )
    whole = (*(shape or ()), time.shape[1])
    if path is None:  # the mobility that the equation had is lambda T_H/m
        displacement = (inelasticity * units.compression)[:, None] * contacts.impulse
    else:
        displacement = path * units.compression[:, None]
    return ForceHistory(*(values.reshape(whole) for values in (time, force, compression, impulse, displacement)))
