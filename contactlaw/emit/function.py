"""One kernel for certain types of its arguments, written in another language."""

import ast
import functools
import inspect
import math
import operator
import re
import textwrap
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

import numpy as np

from contactlaw._jit import numbers_at, tuple_of
from contactlaw.emit import types
from contactlaw.emit.program import Program
from contactlaw.emit.types import (
    DOUBLE,
    ELEMENTS,
    INT,
    LONG,
    NUMBERS,
    UNKNOWN,
    Array,
    Known,
    Rows,
    Struct,
    Type,
    Value,
    traced,
)

# Operators: how they are written, how tightly they bind, what they make of known whole numbers.
OPERATORS: dict[type, tuple[str, int, Callable[..., Any]]] = {
    ast.Add: ("+", 8, operator.add),
    ast.Sub: ("-", 8, operator.sub),
    ast.Mult: ("*", 9, operator.mul),
    ast.Div: ("/", 9, lambda *_: UNKNOWN),
    ast.Mod: ("%", 9, operator.mod),
    ast.RShift: (">>", 7, operator.rshift),
    ast.BitOr: ("|", 3, operator.or_),
    ast.BitAnd: ("&", 4, operator.and_),
    ast.Lt: ("<", 6, operator.lt),
    ast.LtE: ("<=", 6, operator.le),
    ast.Gt: (">", 6, operator.gt),
    ast.GtE: (">=", 6, operator.ge),
    ast.Eq: ("==", 5, operator.eq),
    ast.NotEq: ("!=", 5, operator.ne),
    ast.USub: ("-", 10, operator.neg),
    ast.Not: ("!", 10, operator.not_),
}


