"""Whether a few impacts are integrated in Python; no import here defines a kernel."""

# Python integrates this many impacts in less time than numba takes to load compiled kernels.
_FEW = 20


def switch_off_compiler(impacts: float, outside: str) -> bool:
    """Leave the kernels of this process as Python if it asks for so few impacts.

    Taking the value at the border of a table needs the table, and integrating outside of it may
    take 200,000 steps to find that a plate is too thin.
    """
    if impacts > _FEW or outside != "raise":
        return False
    from contactlaw import _jit

    _jit.switch_off()
    return True
