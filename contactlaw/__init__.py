"""Thickness-dependent restitution of beads on plates for particle simulations.

A sphere loses speed to plastic flow at the contact and to the bending wave that runs away in the
plate; the modified Zener model (Peng et al. 2021) has both. All quantities are in SI units.

Examples
--------
>>> import contactlaw as cl
>>> model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
>>> model.restitution(speed=5.0, radius=0.9e-3, thickness=[0.5e-3, 1e-3, 3e-3]).round(3)
array([0.666, 0.897, 0.983])
"""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contactlaw._version import VERSION as __version__

if TYPE_CHECKING:
    from contactlaw import export
    from contactlaw._errors import ArgumentError
    from contactlaw.answers.beads import restitution_sphere_sphere
    from contactlaw.answers.loads import LoadSignal, load_signal
    from contactlaw.answers.sensitivity import Sensitivity
    from contactlaw.answers.uncertainty import Uncertainty
    from contactlaw.comparison import Comparison, compare
    from contactlaw.fitting.fit import Fit, fit
    from contactlaw.fitting.identify import UnidentifiedError
    from contactlaw.fitting.measurements import Measurements
    from contactlaw.model import ImpactModel
    from contactlaw.physical.history import ForceHistory
    from contactlaw.physical.materials import Material, material, materials, read_materials
    from contactlaw.physical.measured import measured_law
    from contactlaw.physical.pair import Pair
    from contactlaw.physical.plates import Foundation, Layers, Orthotropic, Shell
    from contactlaw.physical.rebound import Rebound
    from contactlaw.physical.validity import Validity, edge_distance, explain
    from contactlaw.record.file import Bodies, Record, read_record
    from contactlaw.reporting.files import report
    from contactlaw.sensor import PlateSignal, plate_signal
    from contactlaw.spectrum import Spectrum

__all__ = [
    "ArgumentError",
    "Bodies",
    "Comparison",
    "Fit",
    "ForceHistory",
    "Foundation",
    "ImpactModel",
    "Layers",
    "LoadSignal",
    "Material",
    "Measurements",
    "Orthotropic",
    "Pair",
    "PlateSignal",
    "Rebound",
    "Record",
    "Sensitivity",
    "Shell",
    "Spectrum",
    "Uncertainty",
    "UnidentifiedError",
    "Validity",
    "__version__",
    "compare",
    "edge_distance",
    "explain",
    "export",
    "fit",
    "load_signal",
    "material",
    "materials",
    "measured_law",
    "plate_signal",
    "read_materials",
    "read_record",
    "report",
    "restitution_sphere_sphere",
]

# What type checkers read above says where each public name is defined, a module a line.
_LINES = Path(__file__).read_text("utf-8").splitlines()
_IMPORTS = [line.split(maxsplit=3) for line in _LINES if line.startswith("    from contactlaw")]
_MODULE_OF = {name: home for _, home, _, names in _IMPORTS for name in names.split(", ")}


if not TYPE_CHECKING:  # type checkers would accept any name

    def __getattr__(name: str) -> Any:
        """Import a public name, or a module of the package, when it is first used (PEP 562).

        A program that uses a part of the package starts faster, and the command line can decide,
        before the first kernel is defined, whether kernels are compiled.
        """
        home = _MODULE_OF.get(name, __name__)
        if home != __name__:
            globals()[name] = value = getattr(importlib.import_module(home), name)
            return value
        try:
            return importlib.import_module(f"{__name__}.{name}")
        except ModuleNotFoundError as error:
            if error.name != f"{__name__}.{name}":
                raise
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}") from None


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
