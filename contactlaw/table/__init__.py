"""Tables of impacts, without units: swept once, certified, kept on disk, looked up in nanoseconds.

`grid` places the nodes along `axes`, `nodes` holds the solutions there (`sweep` computes them on
all cores), `certificate` compares lookups with the solver at other points, `file` and `cache` keep
tables. `splines` fits what `lookup` and `shapes` evaluate: outcomes, and force over time.
"""

from contactlaw.table.certificate import BOUNDS, Certificate, bounds
from contactlaw.table.grid import Settings
from contactlaw.table.nodes import Table, build, certify, with_shapes

__all__ = ["BOUNDS", "Certificate", "Settings", "Table", "bounds", "build", "certify", "with_shapes"]
