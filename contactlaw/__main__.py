"""``contactlaw``, also as ``python -m contactlaw``: the command line."""

import sys
from collections.abc import Sequence

# Python integrates this many impacts in less time than numba takes to load compiled kernels.
_FEW = 20


def main() -> int:
    """Run the command of this process, without a compiler if it asks for a few impacts."""
    if asks_for_few(sys.argv[1:]):
        from contactlaw import _jit

        _jit.switch_off()
    from contactlaw.cli import main as command

    return command()


def asks_for_few(words: Sequence[str]) -> bool:
    """Whether a command line asks for a few impacts; if this is wrong, it only takes longer.

    A range is many values, a picture needs hundreds of impacts, and ``--outside clamp`` a table;
    ``--outside solve`` may take 200,000 steps to find that a plate is too thin.

    Examples
    --------
    >>> asks_for_few(["cor", "--speed", "1,2,5", "--radius", "1mm"])
    True
    >>> asks_for_few(["cor", "--speed", "1:5:50", "--radius", "1mm"])
    False
    """
    if words[:1] != ["cor"] or any(":" in word or word.startswith("--plot") for word in words):
        return False
    count = 1
    for word in words:
        count *= 1 + word.count(",")
    beyond = {"clamp", "solve", "--outside=clamp", "--outside=solve"}
    return count <= _FEW and not beyond & set(words)


if __name__ == "__main__":
    sys.exit(main())
