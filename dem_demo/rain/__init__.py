"""A rain of beads on plates of different thickness: ``dem-demo rain``."""
