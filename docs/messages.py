"""Make the page of errors and warnings from the code: `python docs/messages.py`.

Tables of the code give the errors that end a run and the flags. Warnings and refusals are read from the
syntax of the source: a value that a message has put into it is written as three dots.
"""

import ast
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

import contactlaw as cl
from contactlaw.physical.validity import limits_in_words
from contactlaw.stepping.trouble import MESSAGES

PACKAGE = Path(cl.__file__).parent
PAGE = Path(__file__).with_name("messages.md")
DOTS = "..."
WARNINGS = {"warn", "print_warning", "print_message"}
FEWEST_LETTERS = 16  # fixed letters of a message; one with fewer cannot be searched for

HEAD = """# When it says ...

Each error and warning of contactlaw says what is wrong and what to do. This page lists them, so that a search finds
them. Three dots stand for a number or a name. `python docs/messages.py` makes the page from the code.

- **A refused argument** reads `name: got value; what is right`. In Python it is a `cl.ArgumentError`, a ValueError
  with the attributes `name`, `value`, `reason` and `element` (its place in an array).
- **A wrong word** reads `unknown 'cylnder'; did you mean cylinder?`, and lists the known ones.
- **A command** writes messages to the standard error, behind `contactlaw:`. It ends with 1 if something was refused,
  with 2 if an option is wrong, and with 0 after a warning.

"""
TROUBLE = """## Errors that end a run

In LAMMPS, in loops with `WallContacts`, and in the fix of an input script. The message begins with the bead, the wall
and the time step, as `bead 7 on wall 0 at step 1200:`.

| name | it says |
| --- | --- |
"""
FLAGS = """## Flags of an answer

`Rebound.flags` and the column `flags` of records have these; `cl.explain(flags)` returns the words.
[How large the errors are](laws.md#where-not-to-trust-it).

| flag | which limit | what to do |
| --- | --- | --- |
"""
WARNED = """## Warnings

The answer or the run goes on.

"""
ROOMS = {
    "LAMMPS, walls and loops of your own": ["engines/lammps", "stepping", "walls", "softsphere.py", "dashpot.py"],
    "pymunk": ["engines/pymunk"],
    "Commands": ["cli", "parser.py", "quantities.py"],
    "Materials and plates": ["physical"],
    "Questions to a model": ["model.py", "answers", "laws", "equation"],
    "Fits and comparisons": ["fitting", "comparison.py"],
    "Records and reports": ["record", "reporting", "engines/record.py"],
    "Tables and cache": ["table"],
    "Exports": ["export", "emit"],
}
FILES = "The fix of LAMMPS, LIGGGHTS, and their build.sh"
# Messages of the files that `contactlaw export` writes, in C++ and for a shell, and the values in them.
OF_FILES = [
    (".cpp .in", re.compile(r'error->\w+\(FLERR,\s*((?:"(?:[^"\\]|\\.)*"\s*)+)'), re.compile("{[^}]*}")),
    (".sh", re.compile(r'stop ("(?:[^"\\]|\\.)*")'), re.compile(r"\${.*?}|\$\w+")),
]
Names = Mapping[str, ast.expr]


def written() -> str:
    """Return the page."""
    warnings: set[str] = set()
    refusals: dict[str, set[str]] = defaultdict(set)
    for path in sorted(PACKAGE.rglob("*.py")):
        place = path.relative_to(PACKAGE).as_posix()
        room = next((room for room, parts in ROOMS.items() if place.startswith(tuple(parts))), "")
        for is_warning, message in messages(ast.parse(path.read_text("utf-8"))):
            if len(re.findall("[a-z]", message)) >= FEWEST_LETTERS and (is_warning or room):
                (warnings if is_warning else refusals[room]).add(message)
    parts = [HEAD, TROUBLE]
    parts += [f"| `{code.name}` | {cell(re.sub('{.*?}', DOTS, text))} |\n" for code, text in MESSAGES.items()]
    parts += ["\n", FLAGS]
    for flag in cl.Validity:
        for limit, words in zip(limits_in_words(flag), cl.explain(flag), strict=True):
            advice = words.removeprefix(f"{limit}: ")
            parts.append(f"| `{flag.name}` | {cell(limit)} | {cell(advice)} |\n")
    parts += ["\n", WARNED, listed(warnings)]
    refusals[FILES] = set(of_files())
    for room in [*ROOMS, FILES]:
        parts += [f"\n## Refused: {room}\n\n", listed(refusals[room])]
    return "".join(parts)


def of_files() -> Iterator[str]:
    """Yield each message of the files that `contactlaw export` writes."""
    for path in sorted((PACKAGE / "export").rglob("*.*")):
        for endings, message, value in OF_FILES:
            if path.suffix in endings.split():
                for quoted in message.findall(path.read_text("utf-8")):
                    said = tidy(value.sub(DOTS, re.sub(r'"\s*"|^"|"\s*$', "", quoted))).replace("\\n", " ")
                    if len(re.findall("[a-z]", said)) >= FEWEST_LETTERS:
                        yield said


def messages(module: ast.Module) -> Iterator[tuple[bool, str]]:
    """Yield each message of a module, and whether it is a warning."""
    of_module = assigned(module.body)
    for function in ast.walk(module):
        if not isinstance(function, ast.FunctionDef):
            continue
        names = of_module | assigned(list(ast.walk(function)))
        for node in ast.walk(function):
            if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
                yield False, refusal(node.exc, names)
            elif isinstance(node, ast.Call) and node.args and called(node) in WARNINGS:
                yield True, tidy(text(node.args[0], names))


def refusal(error: ast.Call, names: Names) -> str:
    """Return the message of an exception."""
    parts = [text(one, names) for one in error.args]
    if called(error) == "ArgumentError" and len(parts) > 2:
        return tidy(f"{parts[0]}: {parts[2]}")
    return tidy(parts[0]) if parts else ""


def called(call: ast.Call) -> str:
    """Return the name of the function that a call is to."""
    return getattr(call.func, "attr", getattr(call.func, "id", ""))


def assigned(nodes: list[ast.AST]) -> dict[str, ast.expr]:
    """Find the variables that are assigned one text, and no other value."""
    values = defaultdict(list)
    for node in nodes:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            values[node.targets[0].id].append(node.value)
    return {name: found[0] for name, found in values.items() if len(found) == 1}


def text(node: ast.expr, names: Names) -> str:
    """Return the fixed parts of a text, with dots between them."""
    match node:
        case ast.Constant(value=str(value)):
            return value
        case ast.JoinedStr(values=values):
            return "".join(text(value, names) for value in values)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return text(left, names) + text(right, names)
        case ast.FormattedValue(value=value):
            return text(value, names)
        case ast.Name(id=name) if isinstance(names.get(name), ast.Constant | ast.JoinedStr | ast.BinOp):
            return text(names[name], {key: value for key, value in names.items() if key != name})
    return DOTS


def tidy(message: str) -> str:
    """Join dots that follow each other, and lines."""
    line = " ".join(message.split())
    return re.sub(r"(?:\.\.\.[ ,:]*){2,}(?=(.?))", lambda found: DOTS if found[1] in ").;]" else f"{DOTS} ", line)


def cell(message: str) -> str:
    """Write a message for a cell of a table, in which markdown changes nothing."""
    return re.sub(r"([*_|<])", r"\\\1", message)


def listed(found: set[str]) -> str:
    """List messages in the order of the alphabet."""
    return "".join(f"- `{one.replace('`', chr(39))}`\n" for one in sorted(found, key=lambda one: (one.lower(), one)))


if __name__ == "__main__":
    PAGE.write_text(written(), "utf-8")
