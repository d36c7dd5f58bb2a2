"""From a table of measured rebounds to a strength with its error, and to a plate for a wanted COR.

The table holds speed, COR and its error of each rebound of a drop test. The same from a shell:
`contactlaw fit rebounds.csv --sphere gamma-alumina --plate glass --radius 0.9mm --thickness 1mm
--unknown yield_strength --plot rebounds.png`.
"""

import tempfile
from pathlib import Path

import contactlaw as cl
from contactlaw.cli.parts import fitplot, measured

REBOUNDS = Path(__file__).with_name("rebounds.csv")  # beads of alumina on glass of 1 mm
RADIUS, THICKNESS = 0.9e-3, 1e-3  # [m]
WANTED, SPEED = 0.6, 10.0  # COR that a designer wants [-], at this speed [m/s]


def main(folder=None):
    """Find the strength of the beads, draw the fit, and choose a plate for them."""
    data = measured.measurements(REBOUNDS, radius=RADIUS, thickness=THICKNESS)
    found = cl.fit(cl.Pair("gamma-alumina", "glass"), data, unknown="yield_strength")
    strength, error = (part["yield_strength"] / 1e6 for part in (found.values, found.errors))
    print(f"yield strength of the beads {strength:.0f} +- {error:.0f} MPa")
    print(f"  of which {found.statistical_errors['yield_strength'] / 1e6:.0f} from the data,")
    print(f"  {found.model_errors['yield_strength'] / 1e6:.0f} from the model")
    picture = Path(folder or tempfile.mkdtemp()) / "rebounds.png"
    fitplot.save_fit(found, "gamma-alumina on glass", picture)
    print(picture)

    # A plate for a wanted COR is a fit to one rebound without an error.
    wanted = {"speed": SPEED, "radius": RADIUS, "restitution": WANTED}
    plate = cl.fit(found.pair, wanted, unknown="thickness")
    thickness, off = (1e3 * part["thickness"] for part in (plate.values, plate.errors))
    print(f"COR {WANTED} at {SPEED:g} m/s: a plate of {thickness:.3f} +- {off:.3f} mm")
    return found, plate


if __name__ == "__main__":
    main()
