"""Benchmarks: every target of the project beside what was measured, and a peer in the same run.

``python -m validation.bench`` from a checkout with ``pip install -e '.[bench]'``. One file per
subject, each with a function ``rows()``; absolute times depend on the machine and its load, ratios
much less.
"""
