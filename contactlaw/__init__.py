"""Thickness-dependent restitution of beads on plates for particle simulations.

The coefficient of restitution of a sphere that hits a plate falls with plastic flow at the contact
and with the bending wave that runs away in the plate. The modified Zener model (Peng, Jin, Liu,
Wei, Int. J. Solids Struct. 222-223 (2021) 111036) has both; this package answers from a table of
its solutions. All quantities are in SI units.

>>> import contactlaw as cl
>>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
>>> model.restitution(speed=5.0, radius=0.9e-3, thickness=[0.5e-3, 1e-3, 3e-3]).round(3)
array([0.666, 0.897, 0.983])
"""

from contactlaw import export
from contactlaw._version import VERSION as __version__
from contactlaw.answers.beads import restitution_sphere_sphere
from contactlaw.answers.loads import LoadSignal, load_signal
from contactlaw.answers.sensitivity import Sensitivity
from contactlaw.fitting import Fit, Measurements, UnidentifiedError, fit
from contactlaw.model import ImpactModel
from contactlaw.physical.history import ForceHistory
from contactlaw.physical.materials import Material, material, materials
from contactlaw.physical.measured import measured_law
from contactlaw.physical.pair import Pair
from contactlaw.physical.rebound import Rebound
from contactlaw.physical.validity import Validity, edge_distance, explain

__all__ = [
    "Fit",
    "ForceHistory",
    "ImpactModel",
    "LoadSignal",
    "Material",
    "Measurements",
    "Pair",
    "Rebound",
    "Sensitivity",
    "UnidentifiedError",
    "Validity",
    "__version__",
    "edge_distance",
    "explain",
    "export",
    "fit",
    "load_signal",
    "material",
    "materials",
    "measured_law",
    "restitution_sphere_sphere",
]
