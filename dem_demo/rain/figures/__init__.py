"""Figures of a rain: each file draws one, as `contactlaw.reporting.gallery` says."""

from __future__ import annotations

from contactlaw.reporting.gallery import Gallery

_GALLERY = Gallery(__name__, __path__)
names, module, draw = _GALLERY.names, _GALLERY.module, _GALLERY.draw
