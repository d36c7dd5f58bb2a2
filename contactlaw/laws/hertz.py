"""Hertz: elastic at every compression (Johnson, Contact Mechanics, 1985, Eq. 4.23)."""

from contactlaw.laws._branches import HERTZ, Loading
from contactlaw.laws._law import Law

LAW = Law.of(
    name="hertz",
    source="Hertz 1882; Johnson, Contact Mechanics (1985), Eq. 4.23",
    yield_coefficient=None,
    loading=[Loading(0.0, HERTZ)],
)
