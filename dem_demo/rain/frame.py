"""One instant of the rain, as an engine shows it to the recorder."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dem_demo.kit.beads import Floats


class Frame(NamedTuple):
    """One instant of every bead: position (N, 2) [m], velocity (N, 2) [m/s] and status (N,).

    In three dimensions also depth (N,) [m], the coordinate that the figures look along; with
    friction also spin (N,) [rad/s], counterclockwise in the figures.
    """

    position: Floats
    velocity: Floats
    status: NDArray[np.uint8]
    depth: Floats | None = None
    spin: Floats | None = None
