"""Force over time of single contacts, in SI units."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlaw import lookup, shapes, zener
from contactlaw.impact import Scales
from contactlaw.laws import Law
from contactlaw.table import Table

Array = NDArray[np.float64]


class ForceHistory(NamedTuple):
    """Contacts at even times from first touch to separation.

    Arrays of one shape: that of the arguments by broadcasting, and the samples along a last axis.

    Attributes
    ----------
    time
        Since first touch [s].
    force
        Contact force [N]; 0 at either end.
    compression
        Relative compression of the bodies [m]; at the end the residual one.
    impulse
        Integral of the force since first touch [N s]; at the end m V0 (1 + e). It is exact where a
        rule over the samples is not: above lambda = 3 the force has a long tail behind its peak.
    plate_displacement
        Displacement of the plate at the contact point [m]: its mobility times the impulse. An
        infinite plate does not come back; a real one does when the bending wave returns.
    """

    time: Array
    force: Array
    compression: Array
    impulse: Array
    plate_displacement: Array


def tabulated(law: Law, table: Table, fields: Array, samples: int, rtol: float) -> Array:
    """Histories (4, n, samples) on Hertz's scale for fields (7, n); integrated where off the table.

    See `contactlaw.shapes.sample`.
    """
    lam, chi = fields[5], fields[4] / fields[6]
    # a clamped impact lies on the border, give or take a rounding error
    inside = (lam <= lookup.lam_max(table.packed) * (1 + 1e-9)) & (
        chi <= lookup.chi_max(table.packed) * (1 + 1e-9)
    )
    out = np.empty((4, lam.size, samples))
    if inside.all():
        shapes.sample(law.functions, table.packed_shapes, fields, out)
        return out
    part = np.empty((4, np.count_nonzero(inside), samples))
    shapes.sample(law.functions, table.packed_shapes, fields[:, inside], part)
    out[:, inside] = part
    out[:, ~inside] = solved(law, fields[:, ~inside], samples, rtol)
    return out


def solved(law: Law, fields: Array, samples: int, rtol: float) -> Array:
    """Histories (4, n, samples) on Hertz's scale for fields (7, n), by integration."""
    out = np.empty((4, fields.shape[1], samples))
    zener.histories(law.functions, fields[1], fields[5], fields[6], rtol, out)
    return out


def with_units(
    histories: Array, units: Scales, mobility: Array, shape: tuple[int, ...] | None
) -> ForceHistory:
    """Give histories (4, n, samples) their units and the shape of the answer."""
    momentum = units.force * units.time
    histories *= np.stack((units.time, units.force, units.compression, momentum))[..., None]
    displacement = mobility[:, None] * histories[3]
    whole = (*(shape or ()), histories.shape[2])
    return ForceHistory(*(values.reshape(whole) for values in (*histories, displacement)))
