"""Gravity, and the numbers that stand for the status of a bead."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

GRAVITY = 9.80665  # [m/s2], standard gravity
WAITING, FLYING, GONE = 0, 1, 2  # a bead's status in a frame
