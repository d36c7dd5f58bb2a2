"""Expressions of a kernel, in another language."""

from __future__ import annotations

import ast
import functools
import inspect
import math
import operator
from collections.abc import Callable, Collection
from types import ModuleType
from typing import Any, NoReturn, Protocol

import numpy as np

from contactlaw.emit import types
from contactlaw.emit.c import C
from contactlaw.emit.types import DOUBLE, INT, NONE, UNKNOWN, Array, Known, Row, Struct, Type, Value

# Operators: how they are written, how tightly they bind, and what they do to known numbers.
OPERATORS: dict[type, tuple[str, int, Callable[[Any, Any], Any]]] = {
    ast.Add: ("+", 8, operator.add), ast.Sub: ("-", 8, operator.sub),
    ast.Mult: ("*", 9, operator.mul), ast.Div: ("/", 9, operator.truediv),
    ast.Mod: ("%", 9, operator.mod), ast.RShift: (">>", 7, operator.rshift),
    ast.BitOr: ("|", 3, operator.or_), ast.BitAnd: ("&", 4, operator.and_),
    ast.Lt: ("<", 6, operator.lt), ast.LtE: ("<=", 6, operator.le),
    ast.Gt: (">", 6, operator.gt), ast.GtE: (">=", 6, operator.ge),
    ast.Eq: ("==", 5, operator.eq), ast.NotEq: ("!=", 5, operator.ne),
}  # fmt: skip


class _Program(Protocol):
    """What expressions ask of the `Program` that they are a part of."""

    language: C
    fixed: Collection[str]

    def add(self, kernel: Any, *types: Type) -> tuple[str, Type]: ...
    def struct(self, source: Any, members: tuple[tuple[str, Type], ...]) -> Struct: ...
    def tuple_of(self, types: tuple[Type, ...]) -> Struct: ...
    def constant(self, value: Any) -> Value: ...
    def named(self, value: Any, name: str, module: str) -> Value: ...


