"""The law of a pair of materials where no Python runs: source files in C, scenes, a page for a browser."""

from contactlaw.export.c_header import header
from contactlaw.export.lammps_fix import lammps
from contactlaw.export.liggghts_wall import liggghts
from contactlaw.export.scene_file import scene
from contactlaw.export.web_page import page

__all__ = ["header", "lammps", "liggghts", "page", "scene"]
