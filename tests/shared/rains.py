"""A short record of beads that rain on two plates."""

import math

import numpy as np

import contactlaw as cl
from contactlaw.engines.record import IMPACT


def write_rain(path, pair):
    """Write three impacts on plates and one of bead on bead, as engines save them."""
    rows = np.zeros(4, IMPACT)
    rows["time"] = np.arange(4)
    rows["radius"] = [0.9e-3, 1.1e-3, 1e-3, 1e-3]
    rows["mass"] = 4 / 3 * math.pi * pair.sphere.density * rows["radius"] ** 3
    rows["approach_speed"], rows["plate"] = [1.0, 2.0, 0.5, 3.0], [0, 1, -1, 0]
    rows["other"] = [-1, -1, 0, -1]
    rows["thickness"] = [0.5e-3, math.inf, 0.0, 0.5e-3]
    beads = cl.Bodies(cl.Pair(pair.sphere, pair.sphere), "hertz")
    cl.Record(rows, [cl.Bodies(pair, "hertz"), beads], np.array([0, 0, 1, 0])).save(path)
