"""Beads in a turning drum of thin sheet metal: ``dem-demo drum``."""
