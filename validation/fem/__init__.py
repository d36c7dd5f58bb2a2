"""Finite elements, independent of the model: the paper's two ABAQUS models, rebuilt.

An explicit axisymmetric solver (`mesh`, `elements`, `contact`, `solver`) lets an elastic-plastic
sphere fall on an elastic plate (`impact`) or presses it into a block (`indentation`). The studies
(`studies`, run by ``python -m validation.fem``) leave their results in ``validation/data``, and
`validation.accuracy` puts the laws beside them.
"""