class Expressions:
    """Expressions in the body of a kernel of a `Program`, with the types of its variables."""

    def __init__(self, program: _Program, python: Callable[..., Any], first: int) -> None:
        self._program, self._language = program, program.language
        self._python, self._first = python, first
        found = inspect.getclosurevars(python)
        self._scope = {**python.__globals__, **found.builtins, **found.nonlocals}
        self._types: dict[str, Type] = {}

    def refuse(self, node: Any, remedy: str) -> NoReturn:
        """Say where a kernel leaves the subset of Python, and what to write instead."""
        file, line = inspect.getsourcefile(self._python), self._first + node.lineno - 1
        raise SyntaxError(
            f"{file}:{line}: {ast.unparse(node)!r} is not in the subset of Python that kernels are "
            f"written in, and cannot be in C or JavaScript; {remedy}"
        )

    def unified(self, node: Any, one: Type | None, other: Type) -> Type:
        """Type that holds values of both."""
        if one is None or one == other:
            return other
        if {one, other} == {INT, DOUBLE}:
            return DOUBLE
        if isinstance(one, Array) and isinstance(other, Array) and one.data == other.data:
            return Array(data=one.data)
        self.refuse(node, f"a variable has one type, not {one.name} and {other.name}")

    def value(self, node: Any) -> Value:
        """Write an expression, by the method of its kind."""
        name = f"_{type(node).__name__.lower()}"
        write: Callable[[Any], Value] | None = getattr(self, name, None)
        if write is None:
            self.refuse(node, "use numbers, NamedTuples, arrays, operators and calls of kernels")
        return write(node)

    def _constant(self, node: ast.Constant) -> Value:
        return self._program.constant(node.value)

    def _tuple(self, node: ast.Tuple) -> Value:
        values = [self.value(one) for one in node.elts]
        made = self._program.tuple_of(tuple(one.type for one in values))
        return self.made(made, [one.text for one in values])

    def _unaryop(self, node: ast.UnaryOp) -> Value:
        one, negates = self.value(node.operand), isinstance(node.op, ast.USub)
        if not negates and one.known is not UNKNOWN:
            return types.FALSE if one.known else types.TRUE
        known = UNKNOWN if one.known is UNKNOWN else -one.known
        sign, kind = ("-", one.type) if negates else ("!", INT)
        return Value(kind, f"{sign}{one.within(11)}", 10, known)

    def _ifexp(self, node: ast.IfExp) -> Value:
        test = self.value(node.test)
        if test.known is not UNKNOWN:
            return self.value(node.body if test.known else node.orelse)
        one, other = self.value(node.body), self.value(node.orelse)
        text = f"{test.within(1)} ? {one.within(1)} : {other.within(1)}"
        return Value(self.unified(node, one.type, other.type), text, 0)

    def made(self, kind: Struct, texts: list[str]) -> Value:
        """Make a structure; members that leave no trace are left out."""
        parts = {name: text for (name, one), text in zip(kind.members, texts, strict=True)
                 if types.traced(one)}  # fmt: skip
        return Value(kind, self._language.make(kind, parts))

    def member(self, base: Value, name: str) -> Value:
        """Read a member of a structure."""
        kind = dict(base.type.members)[name]
        if isinstance(kind, Known):
            return Value(kind, "", known=kind.value)
        if not types.traced(kind):
            return Value(kind, "", known=None if kind == NONE else UNKNOWN)
        return Value(kind, self._language.member(base.within(11), name, base.type), 11)

    def double(self, value: Value) -> str:
        """Text of a number that is to be one of floating point."""
        if isinstance(value.known, int) and value.text.lstrip("-").isdigit():
            return f"{value.text}.0"
        return value.within(10) if value.type == DOUBLE else self._written("float", value).text

    def _written(self, name: str, *values: Value, kind: Type = DOUBLE) -> Value:
        """Write one of the language's operations."""
        pattern, binds, operands = self._language.operations[name]
        texts = (one.within(least) for one, least in zip(values, operands, strict=True))
        return Value(kind, pattern.format(*texts), binds)

    def _name(self, node: ast.Name) -> Value:
        kind = self._types.get(node.id)
        if isinstance(kind, Known):
            known = isinstance(kind.value, int)
            return self._program.constant(kind.value) if known else Value(kind, "", 12, kind.value)
        if kind is not None:
            text = self._language.variable(node.id)
            return Value(kind, text, known=None if kind == NONE else UNKNOWN)
        if node.id not in self._scope:
            self.refuse(node, "give the variable a value before it is read")
        return self._program.named(self._scope[node.id], node.id, self._python.__module__)

    def _attribute(self, node: ast.Attribute) -> Value:
        base, name = self.value(node.value), node.attr
        match base.type:
            case Known(value=ModuleType() as module):
                return self._program.named(getattr(module, name), name, module.__name__)
            case Known(value=value):
                return self._program.named(getattr(value, name), name.upper(), "")
            case Struct():
                return self.member(base, name)
            case Row(members=members):
                size = dict(members)[name]
                kind = Array(shape=(size,)) if size else DOUBLE
                return self._written("of_row", base, Value(kind, name), kind=kind)
            case Array(shape=shape) if shape and name in ("size", "shape"):
                return self._program.constant(math.prod(shape) if name == "size" else shape)
        self.refuse(
            node, "an array needs a known shape for its size, and nothing else of it counts"
        )

    def _subscript(self, node: ast.Subscript) -> Value:
        base, at = self.value(node.value), node.slice
        if isinstance(base.type, Known | Struct):
            index = self.value(at).known
            if index is UNKNOWN:
                self.refuse(node, "only a known index picks from a tuple")
            if isinstance(base.type, Known):
                return self._program.constant(base.type.value[index])
            return self.member(base, base.type.members[index][0])
        if not isinstance(base.type, Array):
            self.refuse(node, "only arrays and tuples have elements")
        shape, data = base.type.shape, base.type.data
        if isinstance(at, ast.Slice):
            return self._written("tail", base, self.value(at.lower), kind=Array(data=data))
        if 0 in shape:
            return Value(DOUBLE, "")  # an array without elements leaves no trace
        index, *column = map(self.value, at.elts if isinstance(at, ast.Tuple) else [at])
        if len(shape) == 2:
            index = Value(INT, f"{index.within(9)} * {shape[1]}", 9)
            if not column:
                return self._written("tail", base, index, kind=Array(data=data, shape=shape[1:]))
            index = Value(INT, f"{index.text} + {column[0].within(9)}", 8)
        elif column:
            self.refuse(node, "an array of rows needs a known shape")
        return Value(DOUBLE, f"{base.within(11)}[{index.text}]", 11)

    def _binop(self, node: ast.BinOp) -> Value:
        left, right = self.value(node.left), self.value(node.right)
        if isinstance(node.op, ast.Pow):
            return Value(DOUBLE, self._language.call("pow", [left.text, self.double(right)]))
        if isinstance(node.op, ast.FloorDiv):
            return self._written("quotient", left, right, kind=INT)
        if type(node.op) not in OPERATORS:
            self.refuse(node, "use + - * / // % ** & | >>")
        sign, binds, act = OPERATORS[type(node.op)]
        divides = isinstance(node.op, ast.Div)
        kind = DOUBLE if divides else self.unified(node, left.type, right.type)
        whole = isinstance(left.known, int) and isinstance(right.known, int) and not divides
        a, b = (
            # a known number in a formula of doubles is one of them
            self.double(one) if kind == DOUBLE and (divides or one.known is not UNKNOWN) else
            one.within(12 if binds < 5 and one.binds < 11 else binds + (one is right))
            for one in (left, right)
        )  # fmt: skip
        return Value(
            kind, f"{a} {sign} {b}", binds, act(left.known, right.known) if whole else UNKNOWN
        )

    def _compare(self, node: ast.Compare) -> Value:
        values = [self.value(one) for one in (node.left, *node.comparators)]
        if isinstance(node.ops[0], ast.Is | ast.IsNot):
            is_none = values[0].type == NONE
            return types.TRUE if is_none == isinstance(node.ops[0], ast.Is) else types.FALSE
        texts = []
        for op, left, right in zip(node.ops, values, values[1:], strict=False):
            sign, binds, act = OPERATORS[type(op)]
            if UNKNOWN not in (left.known, right.known):
                return types.TRUE if act(left.known, right.known) else types.FALSE
            texts.append(f"{left.within(8)} {sign} {right.within(8)}")
        return Value(INT, " && ".join(texts), 2 if len(texts) > 1 else binds)

    def _boolop(self, node: ast.BoolOp) -> Value:
        """Write `and` or `or`; what is decided already is left out, or decides."""
        either, kept = isinstance(node.op, ast.Or), []
        for one in map(self.value, node.values):
            if one.known is UNKNOWN:
                kept.append(one)
            elif bool(one.known) == either:
                return types.TRUE if either else types.FALSE
        if len(kept) < 2:
            return kept[0] if kept else types.FALSE if either else types.TRUE
        sign, binds = ("||", 1) if either else ("&&", 2)
        return Value(INT, f" {sign} ".join(one.within(3) for one in kept), binds)

    def _call(self, node: ast.Call) -> Value:
        called: Any = self.value(node.func).known
        if called in (np.zeros, np.empty):
            size = node.args[0]
            parts = size.elts if isinstance(size, ast.Tuple) else [size]
            shape = tuple(self.value(one).known for one in parts)
            return Value(Array(shape=shape), called.__name__)
        values = [self.value(one) for one in node.args]
        name = getattr(called, "__name__", "")
        if called in (min, max, np.minimum, np.maximum):
            return functools.reduce(lambda a, b: self._extreme(node, name[:3], a, b), values)
        if called is len:
            return self._program.constant(len(values[0].type.members))
        if called in (int, bool, float, abs, np.uint64, np.int64, np.float64):
            kind = {"int": INT, "float": DOUBLE, "abs": values[0].type}.get(name)
            if kind is None or kind == values[0].type and name != "abs":
                return values[0]
            return self._written(name, values[0], kind=kind)
        if getattr(called, "__module__", "") == "math" or isinstance(called, np.ufunc):
            texts = [one.text if one.type == DOUBLE else self.double(one) for one in values]
            return Value(DOUBLE, self._language.call(name, texts))
        by_name = {one.arg: self.value(one.value) for one in node.keywords}
        if isinstance(called, type) and hasattr(called, "_fields"):
            defaults = getattr(called, "_field_defaults", {})
            given = {n: self._program.constant(v) for n, v in defaults.items()}
            given |= dict(zip(called._fields, values, strict=False)) | by_name
            members = tuple((one, given[one].type) for one in called._fields)
            texts = [given[one].text for one in called._fields]
            return self.made(self._program.struct(called, members), texts)
        if not inspect.isfunction(getattr(called, "py_func", called)):
            self.refuse(node, "call kernels, NamedTuples, and functions of math")
        names = list(inspect.signature(getattr(called, "py_func", called)).parameters)
        values += [by_name[one] for one in names if one in by_name]
        kinds = tuple(
            Known(value=value.known) if one in self._program.fixed and value.known is not UNKNOWN
            else value.type
            for one, value in zip(names, values, strict=False)
        )  # fmt: skip
        name, result = self._program.add(called, *kinds)
        texts = [one.text for one, kind in zip(values, kinds, strict=True) if types.traced(kind)]
        text = f"{self._language.prefix}{name}({', '.join(texts)})"
        return Value(NONE, "", known=None) if result == NONE else Value(result, text)

    def _extreme(self, node: Any, name: str, one: Value, other: Value) -> Value:
        kind, language = self.unified(node, one.type, other.type), self._language
        ending = language.whole if kind == INT else ""
        return Value(kind, f"{language.prefix}{name}{ending}({one.text}, {other.text})")
