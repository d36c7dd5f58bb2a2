"""Subcommands and options of contactlaw 0.3, answered with what to type now; goes in 1.1."""

import shlex
from collections.abc import Sequence

# What replaces a subcommand, and why or how.
_REPLACED = {
    "thickness": ("find thickness", "`thickness` is now part of `find`"),
    "speed": ("find speed", "`speed` is now part of `find`"),
    "oblique": ("cor", "`oblique` is now part of `cor`"),
    "history": ("cor --history", "`history` is now an option of `cor`"),
    "sweep": ("cor", "`sweep` is now part of `cor`"),
    "speed-table": ("constant --table", "`speed-table` is now an option of `constant`"),
    "bounces": ("compare FILE", "`bounces` is gone: the app phyphox hears bounces, and `compare` reads its files"),
    "experiment": ("find --help", "`experiment` is gone: `find` and `cor` show which sheets and heights tell most"),
}
_TRACERS = "--fluent", "--acusolve"


def answer(words: Sequence[str]) -> str:
    """Say what to type in place of a command line with old names; empty without any.

    Examples
    --------
    >>> answer(["thickness", "--cor", "0.5"])
    '`thickness` is now part of `find`; type: contactlaw find thickness --cor 0.5'
    >>> answer(["constant", "--record", "a.npy", "--csv"])
    'files are arguments now; type: contactlaw constant a.npy --csv'
    """
    command, *rest = words or [""]
    rest = [part for word in rest for part in (word.split("=", 1) if word.startswith("--") else [word])]
    start, reason = _REPLACED.get(command, (command, ""))
    if command in ("bounces", "experiment"):
        rest = []
    elif command == "oblique" and (tracer := next((word for word in rest if word in _TRACERS), "")):
        reason = f"`oblique {tracer}` is gone: nobody has tried its files; `cor` prints the same columns"
        del rest[rest.index(tracer) : rest.index(tracer) + 2]
        rest.append("--csv")
    elif command == "speed-table":
        ends = [_taken(rest, "--slowest", "0.1"), _taken(rest, "--fastest", "10")]
        rest = ["--speed", ",".join(ends), *(word for word in rest if word != "--csv")]
    elif command == "constant" and "--record" in rest:
        reason = "files are arguments now"
        rest.remove("--record")
    return f"{reason}; type: contactlaw {start} {shlex.join(rest)}".rstrip() if reason else ""


def _taken(words: list[str], option: str, default: str) -> str:
    """Take an option and its value out of some words."""
    if option not in words[:-1]:
        return default
    at = words.index(option)
    value = words[at + 1]
    del words[at : at + 2]
    return value
