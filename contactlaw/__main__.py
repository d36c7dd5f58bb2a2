"""``contactlaw``, also as ``python -m contactlaw``: the command line."""

import math
import sys
from collections.abc import Sequence

from contactlaw.answers.few import switch_off_compiler


def main() -> int:
    """Run the command of this process, without a compiler if it asks for a few impacts.

    Returns
    -------
    int
        What `contactlaw.cli.main` returns; 130 if interrupted, also while modules are imported.
    """
    try:
        switch_off_compiler(*asked(sys.argv[1:]))
        from contactlaw.cli import main as command

        return command()
    except KeyboardInterrupt:
        print("contactlaw: interrupted", file=sys.stderr)
        return 130


def asked(words: Sequence[str]) -> tuple[float, str]:
    """Count the impacts that a command line asks for, and take its ``--outside``.

    A range is many values, and a picture needs hundreds of impacts. Too high a number only takes
    longer.

    Examples
    --------
    >>> asked(["cor", "--speed", "1,2,5", "--radius", "1mm"])
    (3, 'raise')
    >>> asked(["cor", "--speed", "1:5:50", "--radius", "1mm"])
    (inf, 'raise')
    """
    given = " ".join(words).replace("=", " ").split()
    outside = dict(zip(given, [*given[1:], ""], strict=False)).get("--outside", "raise")
    many = words[:1] != ["cor"] or ":" in "".join(words) or "--plot" in given
    return math.inf if many else math.prod(1 + word.count(",") for word in words), outside


if __name__ == "__main__":
    sys.exit(main())
