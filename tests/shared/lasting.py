"""Parameters with which a test takes long."""

import pytest


def long(*values):
    """Mark parameters of a test for `make test-long`; one that is not long holds a part of what it shows."""
    return pytest.param(*values, marks=pytest.mark.long)
