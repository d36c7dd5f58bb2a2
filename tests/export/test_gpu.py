"""The header in CUDA and OpenCL: compiled by nvcc, and run by pocl beside the same code in C."""

import ctypes
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import header
import metal
import numpy as np
import polymer
import pytest
from places import ROOT

import contactlaw as cl

ADVICE = "is missing: pip install contactlaw[engines]"
MODELS = {
    "metals": cl.ImpactModel(cl.Pair("bearing-steel-52100", "aluminium-6061-t6")),
    "rate": metal.MODEL,
    "losses": polymer.MODELS[0],
}
NAMES = "looked_up", "drops", "rebounds", "kept", "time_of", "slides", "near", "flags", "rubs"
CASES = "".join(f"    case {n}: return {name}(v, r, h);\n" for n, name in enumerate(NAMES))
SOURCE = f"""{header.SOURCE}
static double answer(int which, double v, double r, double h)
{{
    switch (which) {{
{CASES}    default: return -1.0;
    }}
}}
"""
HOST = """
void answers(int which, int n, const double *v, const double *r, const double *h, double *out)
{
    int k;
    for (k = 0; k < n; ++k)
        out[k] = answer(which, v[k], r[k], h[k]);
}
"""
DEVICE = """
__kernel void answers(int which, __global const double *v, __global const double *r,
                      __global const double *h, __global double *out)
{
    const size_t k = get_global_id(0);
    out[k] = answer(which, v[k], r[k], h[k]);
}
"""


@pytest.fixture(scope="module")
def context():
    opencl = pytest.importorskip("pyopencl", reason=f"pyopencl {ADVICE}")
    devices = [one for at in opencl.get_platforms() for one in at.get_devices()]
    if not any(one.type & opencl.device_type.CPU for one in devices):
        pytest.skip(f"pocl {ADVICE}")
    return opencl.Context([next(one for one in devices if one.type & opencl.device_type.CPU)])


