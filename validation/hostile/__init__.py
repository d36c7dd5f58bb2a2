"""Campaigns of random inputs that try to make contactlaw crash, or answer wrongly with confidence.

``python -m validation.hostile [NAME ...] [--count N]``. A campaign is a file of this folder. It has

    FULL                     how many cases the whole campaign tries
    faults(count, seed)      try that many; yield one sentence per fault found, with all its inputs

The tests run a coarse part of each campaign; none may find a fault.
"""