class Function:
    """A kernel in lines, for certain types of its arguments, and the types of all its variables."""

    def __init__(self, program: Program, python: Callable[..., Any], given: Sequence[Type]) -> None:
        self._program, self._language, self._python = program, program.language, python
        lines, self._first = inspect.getsourcelines(python)
        tree: Any = ast.parse(textwrap.dedent("".join(lines)))
        found = inspect.getclosurevars(python)
        self._scope = {**python.__globals__, **found.builtins, **found.nonlocals}
        given_types = self._bound(python, *(Value(one, "") for one in given))
        self.types = {name: one.type for name, one in given_types.items()}
        self.given = len(self.types)
        self.result, before = types.VOID, None
        while before != (self.types, self.result):  # until no type is wider than before
            before = dict(self.types), self.result
            self.body = self._block(tree.body[0].body)

    def refuse(self, node: Any, remedy: str) -> NoReturn:
        """Say where a kernel leaves the subset of Python, and what to write instead."""
        file, line = inspect.getsourcefile(self._python), self._first + node.lineno - 1
        raise SyntaxError(
            f"{file}:{line}: {ast.unparse(node)!r} is not in the subset of Python that kernels are "
            f"written in, and cannot be in C or JavaScript; {remedy}"
        )

    def unified(self, node: Any, one: Type, other: Type) -> Type:
        """Type that holds values of both."""
        if one in (types.VOID, other):
            return other
        if isinstance(one, Array) and isinstance(other, Array) and one.of == other.of and not (one.data or other.data):
            return Array(of=one.of)
        if not {one, other} <= {*NUMBERS}:
            self.refuse(node, f"a variable has one type, not {one.name} and {other.name}")
        return max(one, other, key=NUMBERS.index)

    def _bound(self, python: Any, *given: Value, **named: Value) -> dict[str, Value]:
        """Arguments of a call by the names of the parameters, with those that are left out."""
        bound = inspect.signature(python).bind(*given, **named)
        bound.apply_defaults()
        return {
            name: one if isinstance(one, Value) else self._program.constant(one)
            for name, one in bound.arguments.items()
        }

    def _block(self, nodes: list[ast.stmt]) -> list[str]:
        lines: list[str] = []
        for node in nodes:
            lines += self._statement(node)
            if lines and re.match(r"(return|break|continue)\b", lines[-1]):
                break  # nothing after it is reached
        return lines

    def _statement(self, node: Any) -> list[str]:
        match node:
            case ast.Expr(value=value):
                return [f"{text};"] if (text := self.value(value).text) else []
            case ast.Return(value=None) | ast.Break() | ast.Continue():
                return [f"{type(node).__name__.lower()};"]
            case ast.Return(value=value):
                found = self.value(value)
                self.result = self.unified(node, self.result, found.type)
                return [f"return {found.text};" if traced(self.result) else "return;"]
            case ast.Assign(targets=[ast.Tuple(elts=places)], value=value):
                pairs = zip(*self._unpacked(places, value), strict=True)
                each = [ast.copy_location(ast.Assign([place], one), node) for place, one in pairs]
                return self._block([ast.fix_missing_locations(one) for one in each])
            case ast.Assign(targets=[target], value=value):
                return self._assign(target, self.value(value))
            case ast.Assign(targets=targets, value=value):
                return self._block([ast.Assign([one], value) for one in targets])
            case ast.AnnAssign(target=target, value=ast.expr() as value):
                return self._assign(target, self.value(value))
            case ast.AugAssign(target=target, op=op, value=value):
                whole = ast.copy_location(ast.BinOp(target, op, value), node)
                lines = self._assign(target, self.value(whole))
                return [re.sub(r"^(.+) = \1 (\S+) ", r"\1 \2= ", one) for one in lines]
            case ast.If():
                return self._if(node)
            case ast.While(test=test, body=inside, orelse=[]):
                return [f"while ({self.value(test).text}) {{", *self._block(inside), "}"]
            case ast.For(target=ast.Name(), iter=ast.Call(func=ast.Name("range")), orelse=[]):
                return self._for(node)
        self.refuse(node, "use assignments, if, while, for in a range, break and return")

    def _if(self, node: ast.If) -> list[str]:
        test = self.value(node.test)
        if test.known is not UNKNOWN:
            return self._block(node.body if test.known else node.orelse)
        body, other = self._block(node.body), self._block(node.orelse)
        if other and len(node.orelse) == 1 and other[0].startswith("if"):
            other = [f"}} else {other[0]}", *other[1:]]
        elif other:
            other = ["} else {", *other, "}"]
        return [f"if ({test.text}) {{", *body, *(other or "}")] if body or other else []

    def _for(self, node: Any) -> list[str]:
        args = [ast.Constant(0), *node.iter.args, ast.Constant(1)][len(node.iter.args) > 1 :]
        start, stop, step = map(self.value, args[:3])
        if any(self._picks(one, node.target.id) for line in node.body for one in ast.walk(line)):
            if UNKNOWN in (start.known, stop.known):
                self.refuse(node.iter, "a loop over the members of a tuple has known ends")
            return self._unrolled(node, start.known, stop.known)
        self.types[node.target.id] = INT
        body, language = self._block(node.body), self._language
        self.types.pop(node.target.id)  # after a loop to its end Python has another number there
        name, kind = language.variable(node.target.id), language.local + language.type(INT) * language.typed
        head = f"for ({kind}{name} = {start.text}; {name} < {stop.within(7)}; {name} += {step.text}) {{"
        return [head, *body, "}"] if body else []

    def _picks(self, node: Any, index: str) -> bool:
        """Whether an expression is a member of a tuple whose place is a variable."""
        if not (isinstance(node, ast.Subscript) and getattr(node.slice, "id", "") == index):
            return False
        kind = self.types.get(getattr(node.value, "id", "")) or self.value(node.value).type
        return isinstance(kind, Struct) and not isinstance(kind, Rows)

    def _unrolled(self, node: Any, start: Any, stop: Any) -> list[str]:
        """Write a loop over the members of tuples, which have no place, once for each."""
        lines = list[str]()
        for n in range(start, stop):
            self.types[node.target.id] = Known(value=n)
            lines += self._block(node.body)
        self.types.pop(node.target.id)
        return lines

    def _unpacked(self, places: list[Any], value: Any) -> tuple[list[Any], list[Any]]:
        """Places and values by which a tuple is assigned; one of several may be read later on."""
        read = [ast.unparse(one) for one in getattr(value, "elts", ())]
        written = [rf"\b{re.escape(ast.unparse(one))}(?!\w)" for one in places]
        if read and not any(re.search(w, r) for n, w in enumerate(written) for r in read[n + 1 :]):
            return places, value.elts
        whole = ast.Name(f"{self.value(value).type.name}_")
        parts = [ast.Subscript(whole, ast.Constant(n)) for n in range(len(places))]
        return [whole, *places], [value, *parts]

    def _assign(self, target: ast.expr, value: Value) -> list[str]:
        match target:
            case ast.Name(id="_"):
                return []
            case ast.Name(id=name):
                before = self.types.get(name, types.VOID)
                self.types[name] = self.unified(target, before, value.type)
            case ast.Subscript(value=whole, slice=ast.Slice(lower=None, upper=None)):
                target = whole
        place = self.value(target)
        if not (traced(place.type) and place.text) or value.text in (place.text, "empty"):
            return []
        zeros, language = value.text == "zeros", self._language
        if isinstance(target, ast.Subscript) and isinstance(place.type, Struct) and place.type.row:
            return [f"*{place.within(10)} = *{value.within(10)};"]
        if isinstance(place.type, Array) and (zeros or not isinstance(value.type, Array)):
            number, size = "0.0" if zeros else value.text, math.prod(place.type.shape)
            return [language.fill.format(language.prefix, place.text, size, number)]
        return [f"{place.text} = {value.text};"]

    def value(self, node: Any) -> Value:
        """Write an expression, by the method of its kind."""
        make: Callable[[Any], Value] | None = getattr(self, "_" + type(node).__name__.lower(), None)
        if make is None:
            self.refuse(node, "use numbers, NamedTuples, arrays, operators and calls of kernels")
        return make(node)

    def _constant(self, node: ast.Constant) -> Value:
        return self._program.constant(node.value)

    def _tuple(self, node: ast.Tuple) -> Value:
        parts = {f"f{n}": self.value(one) for n, one in enumerate(node.elts)}
        return self._program.make(tuple, parts)

    def _ifexp(self, node: ast.IfExp) -> Value:
        test = self.value(node.test)
        if test.known is not UNKNOWN:
            return self.value(node.body if test.known else node.orelse)
        one, other = self.value(node.body), self.value(node.orelse)
        text = f"{test.within(1)} ? {one.within(1)} : {other.within(1)}"
        return Value(self.unified(node, one.type, other.type), text, 0)

    def _member(self, base: Value, whole: Struct, name: str) -> Value:
        kind = dict(whole.members)[name]
        text = self._language.member(base.within(11), name, whole) if traced(kind) else ""
        return Value(_in_formulas(kind), text, 11, getattr(kind, "value", UNKNOWN))

    def double(self, value: Value) -> Value:
        """Write a number as one of floating point."""
        if isinstance(value.known, int) and value.text.lstrip("-").isdigit():
            return Value(DOUBLE, f"{value.text}.0", value.binds)
        return value if value.type == DOUBLE else self._language.operation("float", value)

    def _name(self, node: ast.Name) -> Value:
        kind = self.types.get(node.id)
        if isinstance(kind, Known) and isinstance(kind.value, int):
            return self._program.constant(kind.value)
        if kind is not None:
            text = self._language.variable(node.id)
            return Value(kind, text, known=getattr(kind, "value", UNKNOWN))
        if node.id not in self._scope:
            self.refuse(node, "give the variable a value before it is read")
        return self._program.named(self._scope[node.id], node.id, self._python.__module__)

    def _attribute(self, node: ast.Attribute) -> Value:
        base, name = self.value(node.value), node.attr
        match base.type:
            case Known(value=value):
                module = getattr(value, "__name__", "")
                return self._program.named(getattr(value, name), name.upper(), module)
            case Struct() as kind:
                return self._member(base, kind, name)
            case Type("int") if name == "value":  # of an enum
                return base
            case Array(shape=shape) if shape and name in ("size", "shape"):
                return self._program.constant(math.prod(shape) if name == "size" else shape)
        self.refuse(node, "of an array only the size counts, where its shape is known")

    def _subscript(self, node: ast.Subscript) -> Value:
        base, at = self.value(node.value), node.slice
        if isinstance(base.type, Rows):
            return self._of_rows(base, base.type, at)
        places = [at.lower] if isinstance(at, ast.Slice) else getattr(at, "elts", [at])
        index, *column = map(self.value, places)
        match base.type:
            case Known(value=value) if index.known is not UNKNOWN:
                return self._program.constant(value[index.known])
            case Struct() as kind if index.known is not UNKNOWN:
                return self._member(base, kind, kind.members[index.known][0])
            case Array(shape=shape) if 0 in shape:
                return Value(DOUBLE, "")  # an array without elements leaves no trace
            case Array(data=data) if isinstance(at, ast.Slice):
                return self._language.operation("tail", base, index, kind=Array(data=data))
            case Array(data=data, shape=(_, size)):
                index, kind = (Value(INT, f"{index.within(9)} * {size}", 9), Array("array", data, (size,)))
                if not column:
                    return self._language.operation("tail", base, index, kind=kind)
                index = Value(INT, f"{index.text} + {column[0].within(9)}", 8)
            case Array(of=of) if not column:
                return Value(_in_formulas(of), f"{base.within(11)}[{index.text}]", 11)
            case kind if column or not isinstance(kind, Array):
                self.refuse(node, "index arrays, rows of known shape, tuples by known numbers")
        return Value(DOUBLE, f"{base.within(11)}[{index.text}]", 11)

    def _of_rows(self, base: Value, kind: Rows, at: Any) -> Value:
        """Take a row, by its address; rows from one on; a row of a matrix, which is rows itself."""
        first, count = (self._member(base, kind, name) for name in ("at", "n"))
        whole: Any = first.type
        if isinstance(at, ast.Slice):
            low, high = self.value(at.lower or ast.Constant(0)), self.value(at.upper) if at.upper else count
            end = f"{self._language.prefix}min{self._language.whole}({high.text}, {count.text})"  # as numpy has it
            return self._program.span(whole, f"{first.text} + {low.within(9)}", f"{end} - {low.within(9)}")
        if len(kind.members) == 2:
            return Value(whole, f"{first.text} + {self.value(at).within(9)}", 8)
        columns = f"{base.within(11)}.m"
        if isinstance(at, ast.Tuple):
            one, other = map(self.value, at.elts)
            return Value(whole, f"{first.text} + {one.within(9)} * {columns} + {other.within(9)}", 8)
        return self._program.span(whole, f"{first.text} + {self.value(at).within(9)} * {columns}", columns)

    def _at_address(self, at: ast.expr, shape: ast.expr, kind: ast.expr) -> Value:
        """Array at an address that a row has."""
        address, dtype = self.value(at).within(10), np.dtype(self.value(kind).known)
        if dtype.names:
            row = self._program.row(dtype)
            return self._program.span(row, f"({self._language.type(row)})(size_t){address}", self.value(shape).text)
        columns = [self.value(one).known for one in getattr(shape, "elts", [])[1:]]
        made = Array("array", False, (-1, *columns) if columns else (), ELEMENTS[dtype.str[1:]])
        return Value(made, f"({self._language.type(made)})(size_t){address}", 10)

    def _unaryop(self, node: ast.UnaryOp) -> Value:
        one = self.value(node.operand)
        sign, binds, known = self._operator(node, node.op, one)
        kind = INT if isinstance(node.op, ast.Not) else one.type
        return Value(kind, f"{sign}{one.within(11)}", binds, known)

    def _binop(self, node: ast.BinOp) -> Value:
        left, right = self.value(node.left), self.value(node.right)
        if isinstance(node.op, ast.Pow):
            return self._language.operation("pow", left, self.double(right))
        if isinstance(node.op, ast.FloorDiv):
            return self._language.operation("quotient", left, right, kind=INT)
        sign, binds, known = self._operator(node, node.op, left, right)
        divides = isinstance(node.op, ast.Div)
        kind = DOUBLE if divides else self.unified(node, left.type, right.type)
        if kind == DOUBLE:  # a known number in a formula of doubles is one of them
            left, right = (self.double(one) if divides or one.known is not UNKNOWN else one for one in (left, right))
        a, b = (one.within(12 if binds < 5 and one.binds < 11 else binds + (one is right)) for one in (left, right))
        return Value(kind, f"{a} {sign} {b}", binds, known)

    def _operator(self, node: Any, op: Any, *operands: Value) -> tuple[str, int, Any]:
        """Sign of an operator, how tightly it binds, and its result where that is known."""
        if type(op) not in OPERATORS:
            self.refuse(node, "use + - * / // % ** & | >>")
        sign, binds, act = OPERATORS[type(op)]
        known = [one.known for one in operands]
        return sign, binds, UNKNOWN if UNKNOWN in known else act(*known)

    def _length(self, node: Any, one: Value) -> Value:
        match one.type:
            case Rows() as kind:
                return self._member(one, kind, "n")
            case Known(value=tuple() as value):
                return self._program.constant(len(value))
            case Struct(members=members, row=False):
                return self._program.constant(len(members))
            case Array(shape=shape) if shape:
                return self._program.constant(shape[0])
        self.refuse(node, "rows, tuples and arrays of known shape have a length")

    def _compare(self, node: ast.Compare) -> Value:
        if len(node.ops) > 1:
            terms = zip([node.left, *node.comparators], node.ops, node.comparators, strict=False)
            pairs: Any = [ast.copy_location(ast.Compare(a, [op], [b]), node) for a, op, b in terms]
            return self._boolop(ast.BoolOp(ast.And(), pairs))
        left, right, op = self.value(node.left), self.value(node.comparators[0]), node.ops[0]
        if isinstance(op, ast.Is | ast.IsNot):
            return self._program.constant((left.known is None) == isinstance(op, ast.Is))
        sign, binds, known = self._operator(node, op, left, right)
        text = f"{left.within(8)} {sign} {right.within(8)}"
        return Value(INT, text, binds) if known is UNKNOWN else self._program.constant(bool(known))

    def _boolop(self, node: ast.BoolOp) -> Value:
        """Write `and` or `or`; what is decided already is left out, or decides."""
        either, kept = isinstance(node.op, ast.Or), []
        for one in map(self.value, node.values):
            if one.known is UNKNOWN:
                kept.append(one)
            elif bool(one.known) == either:
                return self._program.constant(either)
        if len(kept) < 2:
            return kept[0] if kept else self._program.constant(not either)
        sign, binds = ("||", 1) if either else ("&&", 2)
        return Value(INT, f" {sign} ".join(one.within(3) for one in kept), binds)

    def _call(self, node: ast.Call) -> Value:
        called: Any = self.value(node.func).known
        name, module = (getattr(called, one, "") for one in ("__name__", "__module__"))
        if called in (np.zeros, np.empty):
            sizes = getattr(node.args[0], "elts", node.args[:1])
            found = (self.value(one).known for one in sizes)
            return Value(Array(shape=tuple(found)), name)
        if name == "_array_at":
            return self._at_address(*node.args)
        values = [self.value(one) for one in node.args]
        if called in (tuple_of, numbers_at):
            (maker, source, *where), names = node.args, values[0].known._fields
            changed = {one.arg: one.value for one in node.keywords}
            fields: list[Any] = [changed.get(name, ast.Attribute(source, name)) for name in names]
            if where:
                steps = (ast.BinOp(ast.Constant(k), ast.Mult(), where[1]) for k in range(len(names)))
                fields = [ast.Subscript(source, ast.BinOp(where[0], ast.Add(), one)) for one in steps]
            return self._call(ast.Call(maker, fields, []))
        if called is len:
            return self._length(node, values[0])
        if called in (min, max, np.minimum, np.maximum):
            kind = functools.reduce(functools.partial(self.unified, node), [v.type for v in values])
            name = f"{self._language.prefix}{name[:3]}{self._language.whole * (kind == INT)}"
            text = functools.reduce(lambda a, b: f"{name}({a}, {b})", [one.text for one in values])
            return Value(kind, text)
        if called in (bool, int, float, np.uint64):
            whole = LONG if values[0].type == LONG else INT
            kind = {"int": whole, "float": DOUBLE}.get(name, values[0].type)
            same = kind == values[0].type
            return values[0] if same else self._language.operation(name, *values, kind=kind)
        if called is abs or module == "math" or isinstance(called, np.ufunc):
            return self._language.operation(name, *map(self.double, values))
        python = getattr(called, "py_func", called)
        if not (inspect.isfunction(python) or hasattr(called, "_fields")):
            self.refuse(node, "call kernels, NamedTuples, and functions of math")
        named = {str(one.arg): self.value(one.value) for one in node.keywords}
        given = self._bound(python, *values, **named)
        made = {f"{key}_": one.type for key, one in given.items() if one.text == "empty"}
        self.types |= made  # arrays that are made for this call
        given |= {key[:-1]: self._name(ast.Name(key)) for key in made}
        if hasattr(called, "_fields"):
            return self._program.make(called, given)
        kinds = [
            Known(value=one.known) if key in self._program.fixed and one.known is not UNKNOWN else one.type
            for key, one in given.items()
        ]
        name, result = add(self._program, called, *kinds, caller=self._python)
        texts = [one.text for one, kind in zip(given.values(), kinds, strict=True) if traced(kind)]
        text = f"{self._language.prefix}{name}({', '.join(texts)})"
        return Value(result, text) if traced(result) else self._program.constant(None)


