"""Figures of a rain, of which `dem_demo.kit.gallery` knows how a file becomes one."""

from __future__ import annotations

from dem_demo.kit.gallery import Gallery, Picture

__all__ = ["Picture", "draw", "module", "names"]

_GALLERY = Gallery(__name__, __path__)
names, module, draw = _GALLERY.names, _GALLERY.module, _GALLERY.draw
