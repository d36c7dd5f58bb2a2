"""A short record of the demo's kind."""

import math

import h5py

from contactlaw.engines.layout import write, write_materials


def write_rain(path, pair):
    """Write the datasets that `contactlaw constant` reads, as `dem-demo rain` does."""
    columns = {
        "beads/radius": [0.9e-3, 1e-3, 1.1e-3],
        "plates/thickness": [0.5e-3, math.inf],
        "collisions/approach_speed": [1.0, 2.0, 0.5, 3.0],
        "collisions/bead": [0, 2, 1, 1],
        "collisions/plate": [0, 1, -1, 0],
    }
    with h5py.File(path, "w") as file:
        file.attrs.update(format="contactlaw-rain", law="hertz")
        write_materials(file, pair.sphere, pair.plate)
        for name, values in columns.items():
            write(file, name, values, "", "")
