"""Beads in a drum of thin sheet that turns: ``dem-demo drum``."""
