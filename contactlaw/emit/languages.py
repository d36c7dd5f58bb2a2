"""How C and JavaScript write what a kernel does."""

import inspect
import json
import math
import re
import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from contactlaw.emit.types import DOUBLE, Array, Struct, Type, Value, traced

WIDTH = 100
# What a variable cannot be called in one of the languages.
RESERVED = frozenset(
    """arguments auto await bool case catch char class const constant debugger
default delete do double else enum eval export extends extern false far float function global goto half
implements in instanceof int interface kernel let local long near new operator package private
protected public register short signed static struct super switch template this throw true typeof union
unsigned var void with yield""".split()
)
_COMMENT = re.compile(r"^    (\w+)\b.*?:.*?#\s*(.*)$", re.MULTILINE)


def wrapped(line: str, end: str = "") -> str:
    """Break a line that is too long at its spaces."""
    indent = line[: len(line) - len(line.lstrip())] + 8 * " "
    lines = textwrap.wrap(
        line, WIDTH - len(end), subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )
    return f"{end}\n".join(lines)


def laid_out(lines: Iterable[str]) -> str:
    """Indent lines by the braces around them."""
    depth, text = 0, []
    for line in lines:
        depth -= line.startswith("}")
        text.append(wrapped(f"{4 * depth * ' '}{line}"))
        depth += line.endswith("{")
    return "\n".join(text)


