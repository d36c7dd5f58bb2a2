"""The generator: what it writes for small kernels, and what it refuses with line and remedy."""

import ctypes
import inspect
import math
import shutil
import subprocess
from typing import NamedTuple

import numpy as np
import pytest

from contactlaw.emit import DOUBLE, INT, Array, C, Known, Program, add

PLAIN = """
#include <math.h>
typedef const double k_data;
#ifdef __cplusplus
#define k_new(type) k_##type
#else
#define k_new(type) (k_##type)
#endif
static inline double k_min(double a, double b) { return b < a ? b : a; }
static inline double k_max(double a, double b) { return b > a ? b : a; }
static inline int k_min_int(int a, int b) { return b < a ? b : a; }
static inline void k_fill(double *a, int n, double v) { while (n > 0) a[--n] = v; }
"""
FACTOR = 3


class Pair(NamedTuple):
    """Two numbers."""

    one: float  # the first
    two: float = 2.0


def doubled(a, b, factor=2.0):
    return factor * a, factor * b


def swapped(x, n):
    """Swap, unpack, and read members by name and by place."""
    a, b = x, x + n
    a, b = b, a
    pair = Pair(a, two=b)
    c, d = doubled(a, b)
    both = Pair(x)
    return pair.one - 2 * pair.two + c * d + both.two + (pair[1] if 0 < FACTOR < n else x)


def looped(x, n):
    """Loops with breaks; whole numbers, chains of comparisons, min and max of a NaN."""
    total, odd = 0.0, np.zeros((4, 2))
    for i in range(1, n, 2):
        if not 0 <= i // 2 < 40 or i == 9:
            continue
        odd[i % 4 if False else min(i, 3), 1] += x**2 / i
        total += odd[min(i, 3), 1] * FACTOR
        if total > 1e3 and total < math.inf:
            break
    while total > 10.0:
        total /= 2
    return total if total == total else max(min(0.0, math.nan), -1.0)


def sliced(law, x):
    """Tails of arrays of constants, whose numbers count as whole ones."""
    tail, k = law[int(law[0]) :], int(-x)
    return tail[1] + law[k // 2] if law.size > 3 else math.nan


def given(x, other=None):
    """What is None leaves no trace."""
    if other is None or other > 3.0:
        return x
    return x + other


CASES = [
    (swapped, (DOUBLE, INT), [(1.5, 2), (-3.25, 7)]),
    (looped, (DOUBLE, INT), [(0.5, 12), (30.0, 60), (math.nan, 4)]),
    (given, (DOUBLE,), [(0.5,), (math.inf,)]),
]


def compiled(folder, program, name, types):
    source = f"{PLAIN}{program.text()}\n"
    letters = [("double", "int")[kind == INT] for kind in types]
    parameters = ", ".join(f"{letter} a{n}" for n, letter in enumerate(letters))
    passed = ", ".join(f"a{n}" for n in range(len(letters)))
    source += f"double answer({parameters});\n"
    source += f"double answer({parameters}) {{ return k_{name}({passed}); }}\n"
    (folder / "a.c").write_text(source)
    warn = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
    for compiler in (["gcc", "-std=c99"], ["g++", "-std=c++11", "-x", "c++", "-c"]):
        command = [*compiler, *warn, "-ffp-contract=off", "-shared", "-fPIC", "a.c", "-o", "a.so"]
        if compiler[0] == "g++":
            command[-1] = "b.o"
        subprocess.run([*command, "-lm"], cwd=folder, check=True)
    answer = ctypes.CDLL(folder / "a.so").answer
    answer.restype = ctypes.c_double
    answer.argtypes = [(ctypes.c_double, ctypes.c_int)[kind == INT] for kind in types]
    return answer


@pytest.mark.skipif(not shutil.which("g++"), reason="no g++ on PATH: the header is not compiled")
@pytest.mark.parametrize(("kernel", "types", "inputs"), CASES, ids=lambda one: str(one)[:20])
def test_c_gives_what_python_gives(kernel, types, inputs, tmp_path):
    program = Program(C("k_"))
    name, _ = add(program, kernel, *types)
    answer = compiled(tmp_path, program, name, types)
    for one in inputs:
        assert answer(*one) == pytest.approx(kernel(*one), rel=0.0, abs=0.0, nan_ok=True)
    assert inspect.getdoc(kernel).split(",")[0] in program.text()


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


def formatted(x):
    return float(f"{x}")


def caught(x):
    try:
        return 1.0 / x
    except ZeroDivisionError:
        return 0.0


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
        (formatted, 1, "use numbers, NamedTuples, arrays"),
        (caught, 1, "use assignments, if, while, for in a range"),
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


def test_a_row_of_numbers_is_passed_by_its_address():
    spot = np.dtype([("at", "f8", 3), ("size", "f8")])
    program = Program(C("k_"), names={spot: "spot"})
    row = program.row(spot)
    name, _ = add(program, grown, row, Array(), DOUBLE)
    text = program.text()
    assert "typedef struct k_spot {\n    double at[3];\n    double size;\n} k_spot;" in text
    assert f"void k_{name}(k_spot *row, double *to, double x)" in text
    assert "row->at[1] = x;" in text and "to[0] += row->size;" in text


def grown(row, to, x):
    """Write into a row and an array."""
    row.at[1] = x
    row.size += x
    to[0] += row.size
