"""The record of impacts, without any engine."""

import math
import re

import numpy as np
import pytest
from pymunk_room import Full, R, Stub

import contactlaw as cl
from contactlaw.engines.pymunk import PymunkImpacts
from contactlaw.engines.pymunk.models import Models
from contactlaw.engines.pymunk.record import Record, Register
from contactlaw.engines.record import COLUMNS, IMPACT


def register_of(model, radii, plates):
    """Beads and plates by index, as if they had been registered."""
    register = Register(Models(model))
    for radius in radii:
        register.bead(0, radius)
    for own, thickness in plates:
        register.plate(register.models.own_models(own), thickness)
    return register


def add(record, *observed):
    """Add an impact, up to its restitution, of a bead that slides at 0.5 m/s, then at 0.25."""
    record.add((*observed, 0.5, 0, 0.25, 7.0, 0.125))


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
    assert Record().read(register_of(Stub(), [], [])).shape == (0,)
    half = Stub()
    half.lookup = Full().lookup
    for main, own in ((Stub(), Full()), (Full(), Stub()), (half, Full())):
        record = Record()
        add(record, 0.5, 0, 0, -1, 0.1, 0.2, 0.0, 3.0, 0.6)
        rows = record.read(register_of(main, [R], [(own, 1e-3)]))
        assert rows.dtype.names[-1] == "kind"
        assert rows[0].tolist() == (0.5, 0, 0, -1, 0.1, 0.2, 0.0, 3.0, 0.6, 0.5, 0)
        assert all(rows.dtype[name] == IMPACT[name] for name in rows.dtype.names)
    record = Record()
    add(record, 0.5, 0, 0, -1, 0.1, 0.2, 0.0, 3.0, 0.6)
    rows = record.read(register_of(Full(), [R], [(Full(), 1e-3)]))
    assert rows.dtype.names[-3:] == ("run", "run_start", "flags")
    assert rows.dtype == IMPACT


def test_record_asks_each_model_for_its_own_rows():
    main, other = Full(0.25), Full(0.5)
    main.flags, other.flags = 3, 4
    record = Record()
    add(record, 1.0, 1, 0, -1, 0, 0, 0, 2.0, 0.6)
    add(record, 2.0, 0, 1, -1, 0, 0, 0, 3.0, 0.6)
    add(record, 3.0, 0, -1, 1, 0, 0, 0, 4.0, 0.6)
    rows = record.read(register_of(main, [R, 2 * R], [(main, 1e-3), (other, math.inf)]))
    mass = 4 / 3 * math.pi * R**3 * 1000
    kinetic = 0.5 * mass * np.array([8 * 2.0**2, 3.0**2, 8 / 9 * 4.0**2])
    assert rows["contact_time"].tolist() == [2 * R, R, R]
    assert rows["peak_force"].tolist() == [1e-3, math.inf, 2 * R]
    np.testing.assert_allclose(rows["plastic_energy"], [0.25, 0.5, 0.25] * kinetic, rtol=1e-14)
    np.testing.assert_allclose(rows["wave_energy"], 0.125 * kinetic, rtol=1e-14)
    np.testing.assert_allclose(rows["other_energy"], 0.0625 * kinetic, rtol=1e-14)
    assert rows["flags"].tolist() == [3, 4, 3]
    assert (main.speeds, other.speeds) == ([[2.0], [4.0]], [[3.0]])


def test_rows_that_were_given_away_are_not_the_record():
    model, record = Full(), Record()
    add(record, 1.0, 0, 0, -1, 0, 0, 0, 2.0, 0.6)
    record.read(register_of(model, [R], [(model, 1e-3)]))["bead"] = 7
    assert record.read(register_of(model, [R], [(model, 1e-3)]))["bead"].tolist() == [0]


def test_a_lookup_that_fails_is_asked_again():
    model, record = Full(), Record()
    add(record, 1.0, 0, 0, -1, 0, 0, 0, 2.0, 0.6)

    def fail(*arguments):
        raise ValueError("outside the table")

    model.lookup = fail
    for _ in range(2):
        with pytest.raises(ValueError, match="outside"):
            record.read(register_of(model, [R], [(model, 1e-3)]))
    del model.lookup
    assert record.read(register_of(model, [R], [(model, 1e-3)]))["contact_time"].tolist() == [R]


def test_a_plate_without_lookup_that_comes_later_takes_the_columns_away():
    model, record = Full(), Record()
    add(record, 1.0, 0, 0, -1, 0, 0, 0, 2.0, 0.6)
    assert record.read(register_of(model, [R], [(model, 1e-3)])).dtype == IMPACT
    plates = [(model, 1e-3), (Stub(), 1e-3)]
    add(record, 2.0, 0, 1, -1, 0, 0, 0, 3.0, 0.6)
    rows = record.read(register_of(model, [R], plates))
    assert rows.dtype.names[-1] == "kind"
    assert rows["approach_speed"].tolist() == [2.0, 3.0]
