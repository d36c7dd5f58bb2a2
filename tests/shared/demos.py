"""Short runs of the demo, which `conftest.py` of its tests makes once."""

import pickle

# Numbers are those of the paper's law, whichever is the default; its table comes with the package.
RAIN = "rain --beads 40 --plates 0.5e-3,1e-3,inf --duration 0.3 --law myc".split()
# Few beads that never meet, with true contacts, of which none lasts at a frame.
DRUM = "drum --softening 1 --beads 4 --duration 0.16 --friction 0 --speed 1.5 --sphere gamma-alumina".split()
DRUM += "--plate glass --law myc --seed 3 --constant-cor 0.8".split()
SIEVE = "sieve --softening 1 --beads 12 --duration 0.016 --speed 2.5 --friction 0 --plate glass --law myc".split()


def names(folder):
    return {path.name for path in folder.iterdir()}


def runs_of(folder):
    """Runs of which a fixture of `conftest.py` has made a folder."""
    return pickle.loads(folder.parent.with_suffix(".pickle").read_bytes())


def files(name, figures, *more):
    """Names of the files of a scene, whose figures these modules draw."""
    pictures = {f"{one.__name__.rpartition('.')[2]}.png" for one in figures}
    return {f"{name}.h5", "summary.txt", "index.html", f"{name}.gif", *pictures, *more}
