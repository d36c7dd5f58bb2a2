"""Forces in the contacts of beads with walls in one time step, for any engine.

`spring` gives the normal force, `energy` corrects it for the errors of velocity Verlet, `friction`
gives the tangential force, `contact` puts them together, `plate_rows` holds their constants, and
`bead` finds the contacts.
"""

from contactlaw.stepping.bead import WallContacts, interact
from contactlaw.stepping.contact import Bead, Clock
from contactlaw.stepping.trouble import Trouble

__all__ = ["Bead", "Clock", "Trouble", "WallContacts", "interact"]
