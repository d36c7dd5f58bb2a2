"""A contact law from a measured force curve, compared with the law from finite elements.

Force and compression of a bead that is pressed slowly into a block of the plate's material are the
loading curve beyond yield. Unloading is then Hertz's, with the larger radius of the flattened bead.
"""

import contactlaw as cl

RADIUS = 0.9e-3  # [m]
COMPRESSION = [12e-6, 20e-6, 30e-6, 45e-6, 70e-6]  # [m]
FORCE = [18.4, 38.1, 67.5, 111.0, 183.0]  # [N]


def main():
    """Compare the COR of the same impacts by the two laws."""
    pair = cl.Pair("gamma-alumina", "glass")
    pressed = cl.measured_law(pair, radius=RADIUS, compression=COMPRESSION, force=FORCE)
    models = {"measured": cl.ImpactModel(pair, law=pressed), "fem": cl.ImpactModel(pair, law="fem")}
    found = {}
    for speed in (5.0, 20.0, 40.0):
        cors = {name: model.restitution(speed, RADIUS, 3e-3) for name, model in models.items()}
        print(f"{speed:4.0f} m/s: " + ", ".join(f"{name} {cor:.3f}" for name, cor in cors.items()))
        found[speed] = cors
    return found


if __name__ == "__main__":
    main()
