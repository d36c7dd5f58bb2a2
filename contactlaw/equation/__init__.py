"""The equation of one impact and its solution, without units; a law is an array here.

`force` reads a law's data, `legs` cuts the path of a contact at the law's kinks, `motion` is
the equation with the plate, `losses` names the energies; `integrator` steps along a contact and
lands on its events, `zener` solves impacts, `numbers` scales them, `corrections` are those of a
real plate, `outcome` has the answer's fields.
Nothing here knows a law's name, a unit or a file.
"""
