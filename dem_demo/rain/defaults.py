"""Default options of the rain, whose speeds span the yield speed.

No imports, so that the command line can show these numbers at once.
"""

BEADS = 600
THICKNESSES = (0.5e-3, 0.7e-3, 1e-3, 1.5e-3, 2e-3)  # [m]
RADIUS = (0.5e-3, 0.9e-3)  # [m]; at most 1.8 times the thickness, where the model is known to hold
SPEED = (0.5, 15.0)  # [m/s], downwards; gamma-alumina on glass yields from 7.4 m/s
DURATION = 2.4  # [s]
FRAME_RATE = 200.0  # [1/s]
SEED = 1
TILT = 40.0  # [degrees], of the nozzles of a rain with friction
SPHERE, PLATE = "gamma-alumina", "glass"
