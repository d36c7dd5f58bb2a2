"""Tables of impacts, without units: swept once, certified, kept on disk, looked up in nanoseconds.

`grid` places the nodes along `axes`, `nodes` holds what the solver says there (`sweep` asks it on
all cores), `certificate` compares with it at other places, `file` writes and reads, `cache` keeps.
`splines` fits what `lookup` and `shapes` evaluate: outcomes of impacts, and force over time.
"""

from contactlaw.table.certificate import BOUNDS, Certificate, bounds
from contactlaw.table.grid import Settings
from contactlaw.table.nodes import Table, build, certify, with_shapes

__all__ = [
    "BOUNDS",
    "Certificate",
    "Settings",
    "Table",
    "bounds",
    "build",
    "certify",
    "with_shapes",
]
