"""From a table of measured rebounds to a strength with its error, and to a plate for a wanted COR.

The table holds speed, COR and its error of each rebound of a drop test. The same from a shell:
`contactlaw fit rebounds.csv --sphere gamma-alumina --plate glass --radius 0.9mm --thickness 1mm
--unknown yield_strength --plot rebounds.png`.
"""

import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import contactlaw as cl

REBOUNDS = Path(__file__).with_name("rebounds.csv")  # beads of alumina on glass of 1 mm
SIZES = {"radius": 0.9e-3, "thickness": 1e-3}  # [m]
WANTED, SPEED = 0.6, 10.0  # COR that a designer wants [-], at this speed [m/s]


def main():
    """Find the strength of the beads, draw the fit, and choose a plate for them."""
    speed, cor, error = np.loadtxt(REBOUNDS, delimiter=",", skiprows=1, unpack=True)
    data = {"speed": speed, "restitution": cor, "restitution_error": error, **SIZES}
    found = cl.fit(cl.Pair("gamma-alumina", "glass"), data, unknown="yield_strength")
    strength, error = (part["yield_strength"] / 1e6 for part in (found.values, found.errors))
    print(f"yield strength of the beads {strength:.0f} +- {error:.0f} MPa")
    print(f"  of which {found.statistical_errors['yield_strength'] / 1e6:.0f} from the data,")
    print(f"  {found.model_errors['yield_strength'] / 1e6:.0f} from the model")
    picture = Path(tempfile.mkdtemp()) / "rebounds.png"
    draw(found, picture)
    print(picture)

    plate = cl.ImpactModel(found.pair).thickness(WANTED, SPEED, SIZES["radius"])
    for best in 1e3 * plate.value:
        print(f"COR {WANTED} at {SPEED:g} m/s: a plate of {best:.3f} mm")


def draw(found, picture):
    """Draw the rebounds, and the fitted COR over speed with its standard error."""
    data = found.data
    speed = np.geomspace(data.speed.min(), data.speed.max(), 100)
    hit, errors = found.curve(speed, **SIZES)
    below, above = (hit.restitution + sign * errors["restitution"] for sign in (-1.0, 1.0))
    figure = Figure()
    axes = figure.subplots()
    axes.errorbar(data.speed, data.restitution, data.restitution_error, fmt="o", label="measured")
    axes.plot(speed, hit.restitution, label="fitted")
    axes.fill_between(speed, below, above, alpha=0.3)
    axes.set(xscale="log", xlabel="speed [m/s]", ylabel="coefficient of restitution")
    axes.legend()
    figure.savefig(picture)


if __name__ == "__main__":
    main()
