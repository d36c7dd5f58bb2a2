"""Run the campaigns that are named, or all: ``python -m validation.hostile [NAME ...]``."""

from __future__ import annotations

import importlib
import pkgutil
import sys
import time

import validation.hostile
from contactlaw.parser import Parser

CAMPAIGNS = tuple(
    module.name for module in pkgutil.iter_modules(validation.hostile.__path__) if not module.name.startswith("_")
)


def main(arguments: list[str] | None = None) -> int:
    """Print the faults that each campaign finds; 1 if there is any, 0 if there is none."""
    parser = Parser(prog="python -m validation.hostile", description=__doc__)
    parser.add_argument("name", nargs="*", default=list(CAMPAIGNS), choices=CAMPAIGNS)
    parser.add_argument("--count", type=int, help="cases to try; by default the whole campaign")
    parser.add_argument("--seed", type=int, default=0, help="seed of the random cases (default 0)")
    options = parser.parse_args(arguments)
    found = 0
    for name in options.name:
        campaign = importlib.import_module(f"validation.hostile.{name}")
        count, started = options.count or campaign.FULL, time.perf_counter()
        faults = 0
        for fault in campaign.faults(count, options.seed):
            print(f"{name}: {fault}", flush=True)
            faults += 1
        print(f"{name}: {count} cases, {faults} faults, {time.perf_counter() - started:.0f} s")
        found += faults
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
