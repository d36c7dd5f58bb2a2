"""Which examples in docstrings need an engine that may be missing."""

from importlib.util import find_spec

collect_ignore_glob = [] if find_spec("lammps") else ["contactlaw/engines/lammps/*"]
