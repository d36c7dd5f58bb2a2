"""The columns of the record of impacts, which all engines have in common."""

import re

import numpy as np

import contactlaw as cl
from contactlaw.engines.pymunk import PymunkImpacts
from contactlaw.engines.record import COLUMNS, IMPACT

NAMES = """
    time bead plate other x y z approach_speed restitution sliding_speed kind
    sliding_speed_after spin_x spin_y spin_z contact_time peak_force plastic_energy
    wave_energy other_energy scheme_energy friction_energy wall_work radius mass parcel material
    thickness triangle wall_start run run_start flags
""".split()


def test_every_column_has_a_unit_and_a_description():
    assert [column.name for column in COLUMNS] == list(IMPACT.names) == NAMES
    units = {"1", "s", "m", "kg", "m/s", "rad/s", "N", "J"}
    whole = "bead plate other kind material triangle run flags".split()
    documented = re.findall(r"\w+", PymunkImpacts.collisions.__doc__)
    for column in COLUMNS:
        assert column.unit in units and column.name in documented, column
        assert len(column.description) > 10, column
        assert IMPACT[column.name] == (np.int64 if column.name in whole else np.float64)


def test_flags_are_explained_bit_by_bit():
    for flag in cl.Validity:
        assert f"{flag.value} {flag.name.lower().replace('_', ' ')}" in COLUMNS[-1].description
