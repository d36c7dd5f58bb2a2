"""What happens in contacts in one time step; no engine.

`spring` gives the normal force, `energy` accounts for it under a velocity Verlet scheme, `friction`
is the tangential force, `contact` puts them together, and `bead` finds the contacts with walls.
"""

from contactlaw.stepping.bead import WallContacts, interact
from contactlaw.stepping.contact import Bead, Clock, Trouble

__all__ = ["Bead", "Clock", "Trouble", "WallContacts", "interact"]