@pytest.fixture(scope="module", params=MODELS)
def sides(request, context, tmp_path_factory):
    """The same function of arrays in C and in OpenCL C."""
    import pyopencl as opencl

    folder = tmp_path_factory.mktemp("header")
    cl.export.header(folder / "contactlaw.h", MODELS[request.param])
    (folder / "host.c").write_text(SOURCE + HOST)
    command = ["gcc", "-O2", "-shared", "-fPIC", "host.c", "-o", "host.so", "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    program = opencl.Program(context, SOURCE + DEVICE).build(["-I", str(folder), "-Werror"])
    queue, flags = opencl.CommandQueue(context), opencl.mem_flags
    kernel, library = opencl.Kernel(program, "answers"), ctypes.CDLL(folder / "host.so")

    def both(which, *columns):
        found, expected = np.empty_like(columns[0]), np.empty_like(columns[0])
        given = [opencl.Buffer(context, flags.COPY_HOST_PTR, hostbuf=one) for one in columns]
        out = opencl.Buffer(context, flags.WRITE_ONLY, found.nbytes)
        kernel(queue, found.shape, None, np.int32(which), *given, out)
        opencl.enqueue_copy(queue, found, out)
        at = [one.ctypes.data_as(ctypes.c_void_p) for one in (*columns, expected)]
        library.answers(which, found.size, *at)
        return found, expected

    return request.param, both


def drops(count, seed=1):
    """Speeds, radii and thicknesses, some outside of the table."""
    rng = np.random.default_rng(seed)
    v, r = np.exp(rng.uniform(np.log([[1e-3], [1e-4]]), np.log([[60.0], [1e-2]]), (2, count)))
    return v, r, r * np.exp(rng.uniform(np.log(0.2), np.log(30.0), count))


@pytest.mark.parametrize(("which", "within"), [(0, 1e-12), (1, 1e-10)], ids=["table", "steps"])
def test_a_million_impacts_are_those_of_c(which, within, sides):
    name, both = sides
    found, expected = both(which, *drops(1_000_000 if name == "metals" else 20_000))
    assert np.array_equal(np.isnan(found), np.isnan(expected))
    assert 0.5 < np.isfinite(found).mean() and np.nanstd(found) > 0.05
    assert np.nanmax(np.abs(found - expected)) < within


def test_all_other_functions_are_those_of_c(sides):
    given = drops(1000)
    for which, name in enumerate(NAMES[2:], 2):
        found, expected = sides[1](which, *given)
        assert np.array_equal(np.isnan(found), np.isnan(expected))
        assert np.isfinite(found).mean() > 0.9 and np.nanstd(found) > 0.0
        # rounding decides which springs hold: within 2e-3 of friction times speed, as docs say
        bound = 2e-3 * 0.2 * given[0] if name == "slides" else 1e-9
        assert (np.abs(found - expected) <= bound)[np.isfinite(found)].all()


@pytest.mark.parametrize("flag", ["-cl-fast-relaxed-math", "-cl-finite-math-only"])
def test_fast_maths_of_clang_are_refused(flag, context, tmp_path):
    """Pocl compiles with clang; gcc is tried beside the header of C."""
    import pyopencl as opencl

    cl.export.header(tmp_path / "contactlaw.h", MODELS["metals"], table="none")
    with pytest.raises(opencl.RuntimeError, match="no -ffast-math"):
        opencl.Program(context, '#include "contactlaw.h"').build([flag, "-I", str(tmp_path)])


def nvcc(*arguments, folder):
    """Run nvcc, of the wheel or of PATH; any warning is an error."""
    wheel = find_spec("nvidia")
    folders = wheel.submodule_search_locations or () if wheel else ()
    inside = [str(one) for at in folders for one in Path(at).glob("cu*/bin/nvcc")]
    path = next(iter(inside), None) or shutil.which("nvcc")
    if not path:
        pytest.skip(f"nvcc {ADVICE}")
    warn = ["-Werror", "all-warnings", "-Xcompiler", "-Wall,-Wextra,-Wshadow,-Wconversion"]
    command = [path, *warn, "-L", Path(path).parents[1] / "lib", *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.long
def test_nvcc_compiles_all_functions_of_several_pairs_without_warnings(tmp_path):
    """For both sides; -G leaves out the optimization, of which nvcc takes minutes here."""
    texts = []
    for name, model in MODELS.items():
        cl.export.header(tmp_path / f"{name}.h", model, prefix=name)
        text = SOURCE.replace("contactlaw.h", f"{name}.h").replace("contactlaw", name)
        text = re.sub(rf"\b({'|'.join(NAMES)}|answer)\(", rf"{name}s_\1(", text)
        text = text.replace("CONTACTLAW", name.upper()).replace("static double", "double")
        texts.append(re.sub("^double", "inline __host__ __device__ double", text, flags=re.M))
        texts.append(f"__global__ void {name}_all(int which, double *x)")
        texts.append(f"{{ *x = {name}s_answer(which, *x, 1e-3, 1e-3); }}")
    (tmp_path / "pairs.cu").write_text("\n".join(texts))
    nvcc("-G", "-c", "pairs.cu", folder=tmp_path)


@pytest.mark.long
def test_the_example_in_cuda(tmp_path):
    """Without a GPU it says so, after what one core gives."""
    text = (ROOT / "docs/examples/event_driven.cu").read_text()
    export, compilation = re.findall(r"^ \*     (.*)$", text, re.MULTILINE)
    (tmp_path / "event_driven.cu").write_text(text)
    subprocess.run([sys.executable, "-m", *export.split()], cwd=tmp_path, check=True)
    nvcc(*compilation.split(" && ")[0].split()[1:], folder=tmp_path)
    done = subprocess.run([tmp_path / "event_driven"], capture_output=True, text=True)
    time = float(re.search(r"after ([\d.]+) s", done.stdout)[1])
    model = cl.ImpactModel(cl.Pair("gamma-alumina", "glass"))
    speed = (2 * 9.81 * 0.1) ** 0.5
    expected = speed / 9.81
    for _ in range(20):
        speed *= model.restitution(speed, 0.9e-3, 0.5e-3)
        expected += 2 * speed / 9.81
    assert time == pytest.approx(expected, abs=1e-5)
    assert done.returncode == ("no answer of a GPU" in done.stderr)
