"""The default sieve, our own choice: within the law's limits, and done within ten minutes.

No imports, so that the command line can show these numbers at once.
"""

BEADS = 10_000
RADIUS = (2e-3, 3e-3)  # [m], of one half and of the other; R/H is at most 1.5
THICKNESS = 2e-3  # [m]
OPENING = 5e-3  # [m], diameter: the smaller beads pass
SPHERE, PLATE = "gamma-alumina", "aluminium-6061-t6"
SPEED = 1.0  # [m/s], of the feed, downwards
FREQUENCY, AMPLITUDE = 50.0, 1e-3  # [1/s], [m]: 10 g, a linear screen's 45 degrees
FRICTION = 0.3
DURATION = 0.06  # [s], three periods
FRAME_RATE = 500.0  # [1/s]
SEED = 1
