"""The generator: what it writes for small kernels, and what it refuses with line and remedy."""

import ctypes
import inspect
import itertools
import math
import subprocess
from typing import NamedTuple

import numpy as np
import pytest

from contactlaw._jit import kernel, tuple_of
from contactlaw.emit import DOUBLE, INT, C, JavaScript, Known, Program, add

FACTOR = 3


class Pair(NamedTuple):
    """Two numbers."""

    one: float  # the first
    two: float = 2.0


class Contact(NamedTuple):
    """Another class with the same names."""

    one: float
    two: float
    depth: float


def sliced(law, x):
    """Tails of arrays of constants, whose numbers count as whole ones."""
    tail, k = law[int(law[0]) :], int(-x)
    return tail[1] + law[k // 2] if law.size > 3 else math.nan


def test_constants_keep_their_names_and_arrays_are_written_once():
    program = Program(C("k_"))
    law = Known(value=Pair(np.array([2.0, 5.0, 7.0, 0.5, math.inf]), 3.0))
    add(program, of_pair, law, DOUBLE)
    text = program.text()
    assert "#define k_FACTOR 3\n" in text and "k_FACTOR * " in text
    assert text.count("static const double k_one[] = {\n2,5,7,.5,HUGE_VAL\n};") == 1
    assert "#define k_TWO 3.0" in text and "(double x)" in text


def of_pair(pair, x):
    """Members of what is known are constants."""
    return FACTOR * sliced(pair.one, x) + sliced(pair.one, 2.0 * x) + pair.two


def listed(x):
    return [x, x][0]


def early(x):
    return y + x  # noqa: F821


def changed(x):
    a = x
    a = (x, x)
    return a[0]


def powered(x):
    return x << 2


def every(x):
    for one in (x, x):
        x += one
    return x


@pytest.mark.parametrize(
    ("kernel", "where", "remedy"),
    [
        (listed, 1, "use numbers, NamedTuples, arrays"),
        (early, 1, "give the variable a value before it is read"),
        (changed, 2, "a variable has one type, not double and tuple"),
        (powered, 1, "use + - "),
        (every, 1, "use assignments, if, while, for in a range"),
    ],
)
def test_what_is_not_in_the_subset_is_refused_with_file_line_and_remedy(kernel, where, remedy):
    line = inspect.getsourcelines(kernel)[1] + where
    with pytest.raises(SyntaxError, match=remedy.replace("+", r"\+")) as caught:
        add(Program(C()), kernel, DOUBLE)
    assert str(caught.value).startswith(f"{__file__}:{line}: ")


def recursive(x):
    return recursive(x)


def test_a_kernel_that_calls_itself_is_refused():
    with pytest.raises(RecursionError, match="recursive calls itself"):
        add(Program(C()), recursive, DOUBLE)


def in_c(function, folder):
    """A kernel of three numbers as a function of a library."""
    program = Program(C("k_"))
    add(program, function, DOUBLE, DOUBLE, DOUBLE)
    new, head = "#define k_new(kind) (k_##kind)\n", "double run(double a, double b, double c)"
    source = f"{new}{program.text()}\n{head} {{ return k_{function.__name__}(a, b, c); }}"
    (folder / "made.c").write_text(source)
    gcc = ["gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-shared", "-fPIC"]
    done = subprocess.run([*gcc, "made.c", "-o", "made.so"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    run = ctypes.CDLL(str(folder / "made.so")).run
    run.restype, run.argtypes = ctypes.c_double, [ctypes.c_double] * 3
    return run


def nested(a, b, c):
    """Brackets and operators, each where another order gives another number."""
    n = int(a) >> 1
    if (a > b or b > c) and c > a:
        n = n + 100
    return a - (b - c) * (a - (b - 2.0 * c)) / (c - a / (b - 3.0)) + (int(a) + int(b)) // 2 * (n - (n + 3) % 2)


def test_operators_bind_as_in_python(tmp_path):
    run = in_c(nested, tmp_path)
    for given in itertools.permutations((5.0, 7.0, 12.0)):
        assert run(*given) == nested(*given)
    program = Program(JavaScript("$"))
    add(program, nested, DOUBLE, DOUBLE, DOUBLE)
    assert "Math.floor((Math.trunc(a) + Math.trunc(b)) / 2)" in " ".join(program.text().split())


def rebuilt(a, b, c):
    """NamedTuple of the fields of another class, two of which are given anew."""
    contact = Contact(a, b, 7.0)
    pair = tuple_of(Pair, contact, two=c)
    last = tuple_of(Contact, pair, depth=b)
    return last.one + 10.0 * last.two + 100.0 * last.depth


def test_tuples_are_rebuilt_as_in_python(tmp_path):
    found = in_c(rebuilt, tmp_path)(2.0, 3.0, 5.0)
    assert found == kernel(entry=True)(rebuilt)(2.0, 3.0, 5.0) == rebuilt(2.0, 3.0, 5.0) == 352.0


def unbounded(way, n):
    total = 0.0
    for k in range(n):
        total += way[k]
    return total


def last(way, n):
    k = 0
    for k in range(n):
        if k > 2:
            break
    return k


@pytest.mark.parametrize(
    ("kernel", "message"),
    [
        (unbounded, r"range\(n\).* a loop over the members of a tuple has known ends"),
        (last, "k.* give the variable a value before it is read"),
    ],
)
def test_loops_that_other_languages_have_otherwise_are_refused(kernel, message):
    program = Program(C())
    way = program.struct(tuple, dict.fromkeys(("f0", "f1"), DOUBLE))
    with pytest.raises(SyntaxError, match=message):
        add(program, kernel, way, INT)


def test_rows_from_one_on_end_with_the_rows():
    program = Program(C("k_"))
    rows = program.rows(program.row(np.dtype([("size", "f8")])))
    name, _ = add(program, counted, rows, INT)
    assert "k_min_int(k + 1, rows.n) - k" in program.text()
    assert f"int k_{name}(" in program.text()


def counted(rows, k):
    """Whether there is a row of this number."""
    return len(rows[k : k + 1])
