"""Impacts at given overloads, by the package's own solver."""

from contactlaw.equation import outcome, zener


def solved_at(law, lam, chi, rtol):
    """Outcome of impacts at inelasticities and overloads."""
    found = outcome.at(lam, zener.elastic_compression(law.data, lam) / chi)
    assert zener.solve_all(law.data, rtol, found) == (zener.OK, 0)
    return found
