"""The record of impacts, without any engine."""

import math

import numpy as np
from scene import Full, R, Stub

from contactlaw.engines.pymunk.record import Record


def test_record_without_lookup_has_no_derived_columns():
    record = Record()
    assert record.read(Stub(), [], []).shape == (0,)
    record.add((0.5, 0, 0, -1, 0.1, 0.2, 3.0, 0.6))
    half = Stub()
    half.lookup = Full().lookup
    for main, own in ((Stub(), Full()), (Full(), Stub()), (half, Full())):
        rows = record.read(main, [R], [(own, 1e-3)])
        assert rows.dtype.names[-1] == "restitution"
        assert rows[0].tolist() == (0.5, 0, 0, -1, 0.1, 0.2, 3.0, 0.6)
    assert record.read(Full(), [R], [(Full(), 1e-3)]).dtype.names[-1] == "wave_energy"


def test_record_asks_each_model_for_its_own_rows():
    main, other = Full(0.25), Full(0.5)
    record = Record()
    record.add((1.0, 1, 0, -1, 0, 0, 2.0, 0.6))
    record.add((2.0, 0, 1, -1, 0, 0, 3.0, 0.6))
    record.add((3.0, 0, -1, 1, 0, 0, 4.0, 0.6))
    rows = record.read(main, [R, 2 * R], [(main, 1e-3), (other, math.inf)])
    mass = 4 / 3 * math.pi * R**3 * 1000
    kinetic = 0.5 * mass * np.array([8 * 2.0**2, 3.0**2, 8 / 9 * 4.0**2])
    assert rows["contact_time"].tolist() == [2 * R, R, R]
    assert rows["peak_force"].tolist() == [1e-3, math.inf, 2 * R]
    np.testing.assert_allclose(rows["plastic_energy"], [0.25, 0.5, 0.25] * kinetic, rtol=1e-14)
    np.testing.assert_allclose(rows["wave_energy"], 0.125 * kinetic, rtol=1e-14)
    assert (main.speeds, other.speeds) == ([[2.0], [4.0]], [[3.0]])
