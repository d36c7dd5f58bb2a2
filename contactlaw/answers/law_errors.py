"""Errors of each law beside finite elements that no fit has seen."""

import numpy as np

from contactlaw._arrays import Array, Mask
from contactlaw.laws import Law
from contactlaw.laws.fem import RATIOS
from contactlaw.physical.pair import Pair
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.validity import Validity

# Relative rms errors of COR, contact time and peak force, of 160 everyday impacts: of those inside
# the limits, and of those that are `doubtful`. Errors of a COR below 0.3 are relative to 0.3.
# `python -m validation.inverse model` computes them.
MODEL_ERRORS = {
    "fem": ((0.0044, 0.0057, 0.0066), (0.0169, 0.0184, 0.0140)),
    "hertz": ((0.0317, 0.0143, 0.0154), (0.847, 0.0568, 0.382)),
    "jackson_green": ((0.0208, 0.0176, 0.0241), (0.294, 0.0344, 0.121)),
    "kogut_etsion": ((0.0195, 0.0177, 0.0222), (0.299, 0.0361, 0.135)),
    "myc": ((0.0196, 0.0193, 0.0215), (0.332, 0.136, 0.214)),
    "thornton": ((0.261, 0.140, 0.263), (0.440, 0.637, 0.466)),
}
# The same of law fem for 72 impacts with hardening and rate, without a flag: the targets "metals"
# and "bodies" of `validation.accuracy.acceptance`.
HARDENING_ERRORS = 0.0099, 0.0096, 0.0206
# The same for 11 impacts of bodies softer than those that the law is made of, E*/sigma_Y 2000 to
# 3000, as lead (`validation.fem.bodies`). Their COR is 0.07 to 0.26.
SOFT_ERRORS = 0.0141, 0.0146, 0.0178
# The same for 24 impacts of polymers, the target "polymers". The force is over tan delta: it is too
# high, in proportion to that.
LOSS_ERRORS = 0.0068, 0.0258, 0.45
_LEAST_COR = 0.3
_THIN = 1.4  # R/H from which on relative errors are larger, even where absolute ones of COR are not


def doubtful(hit: Rebound, slenderness: Array) -> Mask:
    """Which rebounds have a flag of accuracy or a plate so thin that errors are larger, by R/H."""
    flagged = (np.asarray(hit.flags) & Validity.ACCURACY) != 0
    return np.asarray(flagged | (slenderness > _THIN))


def law_errors(law: Law, pair: Pair, hit: Rebound, slenderness: Array) -> Array | None:
    """Rms errors of COR, contact time and peak force of flat rebounds, in their units (3, n).

    None for a law whose errors are not known.
    """
    known = MODEL_ERRORS.get(law.family)
    if known is None:
        return None
    inside, beyond = (np.array(rms)[:, None] for rms in known)
    rms = np.where(doubtful(hit, slenderness), beyond, inside)
    hardens = [flow.hardening or flow.rate for flow in (pair.sphere.flow, pair.plate.flow) if flow is not None]
    softest = max(law.parameters.get(f"{role}_ratio", 0.0) for role in ("sphere", "plate"))
    tan_delta = law.parameters.get("loss_factor", 0.0)
    with_losses = *LOSS_ERRORS[:2], LOSS_ERRORS[2] * tan_delta
    for applies, errors in (
        (law.family == "fem" and any(hardens), HARDENING_ERRORS),
        (softest > RATIOS[1], SOFT_ERRORS),
        (tan_delta, with_losses),
    ):
        rms = np.maximum(rms, np.array(errors)[:, None]) if applies else rms
    cor = np.maximum(hit.restitution, _LEAST_COR)
    return np.asarray(rms * np.array([cor, hit.contact_time, hit.peak_force]))
