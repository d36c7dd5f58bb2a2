"""Short runs of the demo, which `conftest.py` of its tests makes once."""

import pickle

# Numbers are those of the paper's law, whichever is the default; its table comes with the package.
RAIN = "rain --beads 40 --plates 0.5e-3,1e-3,inf --duration 0.3 --law myc".split()
# Few beads that never meet, with true contacts.
SIEVE = "sieve --softening 1 --beads 12 --duration 0.016 --speed 2.5 --friction 0".split()
SIEVE += "--sphere gamma-alumina --plate glass --law myc".split()


def names(folder):
    return {path.name for path in folder.iterdir()}


def runs_of(folder):
    """Runs of which a fixture of `conftest.py` has made a folder."""
    return pickle.loads(folder.with_name("runs").read_bytes())


def files(name, figures, *more):
    """Names of the files of a scene, whose figures these modules draw."""
    pictures = {f"{one.__name__.rpartition('.')[2]}.png" for one in figures}
    return {f"{name}.h5", "summary.txt", "index.html", *pictures, *more}
