"""Default options of the sieve: within the limits of the law, and simulated within ten minutes.

No imports, so that the command line can show these numbers at once.
"""

BEADS = 10_000
RADIUS = (2e-3, 3e-3)  # [m], of either half of the beads; at most 1.5 times the thickness
THICKNESS = 2e-3  # [m]
OPENING = 5e-3  # [m], diameter: the smaller beads pass
SPHERE, PLATE = "gamma-alumina", "aluminium-6061-t6"
SPEED = 1.0  # [m/s], of the feed, downwards
FREQUENCY, AMPLITUDE = 50.0, 1e-3  # [1/s], [m]: an acceleration of 10 g
FRICTION = 0.3
DURATION = 0.06  # [s], three periods
FRAME_RATE = 500.0  # [1/s]
SEED = 1
