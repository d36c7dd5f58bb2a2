"""Parameters with which a test takes long."""

import pytest


def long(*values):
    """Leave a test with these parameters to `make test-long`. The quick ones show a part of the same."""
    return pytest.param(*values, marks=pytest.mark.long)
