"""The inverse problem: strengths, moduli, densities and sizes from measured rebounds."""

from contactlaw.fitting.fit import Fit, fit
from contactlaw.fitting.identify import UnidentifiedError
from contactlaw.fitting.measurements import Measurements

__all__ = ["Fit", "Measurements", "UnidentifiedError", "fit"]
