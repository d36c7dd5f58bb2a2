"""What takes long to make, and is made by one of the processes of a parallel run for all of them."""

import os

from filelock import FileLock


def once(tmp_path_factory, name, make):
    """Folder of this name, which `make` has filled; nobody changes it."""
    base = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        base = base.parent
    folder, done = base / name, base / f"{name}.done"
    with FileLock(base / f"{name}.lock"):
        if not done.exists():
            folder.mkdir()
            make(folder)
            done.touch()
    return folder
