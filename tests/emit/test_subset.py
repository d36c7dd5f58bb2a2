"""Kernels of the physics are in the subset of Python that can be C and JavaScript."""

import ast
from pathlib import Path

import pytest

import contactlaw
from contactlaw.emit.function import OPERATORS
from contactlaw.export import functions

ROOT = Path(contactlaw.__file__).parent
ROOMS = "equation", "laws", "stepping", "walls", "physical"
FILES = [path for room in ROOMS for path in sorted((ROOT / room).glob("*.py"))]
FILES += [ROOT / "table/lookup.py", *sorted((ROOT / "export").glob("*functions.py"))]
PLAIN = ast.Assign | ast.AnnAssign | ast.AugAssign | ast.If | ast.While | ast.Return | ast.Break
PLAIN |= ast.Continue | ast.Expr | ast.Constant | ast.Name | ast.Attribute | ast.Subscript
PLAIN |= ast.Tuple | ast.Slice | ast.BoolOp | ast.IfExp | ast.Call
USED = ast.Is, ast.IsNot, ast.Pow, ast.FloorDiv, *OPERATORS


def kernels(text):
    """Functions that are kernels, but for those that other languages have another way for."""
    instead = {one.__name__ for one in functions.INSTEAD}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef) and node.name not in instead:
            if any("kernel" in ast.unparse(one) for one in node.decorator_list):
                yield node


def outside(kernel):
    """What of a kernel is not in the subset."""
    for node in ast.walk(ast.Module(kernel.body, [])):
        match node:
            case ast.For(target=ast.Name(), iter=ast.Call(func=ast.Name("range")), orelse=[]):
                pass
            case ast.UnaryOp(op=ast.USub() | ast.Not()):
                pass
            case ast.BinOp(op=op) | ast.Compare(ops=[op, *_]) if isinstance(op, USED):
                pass
            case ast.stmt() | ast.expr() if not isinstance(node, PLAIN):
                yield node


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_kernels_are_in_the_subset(path):
    """What its types allow is tried by writing the header and the page."""
    for kernel in kernels(path.read_text()):
        for node in outside(kernel):
            pytest.fail(
                f"{path}:{node.lineno}: {ast.unparse(node)!r} cannot be in C or JavaScript: use "
                "numbers, NamedTuples, arrays, operators, calls of kernels, if, while, for in range"
            )


def test_what_is_outside_is_found():
    (kernel,) = kernels("@kernel(inline=True)\ndef k(x):\n    for a in x:\n        y = a << 2\n")
    assert [type(one) for one in outside(kernel)] == [ast.For, ast.BinOp]
