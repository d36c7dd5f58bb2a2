"""What the formulas of the pages beside it are computed with."""
