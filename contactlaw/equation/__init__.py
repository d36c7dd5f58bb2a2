"""The equation of one impact and its solution, without units; a law is an array here.

`force` reads a law's data, `integrator` steps along a contact and lands on its events, `zener` asks
what became of an impact, `outcome` lists the fields of the answer. Nothing here knows a law's name,
a unit or a file.
"""
