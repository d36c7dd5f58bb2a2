"""Judge `contactlaw.fit`: ``python -m validation.inverse [NAME ...]``."""

from __future__ import annotations

from contactlaw.parser import Parser
from validation.inverse import coverage, elements, model

REPORTS = {
    "model": model.report,
    "elements": elements.report,
    "contact_time": elements.contact_time,
    "coverage": coverage.report,
}


def main(arguments: list[str] | None = None) -> None:
    """Print the reports that are named, or all."""
    parser = Parser(prog="python -m validation.inverse", description=__doc__)
    parser.add_argument("name", nargs="*", default=list(REPORTS), choices=REPORTS)
    for name in parser.parse_args(arguments).name:
        print(REPORTS[name](), flush=True)


if __name__ == "__main__":
    main()
