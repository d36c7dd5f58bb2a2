"""Plates in a LAMMPS simulation: the stateful law inside an engine that integrates the contact."""

from contactlaw.engines.lammps.attachment import LammpsPlates, attach
from contactlaw.engines.lammps.plate import Plate

__all__ = ["LammpsPlates", "Plate", "attach"]
