"""Tables of impacts: solved once, certified, kept on disk, looked up in nanoseconds.

`grid` places the nodes, `build` solves the equation there (`sweep` on all cores), `certificate`
compares lookups with the solver at other points, `file` and `cache` keep tables. `lookup` evaluates
splines of outcomes, `shapes` those of force over time, `slides` those of oblique impacts.
"""

from contactlaw.table.certificate import BOUNDS, Certificate, bounds
from contactlaw.table.grid import Settings
from contactlaw.table.table import Table, build, certify, with_shapes

__all__ = ["BOUNDS", "Certificate", "Settings", "Table", "bounds", "build", "certify", "with_shapes"]
