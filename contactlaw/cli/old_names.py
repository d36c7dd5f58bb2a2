"""Subcommands and options of contactlaw 0.3, answered with what to type now; goes in 1.1."""

import shlex
from collections.abc import Sequence

_MOVED = {
    "thickness": "find thickness",
    "speed": "find speed",
    "oblique": "cor",
    "history": "cor --history",
    "sweep": "cor",
}
_REPLACED = {
    "speed-table": "`speed-table` is now part of `constant`; type: contactlaw constant --table --speed 0.1,10 ...",
    "--fluent or --acusolve": "`oblique --fluent` and `--acusolve` are gone: nobody has tried their files; "
    "`cor` prints the same columns; type: contactlaw cor --angle ... --csv",
}


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
    typed = shlex.join(rest)
    if command == "oblique" and ("--fluent" in typed or "--acusolve" in typed):
        command = "--fluent or --acusolve"
    if command in _MOVED:
        start = _MOVED[command]
        return f"`{command}` is now part of `{start.split()[0]}`; type: contactlaw {start} {typed}".rstrip()
    files = [word.removeprefix("--record=") for word in rest if word != "--record"]
    if command == "constant" and files != rest:
        return f"files are arguments now; type: contactlaw constant {shlex.join(files or ['FILE'])}"
    return _REPLACED.get(command, "")
