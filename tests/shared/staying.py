"""A law whose spheres stay where they have hit."""

import contactlaw as cl
from contactlaw.laws import fem
from contactlaw.physical.law import pair_numbers

# A sphere of 1 kPa strength: its force falls as the 0.8th power of the compression at unloading.
STAYING = cl.Pair(
    cl.Material("stiff", 960e9, 0.164, 52e3, yield_strength=947.0),
    cl.Material("soft", 227e6, 0.0395, 897.0, yield_strength=947.0),
)


def staying_law():
    """Law fem of this pair, without the loss that stiff spheres keep: the hardest case known.

    With that loss contact times rise more slowly where spheres come to stay.
    """
    given = fem.Given(**pair_numbers(STAYING, "fem"))
    return fem.law_of(given, {**fem.fitted(), "stiffest": 1.0})
