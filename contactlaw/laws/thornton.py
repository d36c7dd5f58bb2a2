"""Thornton: linear plastic loading at a constant contact pressure; unloading of a flattened sphere.

Thornton, J. Appl. Mech. 64 (1997) 383. Beyond yield the pressure over the contact is cut off at
p_y, so the force rises by pi p_y R* per compression, which is Hertz's slope at yield. Unloading is
Hertz's with the radius R_p of the flattened sphere, chosen so that the contact area at the largest
compression is that of Hertz, a^2 = R* d: R_p/R* = dm^1.5/fm.

d_Y = pi^2 p_y^2 R*/(4 E*^2); p_y = sigma_Y in Peng et al. 2021 and here, so that the coefficient is
0.25. (Von Mises' criterion puts it at p_y = 1.6 sigma_Y: a yield compression of 0.64.)

Legend: d compression, dm the largest so far, dr what remains of it, all in units of d_Y; forces in
units of F_Y; g = sqrt(dm).
"""

import numpy as np
from numpy.polynomial import Polynomial

from contactlaw.laws._branches import HERTZ, Array, Loading, Unloading
from contactlaw.laws._law import Law


def _residual(dm: Array) -> Array:
    """Return dm - fm/g = (g - 1)^2 (g + 1/2)/g over (dm - 1)^2; fm/g is Hertz's span with R_p."""
    g = np.sqrt(dm)
    return (g + 0.5) / (g * (g + 1.0) ** 2)


def _loss(dm: Array) -> Array:
    """0.75 dm^2 - 0.5 dm + 0.15 - 0.4 fm^2/g over (dm - 1)^2."""
    g = np.sqrt(dm)
    return (((0.75 * g + 0.6) * g - 0.05) * g - 0.1) / (g * (g + 1.0) ** 2)


LAW = Law.of(
    name="thornton",
    source="Thornton, J. Appl. Mech. 64 (1997) 383; p_y = sigma_Y as in Peng et al. 2021",
    yield_coefficient=0.25,
    # F_Y + pi p_y R* (d - d_Y), scaled
    loading=[Loading(0.0, HERTZ), Loading(1.0, Polynomial([-0.5, 0.0, 1.5]))],
    unloading=[Unloading(1.0, _residual, loss=_loss, order=2.0, loss_order=2.0)],
)
