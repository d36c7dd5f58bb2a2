"""Judge `contactlaw.fit`: ``python -m validation.inverse [NAME ...]``."""

from __future__ import annotations

import sys

from validation.inverse import coverage, elements, model

REPORTS = {
    "model": model.report,
    "elements": elements.report,
    "contact_time": elements.contact_time,
    "coverage": coverage.report,
}


def main(names: list[str]) -> int:
    """Print the reports that are named, or all; 2 for wrong usage."""
    wrong = set(names) - set(REPORTS)
    if wrong:
        print(f"no such report: {', '.join(wrong)}; there are {', '.join(REPORTS)}")
        return 2
    for name in names or REPORTS:
        print(REPORTS[name](), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
