"""Walls that beads touch: flat, round and meshes, how they move, and where a bead touches them."""

from contactlaw.walls.mesh import Mesh
from contactlaw.walls.motion import Rotation, Tabulated, Translation, Vibration, move
from contactlaw.walls.plate import Plate
from contactlaw.walls.round import Cone, Cylinder, Disc, Ring, Sphere

__all__ = ["Cone", "Cylinder", "Disc", "Mesh", "Plate", "Ring", "Rotation", "Sphere"]
__all__ += ["Tabulated", "Translation", "Vibration", "move"]
