"""Default options of the drum, chosen so that it is simulated within a minute.

No imports, so that the command line can show these numbers at once.
"""

BEADS = 100
RADIUS = (1.4e-3, 2.1e-3)  # [m]; at most 1.4 times the thickness
THICKNESS = 1.5e-3  # [m]
DRUM, LENGTH = 0.04, 0.04  # [m], radius and length of the drum
SPHERE, PLATE = "soda-lime-glass", "stainless-steel-304"
SPEED = 0.5  # [m/s], at which the beads are thrown down
TURNS = 2.0  # [1/s]; from 2.5 on beads would cling to the shell
FRICTION, DURATION = 0.5, 0.25  # [-]; [s], half a turn
FRAME_RATE = 200.0  # [1/s]
SEED = 1