class C:
    """C99 that is C++11, CUDA, HIP and OpenCL C too; names get a prefix.

    `operations` are patterns, how tightly they bind, and how tightly their operands have to. `new`
    makes a structure, as literals differ in C and C++; `whole` ends min and max of integers.
    """

    operations: Mapping[str, tuple[str, int, tuple[int, ...]]] = {
        "float": ("(double){}", 10, (10,)),
        "int": ("(int){}", 10, (10,)),
        "abs": ("fabs({})", 12, (0,)),
        "quotient": ("{} / {}", 9, (9, 10)),
        "tail": ("{} + {}", 8, (8, 9)),
    }
    head, array, local, unused = "static inline {}{}({})\n{{", "{}[{}]", "", "(void){};"
    fill, define = "{}fill({}, {}, {});", "#define {} {}"
    data = "static const double {}[] = {{", "};"
    comment, nothing, typed = ("/* ", " * ", " */"), "void", True
    nan, inf, maths, whole = "(double)NAN", "HUGE_VAL", "", "_int"
    new, member_of_new = "{}new({}){{ {} }}", "{1}"

    def __init__(self, prefix: str = "contactlaw_") -> None:
        self.prefix = prefix

    def variable(self, name: str) -> str:
        """Write the name of a variable."""
        return f"{name}_" if name in RESERVED else name

    def number(self, value: float) -> str:
        """Write a number."""
        return repr(value).replace("inf", self.inf).replace("nan", self.nan)

    def type(self, kind: Type) -> str:
        """Write a type, with a space if a name may follow directly."""
        if isinstance(kind, Array):
            return f"{self.prefix}data *" if kind.data else f"{kind.of.name} *"
        if isinstance(kind, Struct):
            return f"{self.prefix}{kind.name} {'*' * kind.row}"
        return f"{kind.name} "

    def make(self, kind: Struct, parts: dict[str, str]) -> str:
        """Make a structure of its members."""
        each = (self.member_of_new.format(self.variable(one), text) for one, text in parts.items())
        return self.new.format(self.prefix, kind.name, ", ".join(each))

    def member(self, text: str, name: str, kind: Struct) -> str:
        """Read a member of a structure."""
        return f"{text}{'->' if kind.row else '.'}{self.variable(name)}"

    def operation(self, name: str, *values: Value, kind: Type = DOUBLE) -> Value:
        """Write one of the operations, or call a function of mathematics."""
        call = f"{self.maths}{name}({', '.join('{}' for _ in values)})", 12, len(values) * (0,)
        pattern, binds, operands = self.operations.get(name, call)
        texts = (one.within(least) for one, least in zip(values, operands, strict=True))
        return Value(kind, pattern.format(*texts), binds)

    def structure(self, kind: Struct) -> str:
        """Declare a structure, with what its class says of it and of its members."""
        lines, comments = list[str](), dict[str, str]()
        if hasattr(kind.source, "_fields"):
            lines = [f"/* {(inspect.getdoc(kind.source) or '').partition(chr(10))[0]} */"]
            comments = dict(_COMMENT.findall(inspect.getsource(kind.source).replace("*/", "* /")))
        lines.append(f"typedef struct {self.prefix}{kind.name} {{")
        for name, one in kind.members:
            comment = f" /* {comments[name]} */" if name in comments else ""
            if kind.row and isinstance(one, Array):
                lines.append(f"{one.of.name} {self.array.format(self.variable(name), math.prod(one.shape))};")
            elif traced(one):
                lines.append(f"{self.type(one)}{self.variable(name)};{comment}")
        return laid_out([*lines, f"}} {self.prefix}{kind.name};"])

    def function(self, name: str, said: str, made: Any) -> str:
        """Write a `Function`, and declare those of its own variables that are left in its body."""
        begin, line, end = self.comment
        said = f"{begin}{said.replace('`', '').replace('*/', '* /')}{end}"
        words = set(re.findall(r"\w+", " ".join(made.body)))
        assigned = {one.partition(" = ")[0] for one in made.body}
        by_type, given = dict[str, list[str]](), dict[str, str]()
        for n, (plain, kind) in enumerate(made.types.items()):
            one = self.variable(plain)
            if n < made.given and traced(kind):
                given[one] = f"{self.type(kind) * self.typed}{one}"
            elif one in words and traced(kind):
                # an array that is assigned to is another name of one
                if isinstance(kind, Array) and kind.shape and not kind.data and one not in assigned:
                    one, kind = self.array.format(one, math.prod(kind.shape)), DOUBLE
                by_type.setdefault(self.type(kind) * self.typed, []).append(one)
        joined = {kind: (", *" if "*" in kind else ", ").join(one) for kind, one in by_type.items()}
        declared = [f"{self.local}{kind}{names};" for kind, names in joined.items()]
        unused = [self.unused.format(one) for one in given if self.unused and one not in words]
        parameters = ", ".join(given.values()) or self.nothing
        head = self.head.format(self.type(made.result), self.prefix + name, parameters)
        lines = laid_out([*head.split("\n"), *declared, *unused, *made.body, "}"])
        return "\n".join([*textwrap.wrap(said, WIDTH, subsequent_indent=line), lines])

    def constant(self, name: str, value: str | Sequence[float]) -> str:
        """Define a constant, a text or an array."""
        name = f"{self.prefix}{name}"
        if isinstance(value, str):
            text = self.define.format(name, value if value[0] != "-" else f"({value})")
            return wrapped(text, " \\" if text.startswith("#") else "")
        numbers = (re.sub(r"\b0(?=\.)", "", self.number(one).removesuffix(".0")) for one in value)
        # a line has at least four commas, whose spaces go
        text = "\n".join(textwrap.wrap(", ".join(numbers), WIDTH + 4)).replace(", ", ",")
        return f"{self.data[0].format(name)}\n{text}\n{self.data[1]}"

    def table(self, members: str, name: str, rows: Iterable[Sequence[object]]) -> str:
        """Define a table of numbers and texts."""
        lines = ",\n".join(f"{{ {', '.join(map(json.dumps, row))} }}" for row in rows)
        return f"static const struct {{ {members} }} {self.prefix}{name}[] = {{\n{lines}\n}};"


class JavaScript(C):
    """JavaScript without rows; NamedTuples and tuples are objects, arrays Float64Arrays.

    Names begin with $, if no variable is to hide them. ``explore.js`` has what Math lacks.
    """

    operations = {
        "float": ("{}", 10, (10,)),
        "int": ("Math.trunc({})", 12, (0,)),
        "abs": ("Math.abs({})", 12, (0,)),
        "quotient": ("Math.floor({} / {})", 12, (9, 10)),
        "tail": ("{}.subarray({})", 11, (11, 0)),
        "copysign": ("$copysign({}, {})", 12, (0, 0)),
    }
    head, array = "function {1}({2}) {{", "{} = new Float64Array({})"
    local, unused, nothing, typed = "let ", "", "", False
    fill, define = "{1}.fill({3}, 0, {2});", "const {} = {};"
    data = "const {} = new Float64Array([", "]);"
    comment = "// ", "// ", ""
    nan, inf, maths, whole = "NaN", "Infinity", "Math.", ""
    new, member_of_new = "{{ {2} }}", "{0}: {1}"
