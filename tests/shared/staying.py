"""A pair whose spheres stay where they have hit."""

import contactlaw as cl

# A sphere of 1 kPa strength: its force falls as the 0.8th power of the compression at unloading.
STAYING = cl.Pair(
    cl.Material("stiff", 960e9, 0.164, 52e3, yield_strength=947.0),
    cl.Material("soft", 227e6, 0.0395, 897.0, yield_strength=947.0),
)
