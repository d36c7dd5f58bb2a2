"""The command ``dem-demo``: each folder here but the kit is a scene, and a subcommand.

The file ``command`` of a scene has a function `add`, which adds the subcommand and stores the
function that runs it as `start`. Slow imports are inside functions, where Ctrl-C is handled.
"""

from __future__ import annotations

import argparse
import importlib
import pkgutil
import shlex
import sys
import time
import traceback
from collections.abc import Sequence

import dem_demo
from contactlaw.parser import Parser
from dem_demo.kit import signals
from dem_demo.kit.options import Refused
from dem_demo.kit.signals import Interrupted, interruptible

_PATIENCE = 300.0  # [s]; drawing the figures and the page of a rain takes less


def main(argv: Sequence[str] | None = None) -> int:
    """Run ``dem-demo``, and return its exit status.

    0: done; 1: refused or stopped, with a message on stderr; 128 + signal: interrupted. Wrong usage
    exits with 2.
    """
    argv = sys.argv[1:] if argv is None else list(argv)
    try:
        with interruptible():
            arguments = parser().parse_args(argv)
            try:
                status = int(arguments.start(arguments, shlex.join(["dem-demo", *argv])))
            except Exception:
                signals.check()  # it may be what an interrupt has left that Python dropped
                raise
        return _stopped(status) if status else 0
    except Interrupted as stop:
        if not _rank():  # of several ranks only the first one reports
            print(f"\ndem-demo: {stop} before it began; nothing was written", file=sys.stderr)
        return _stopped(stop.exit_status)
    except (Refused, OSError, RuntimeError) as error:  # adapters raise RuntimeError
        print(f"dem-demo: {error}", file=sys.stderr)
        return _stopped(1)
    except Exception:
        traceback.print_exc()
        return _stopped(1)


def scenes() -> list[str]:
    """Names of all scenes, sorted.

    Examples
    --------
    >>> scenes()
    ['rain', 'sieve']
    """
    found = pkgutil.iter_modules(dem_demo.__path__)
    return sorted(module.name for module in found if module.ispkg and module.name != "kit")


def parser() -> argparse.ArgumentParser:
    """Make the parser of ``dem-demo``."""
    made = Parser(prog="dem-demo", description="Simulations that show what contactlaw gives an engine.")
    commands = made.add_subparsers(required=True, metavar="COMMAND")
    for name in scenes():
        importlib.import_module(f"dem_demo.{name}.command").add(commands)
    return made


def _rank() -> int:
    mpi = sys.modules.get("mpi4py.MPI")
    return 0 if mpi is None else int(mpi.COMM_WORLD.rank)


def _stopped(status: int) -> int:
    """Stop the other ranks too, which would wait for this one for ever."""
    mpi = sys.modules.get("mpi4py.MPI")
    if mpi is not None and mpi.COMM_WORLD.size > 1:
        if _rank() > 0:
            time.sleep(_PATIENCE)  # rank 0 writes the partial results, then stops all ranks
        mpi.COMM_WORLD.Abort(status)
    return status
