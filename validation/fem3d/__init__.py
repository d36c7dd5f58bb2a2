"""Finite elements in three dimensions: spheres that hit a plate obliquely, or near its edge.

An explicit solver beside the axisymmetric one of `validation.fem`, from which it takes the method:
`mesh`, `hexahedra`, `contact`, `impact`. The oblique impacts of `cases` and those of `edges`,
run by ``python -m validation.fem3d``, are what models are compared with.
"""
