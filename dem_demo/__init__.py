"""The command ``dem-demo``: simulations that show what contactlaw gives a particle simulation.

Each command builds a scene, simulates it with an engine, records it (`kit.run`), draws figures
and prints a summary; each folder but `kit` is a scene. All quantities are in SI units.
"""
