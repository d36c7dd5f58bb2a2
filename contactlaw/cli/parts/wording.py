"""Error messages of the command line, with options in place of arguments.

Errors of the library name its arguments, ``speed: got -1.0``, and what to call instead. On the
command line arguments are options of the same name, and the remedy is another option.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import PurePath
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from contactlaw._errors import ArgumentError
from contactlaw._readable import in_unit
from contactlaw.answers.backend import OutsideTableError, UnsolvedError
from contactlaw.parser import for_stderr
from contactlaw.physical.materials import NoYieldStrengthError, UnknownMaterialError

_OTHER_NAMES = {
    "path": "plot",
    "priors": "prior",
    "restitution": "cor",
    "slowest": "speed",
    "stiffness": "foundation",
}  # arguments whose options have other names
_NEAREST = 4  # names that are suggested in place of an unknown one

OWN = '"E=2.8GPa nu=0.35 rho=1410 yield=62MPa kind=polymer"'  # a material on the command line


class Written(float):
    """A number as the user wrote it, with its unit."""

    text: str

    def __new__(cls, size: float, text: str) -> Written:
        """Keep the text beside the number."""
        number = super().__new__(cls, size)
        number.text = text.strip()
        return number


def sentence(error: Exception, options: Mapping[str, Any]) -> str:
    """Write the message of an error with options in place of arguments.

    Arguments that are not among the `options` of the command keep their names. A value that is
    `Written` is repeated as the user wrote it.

    Examples
    --------
    >>> error = ArgumentError("speed_error", -0.01, "must be 0 to 1")
    >>> sentence(error, {"speed_error": Written(-0.01, "-1%")})
    "--speed-error: got '-1%'; must be 0 to 1"
    """
    match error:
        case UnknownMaterialError(args=(name, names)):
            near = f"did you mean {' or '.join(map(repr, names[:_NEAREST]))}? " if names else ""
            return (
                f"unknown material {name!r}: {near}`contactlaw materials` lists all; one of your own "
                f"is in --materials FILE, or numbers: {OWN}"
            )
        case NoYieldStrengthError():
            return f"--sphere: {error.what}: take --law fem, in which such a body is elastic and the other may yield"
        case UnicodeEncodeError():
            return f"the output is in {error.encoding}, which lacks a character of a name: set PYTHONIOENCODING=utf-8"
        case OSError(filename=str(path), strerror=str(reason)):
            return f"{path}: {reason}"
        case OSError(strerror=str(reason)):
            return reason
        case ArgumentError():
            names = [_OTHER_NAMES.get(name, name) for name in error.name.split(", ")]
            if all(name in options for name in names):
                error = _as_written(error, options[names[0]])
                return f"--{', --'.join(names)}: ".replace("_", "-") + error.complaint
    return str(error)


def _as_written(error: ArgumentError, sizes: Any) -> ArgumentError:
    """Put the user's words for the refused one of some sizes into an error."""
    for size in sizes if isinstance(sizes, tuple) else (sizes,):
        if isinstance(size, Written) and repr(size) == repr(error.value):
            return ArgumentError(error.name, size.text, error.reason)
    return error


def check_suffix(name: str, path: str | os.PathLike[str], suffixes: Sequence[str]) -> None:
    """Refuse a file whose suffix names none of some formats."""
    if PurePath(path).suffix.lower() not in suffixes:
        *others, last = suffixes
        raise ArgumentError(name, os.fspath(path), f"must end in {', '.join(others)}{' or ' * bool(others)}{last}")


@contextmanager
def reading(path: str | os.PathLike[str]) -> Iterator[None]:
    """Name the file whose content is refused, or makes its reader fail in a way not foreseen."""
    try:
        yield
    except (OSError, ImportError):  # these name the file, or the package that is missing
        raise
    except Exception as error:  # readers of damaged files raise errors of many types
        what = "" if isinstance(error, ValueError) else f"cannot read it: {type(error).__name__}: "
        raise ValueError(f"{path}: {what}{error}") from error


@contextmanager
def writing(option: str, path: str | os.PathLike[str], folder: bool = False) -> Iterator[None]:
    """Name the option and the file, or the folder, that could not be written.

    A missing folder is refused before the body of the ``with`` statement runs.
    """
    if not os.fspath(path):
        raise ArgumentError(option, "", f"expected the name of a {'folder' if folder else 'file'}")
    path = os.path.normpath(path) if folder else os.fspath(path)
    if os.path.lexists(path) and os.path.isdir(path) != folder:
        raise ArgumentError(option, None, f"{path} is {'no' if folder else 'a'} folder")
    parent = os.path.dirname(path)
    if parent and not os.path.isdir(parent):
        raise ArgumentError(option, None, f"there is no folder {parent}")
    try:
        yield
    except OSError as error:
        where = error.filename or path
        raise ArgumentError(option, None, f"cannot write {where}: {error.strerror}") from error


@contextmanager
def naming_impact(
    speed: ArrayLike, radius: ArrayLike, thickness: ArrayLike, *, mass: float | None = None
) -> Iterator[None]:
    """Name the impact that an error within is about by its speed, sizes, and mass if given."""
    try:
        yield
    except (OutsideTableError, UnsolvedError) as error:
        v, r, h = (values.flat[error.impact] for values in np.broadcast_arrays(speed, radius, thickness))
        impact = f"{in_unit(v, 'm/s')}, radius {in_unit(r, 'm')}, thickness {in_unit(h, 'm')}"
        if mass is not None:
            impact += f", mass {in_unit(mass, 'kg')}"
        if isinstance(error, UnsolvedError):
            what = f"the equation did not solve at {error.where}: {error.reason}"
        else:
            what = (
                f"outside the table, {error.reason}. --outside solve integrates the equation "
                "there, --outside clamp takes the value at the table's border"
            )
        raise ValueError(f"{impact}: {what}") from error


def print_message(message: str) -> None:
    """Write a message to stderr."""
    if sys.stderr is not None:  # None if the shell has closed it by 2>&-; print would take stdout
        print(for_stderr(f"contactlaw: {message}"), file=sys.stderr)


def print_warning(message: Warning | str, *_: object) -> None:
    """Write a warning to stderr; also takes the arguments of `warnings.showwarning`."""
    print_message(f"warning: {message}")
