"""Figures of any run: each file draws one of a `contactlaw.reporting.run.Run`."""

from contactlaw.reporting.gallery import Gallery

_GALLERY = Gallery(__name__, __path__)
names, module, draw = _GALLERY.names, _GALLERY.module, _GALLERY.draw