def _in_formulas(kind: Type) -> Type:
    """Type of a number of a row or an array where it is read."""
    return INT if kind in ELEMENTS.values() and kind != DOUBLE else kind


def add(program: Program, kernel: Callable[..., Any], *given: Type, caller: Any = None) -> tuple[str, Type]:
    """Add a kernel for these types of arguments; returns its name there, and its type.

    What is written instead of a kernel may call that kernel itself.
    """
    other = program.instead.get(kernel, kernel)
    if getattr(other, "py_func", other) is not caller:
        kernel = other
    python = getattr(kernel, "py_func", kernel)
    key = python.__module__, python.__name__, given
    if key not in program.functions:
        outermost = None not in program.functions.values()
        program.functions[key] = None
        module, short = python.__module__.rpartition(".")[2], python.__name__.strip("_")
        name = program.free_name(kernel, short, f"{module}_{short}")
        made, said = Function(program, python, given), inspect.getdoc(python) or ""
        if made.result != types.NONE:  # users read all of a docstring that is for them
            said = said if outermost and program.language.typed else said.partition("\n")[0]
            program.parts.append(program.language.function(name, said, made))
        program.functions[key] = name, made.result
    found = program.functions[key]
    if found is None:
        raise RecursionError(f"{python.__module__}.{python.__name__} calls itself")
    return found
