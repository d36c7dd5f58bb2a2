"""A rain of beads on plates of different thickness: what contactlaw gives a particle simulation.

``dem-demo rain`` builds a scene (`scene`), lets an engine run it (`engines`, one file each),
records it (`recorder`), draws it (`figures`) and prints what it measured (`report`). All quantities
are in SI units.
"""
