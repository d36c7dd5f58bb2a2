"""The equation of one impact and its solution, without units; a law is an array here.

`force` reads a law's data, `legs` cuts the way of a contact where that has kinks, `plate` and
`losses` are the other parts of the equation of `motion`; `integrator` steps along a contact and
lands on its events, `creep` goes where steps would be too many, `zener` asks what became of
impacts, `outcome` lists the fields of the answer. Nothing here knows a law's name, a unit or a
file.
"""
