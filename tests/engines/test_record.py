"""The record of impacts, without any engine."""

import math
import re
from types import SimpleNamespace

import numpy as np
import pytest
from pymunk_room import Full, R, Stub

import contactlaw as cl
from contactlaw.engines.pymunk import PymunkImpacts
from contactlaw.engines.pymunk.models import Models
from contactlaw.engines.pymunk.record import FAR, Record
from contactlaw.engines.record import COLUMNS, IMPACT


def record_of(models, radii, plates, *impacts):
    """Record of beads, of plates by material and thickness, and of impacts.

    Impacts are given up to their restitution, of a bead that slides at 0.5 m/s, then at 0.25.
    """
    record = Record(Models(models))
    for radius in radii:
        record.add_bead(radius, 0)
    for plate in plates:
        record.add_plate(*plate)
    for observed in impacts:
        record.add((*observed, 0.5, 0, 0.25, 7.0, 0.125), FAR)
    return record


def pair_of(model, plate):
    model.pair = SimpleNamespace(sphere=Full.pair.sphere, plate=plate)
    return model


ONE, TWO = (1.0, 0, 0, -1, 0, 0, 0, 2.0, 0.6), (0.5, 0, 0, -1, 0.1, 0.2, 0.0, 3.0, 0.6)


NAMES = """
    time bead plate other x y z approach_speed restitution sliding_speed kind
    sliding_speed_after spin_x spin_y spin_z contact_time peak_force plastic_energy
    wave_energy other_energy scheme_energy friction_energy wall_work radius mass parcel material
    thickness triangle wall_start run run_start flags
""".split()


def test_every_column_has_a_unit_and_a_description():
    assert [column.name for column in COLUMNS] == list(IMPACT.names) == NAMES
    units = {"1", "s", "m", "kg", "m/s", "rad/s", "N", "J"}
    for column in COLUMNS:
        assert column.unit in units, column
        assert len(column.description) > 10, column
        whole = "bead plate other kind material triangle run flags".split()
        assert IMPACT[column.name] == (np.int64 if column.name in whole else np.float64)


def test_flags_are_explained_bit_by_bit():
    for flag in cl.Validity:
        assert f"{flag.value} {flag.name.lower().replace('_', ' ')}" in COLUMNS[-1].description


def test_the_docstring_of_pymunks_record_names_every_column():
    words = re.findall(r"\w+", PymunkImpacts.collisions.__doc__)
    assert not [column.name for column in COLUMNS if column.name not in words]


def test_record_without_lookup_has_no_derived_columns():
    assert record_of(Stub(), [], []).read().shape == (0,)
    half = pair_of(Stub(), "half")
    half.lookup = Full().lookup
    whole = pair_of(Full(), "whole")
    for models in (Stub(), half, [half, whole], [whole, half]):
        rows = record_of(models, [R], [(0, 1e-3)], TWO).read()
        assert rows.dtype.names[-1] == "kind"
        assert rows[0].tolist() == (*TWO, 0.5, 0)
        assert all(rows.dtype[name] == IMPACT[name] for name in rows.dtype.names)
    assert record_of(whole, [R], [(0, 1e-3)], TWO).read().dtype == IMPACT


def test_record_asks_each_model_for_its_own_rows():
    main, other = pair_of(Full(0.25), "main"), pair_of(Full(0.5), "other")
    main.flags, other.flags = 3, 4
    impacts = (1.0, 1, 0, -1, 0, 0, 0, 2.0, 0.6), (2.0, 0, 1, -1, 0, 0, 0, 3.0, 0.6), (3.0, 0, -1, 1, 0, 0, 0, 4.0, 0.6)
    rows = record_of([main, other], [R, 2 * R], [(0, 1e-3), (1, math.inf)], *impacts).read()
    mass = 4 / 3 * math.pi * R**3 * 1000
    kinetic = 0.5 * mass * np.array([8 * 2.0**2, 3.0**2, 8 / 9 * 4.0**2])
    np.testing.assert_allclose(rows["mass"], [8 * mass, mass, mass], rtol=1e-14)
    assert rows["contact_time"].tolist() == [2 * R, R, R]
    assert rows["peak_force"].tolist() == [1e-3, math.inf, 2 * R]
    assert rows["thickness"].tolist() == [1e-3, math.inf, 0.0]
    np.testing.assert_allclose(rows["plastic_energy"], [0.25, 0.5, 0.25] * kinetic, rtol=1e-14)
    np.testing.assert_allclose(rows["wave_energy"], 0.125 * kinetic, rtol=1e-14)
    np.testing.assert_allclose(rows["other_energy"], 0.0625 * kinetic, rtol=1e-14)
    assert rows["flags"].tolist() == [3, 4, 3]
    assert sorted(main.speeds) == [[2.0], [4.0]] and other.speeds == [[3.0]]


def test_rows_that_were_given_away_are_not_the_record():
    record = record_of(Full(), [R], [(0, 1e-3)], ONE)
    record.read()["bead"] = 7
    assert record.read()["bead"].tolist() == [0]


def test_a_lookup_that_fails_is_asked_again():
    model = Full()
    record = record_of(model, [R], [(0, 1e-3)], ONE)

    def fail(*arguments):
        raise ValueError("outside the table")

    model.lookup = fail
    for _ in range(2):
        with pytest.raises(ValueError, match="outside"):
            record.read()
    del model.lookup
    assert record.read()["contact_time"].tolist() == [R]
