"""The header in CUDA and OpenCL: compiled by nvcc, and run by pocl beside the same code in C."""

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


@pytest.fixture(scope="module")
def context():
    opencl = pytest.importorskip("pyopencl", reason=f"pyopencl {ADVICE}")
    devices = [one for at in opencl.get_platforms() for one in at.get_devices()]
    if not any(one.type & opencl.device_type.CPU for one in devices):
        pytest.skip(f"pocl {ADVICE}")
    return opencl.Context([next(one for one in devices if one.type & opencl.device_type.CPU)])


@pytest.mark.parametrize("name", MODELS)
def test_all_functions_are_those_of_c(name, context, tmp_path):
    import pyopencl as opencl

    cl.export.header(tmp_path / "contactlaw.h", MODELS[name])
    given = header.rows(1000, seed=1)
    expected = header.Library(tmp_path).answers(given)
    program = opencl.Program(context, header.SOURCE).build(["-I", str(tmp_path), "-Werror"])
    queue, flags, found = opencl.CommandQueue(context), opencl.mem_flags, np.empty_like(expected)
    # one work item a group: the arrays of a large group exceed the stack of a thread
    rows = opencl.Buffer(context, flags.COPY_HOST_PTR, hostbuf=given)
    out = opencl.Buffer(context, flags.WRITE_ONLY, found.nbytes)
    opencl.Kernel(program, "contactlaw_all")(queue, given.shape[:1], (1,), rows, out)
    opencl.enqueue_copy(queue, found, out)
    header.assert_close(given, found, expected)
    assert np.isfinite(found).mean(axis=0).min() > 0.5 and np.nanstd(found[:, 0]) > 0.05


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
        text = header.SOURCE.replace("contactlaw", name).replace("CONTACTLAW", name.upper())
        texts.append(text)
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
