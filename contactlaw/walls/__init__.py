"""Walls that beads touch: rectangles and meshes, how they move, and where a bead touches them."""

from contactlaw.walls.mesh import Mesh
from contactlaw.walls.motion import Rotation, Tabulated, Translation, Vibration, move
from contactlaw.walls.plate import Plate

__all__ = ["Mesh", "Plate", "Rotation", "Tabulated", "Translation", "Vibration", "move"]
