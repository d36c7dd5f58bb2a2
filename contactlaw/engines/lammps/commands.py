"""The user's LAMMPS commands while plates are attached: which are refused, and which add walls."""

from __future__ import annotations

import itertools
import re
import tempfile
from collections.abc import Callable, Collection, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lammps import lammps

# Commands whose first argument names a part of the simulation, which may be the adapter's own.
_NAMING = {"fix", "fix_modify", "unfix", "compute", "compute_modify", "uncompute", "group"}
_NAMING |= {"variable"}
_NO_STEPS = "it moves beads without time steps, and the force of the plates depends on what happens between"
_REFUSED = {
    **dict.fromkeys(
        ("minimize", "neb", "neb/spin", "prd", "tad", "hyper", "dynamical_matrix", "third_order"), _NO_STEPS
    ),
    "rerun": "the plates would see beads that jump from frame to frame",
}
_RENUMBERING = {"delete_atoms", "reset_atoms", "reset_atom_ids", "reset_ids"}
_FIX = re.compile(r"\]:\s*(\S+),\s*style = (\S+),\s*group = (\S+)")  # in what `info fixes` writes


def read(given: Any) -> list[list[str]]:
    """Words of each command of a text, or of a list of commands, up to a `clear`."""
    text = given if isinstance(given, str) else "\n".join(map(str, given or ()))
    text = re.sub(r'"""[\s\S]*?"""', '""', text)  # a quoted text may have lines of its own
    lines = re.sub(r"&[ \t]*\n", " ", text).splitlines()
    words = (line.partition("#")[0].split() for line in lines)
    return [*itertools.takewhile(lambda one: one[0] != "clear", filter(None, words))]


def check(commands: Iterable[list[str]], own: Collection[str]) -> None:
    """Refuse commands that the plates cannot follow, before they run.

    Commands hidden in a file or in an ``if`` are found afterwards, by their effect.
    """
    for command, *arguments in commands:
        given = " ".join((command, *arguments))
        if command in _NAMING and arguments and arguments[0] in own:
            raise RuntimeError(
                f"{given!r}: {arguments[0]} belongs to the plates; LammpsPlates.detach() takes "
                "them out of the simulation, and what is not theirs needs another name"
            )
        if command in _REFUSED:
            raise RuntimeError(f"{given!r}: {_REFUSED[command]}; detach() the plates before")
        if [command, *arguments[:1]] == ["run_style", "respa"]:
            raise RuntimeError(f"{given!r}: {_RESPA}")


_RESPA = "under it LAMMPS does not ask the plates for their force; use 'run_style verlet'"


def check_integrator(lmp: lammps) -> None:
    """Refuse an integrator that does not call ``fix external``."""
    if lmp.extract_global("respa_levels"):
        raise RuntimeError(f"lmp: has 'run_style respa': {_RESPA}")


def renumbers(commands: list[list[str]]) -> bool:
    """Whether these commands are a single one that may change the IDs of beads."""
    return len(commands) == 1 and commands[0][0] in _RENUMBERING


def whole(commands: list[list[str]]) -> list[list[str]]:
    """Put the commands of files in place of those that include them."""
    found = []
    for one in commands:
        file = Path(one[1]) if one[0] == "include" and one[1:] else None
        found += whole(read(file.read_text(errors="replace"))) if file and file.is_file() else [one]
    return found


def go_on_without(commands: list[list[str]], needed: Callable[[str], bool]) -> bool:
    """Whether another command comes while the rigid bodies of a fix that is needed are gone."""
    gone = set[str]()
    for command, *words in commands:
        if command == "unfix":
            gone.update(filter(needed, words))
        elif command == "fix" and words[2:] and words[2].endswith("/small"):
            gone.discard(words[0])
        elif gone:
            return True
    return False


def fixes(lmp: lammps) -> list[tuple[str, str, str]]:
    """ID, style and group of each fix; none on ranks other than 0.

    The library interface gives the IDs alone; ``info`` writes on rank 0, without the other ranks.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "fixes"
        type(lmp).command(lmp, f'info fixes out overwrite "{path}"')
        return _FIX.findall(path.read_text()) if path.exists() else []
