"""Shared set-up; numba must find a fresh cache folder before anything imports it."""

import os
import tempfile

# A stale cache would let an old result pass; and the tests must not write into a user's folders.
_CACHE = tempfile.TemporaryDirectory(prefix="contactlaw-numba-")
os.environ["NUMBA_CACHE_DIR"] = _CACHE.name

import pytest  # noqa: E402

import contactlaw as cl  # noqa: E402


@pytest.fixture(scope="session")
def pair():
    """The paper's pair, Table 1."""
    return cl.Pair("gamma-alumina", "glass")


@pytest.fixture(scope="session")
def model(pair):
    return cl.ImpactModel(pair, law="myc")
