"""Finite elements in three dimensions: a sphere that hits a plate obliquely, with friction.

An explicit solver beside the axisymmetric one of `validation.fem`, from which it takes the method:
`mesh`, `hexahedra`, `contact`, `impact`. The impacts of `cases`, run by ``python -m
validation.fem3d``, are what models of oblique impacts are compared with.
"""
