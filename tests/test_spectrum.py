"""The power that a record's impacts feed into walls, against the record's energies and own integration."""

import math

import numpy as np
import oracle
import pytest
from impacted import PAIR, impacted, thin_plate

import contactlaw as cl

EDGES = 1e3 * 10 ** (np.arange(-10.5, 31) / 10)  # IEC 61260-1: half a tenth of a decade beside the centres
ONE = {"approach_speed": 2.0, "radius": 1e-3, "thickness": 1e-3}


@pytest.mark.parametrize("law", ["hertz", "myc", "fem"])
def test_the_bands_add_up_to_the_energy_of_the_waves(law):
    rng, n, thickness = np.random.default_rng(1), 1000, np.array([0.5e-3, 1e-3, 3e-3])
    speed, radius = 10 ** rng.uniform([[-1.0], [-3.5]], [[1.2], [-2.7]], (2, n))
    wall = rng.integers(3, size=n)
    record = impacted(law, approach_speed=speed, radius=radius, plate=wall, thickness=thickness[wall])
    spectrum = record.spectrum(duration=2.0)
    whole = np.bincount(wall, record.rows["wave_energy"]) / 2.0
    assert spectrum.power.sum(axis=1) == pytest.approx(whole, rel=1e-3)
    assert spectrum.wall.tolist() == [0, 1, 2] and spectrum.left_out.tolist() == [0.0] * 3
    assert spectrum.frequency[1:-1] == pytest.approx(np.sqrt(EDGES[1:] * EDGES[:-1]))
    if law != "fem":  # its plate has corrections
        by_force = thin_plate(thickness)[0][:, None] * spectrum.force[:, 1:-1] * np.diff(EDGES)
        assert by_force.sum(axis=1) == pytest.approx(spectrum.power[:, 1:-1].sum(axis=1), rel=1e-3)


def test_bands_are_those_of_an_integration_of_ones_own():
    (speed, radius, thickness), duration = ONE.values(), 0.5
    stiffness, mobility = 4 / 3 * PAIR.effective_modulus * math.sqrt(radius), thin_plate(thickness)[0]
    mass = 4 / 3 * math.pi * radius**3 * PAIR.sphere.density
    restitution, end, force = oracle.series(mass, stiffness, mobility, speed)
    time, frequency = np.linspace(0.0, end, 2001), np.linspace(EDGES[:-1], EDGES[1:], 21)
    square = abs(np.trapezoid(force(time) * np.exp(-2j * math.pi * frequency[:, :, None] * time), time)) ** 2
    expected = 2 * mobility * np.trapezoid(square, frequency, axis=0) / duration
    found = impacted("hertz", **ONE).spectrum(duration)
    # forces from the table are within 1e-3 of the peak, which shows where next to no power is
    assert found.power[0, 1:-1] == pytest.approx(expected, rel=1e-3, abs=1e-4 * expected.max())
    impulse = mass * speed * (1 + restitution)
    assert found.force[0, :2] == pytest.approx(2 * impulse**2 / duration, rel=1e-3)  # Campbell's theorem


def test_contacts_without_a_force_history_are_left_out_and_parcels_count_as_their_beads():
    kinds = [0, 3, 6, 0, 0, 0]  # with one that was struck, and one of a body
    record = impacted("myc", **{name: np.full(6, size) for name, size in ONE.items()}, kind=kinds, time=np.arange(6))
    rows = record.rows
    alone = record.part([0]).spectrum(duration=4.0)
    rows["wave_energy"][3] *= 1.1  # as next to an edge
    rows["parcel"][4], rows["plate"][5] = 2.0, -1
    rows["mass"][4], rows["wave_energy"][4] = 8 * rows["mass"][4], 8 * rows["wave_energy"][4]
    found = record.spectrum()
    assert found.duration == 4.0 and found.left_out == pytest.approx(3.1 / 12.1)
    assert found.power == pytest.approx(9 * alone.power) and found.force == pytest.approx(9 * alone.force)


def test_what_has_no_spectrum_is_refused_in_words():
    record = impacted("myc", **ONE, kind=3)
    rows = record.rows
    columns = [name for name in rows.dtype.names if name != "mass"]
    cases = {
        "record: lacks the column mass": cl.Record(rows[columns], record.bodies),
        "record: has no impact on this wall, or on any, whose force is known": record,
    }
    for words, refused in cases.items():
        with pytest.raises(ValueError, match=words):
            refused.spectrum(duration=1.0)
    with pytest.raises(ValueError, match="duration: got 0.0; must be positive"):
        impacted("myc", **ONE).spectrum()
